package skein;

import com.sun.jna.Callback;
import com.sun.jna.Library;
import com.sun.jna.Native;
import com.sun.jna.NativeLibrary;
import com.sun.jna.Pointer;
import com.sun.jna.Structure;
import com.sun.jna.Structure.FieldOrder;
import com.sun.jna.ptr.LongByReference;
import com.sun.jna.ptr.PointerByReference;
import java.nio.file.Path;
import java.util.Map;

/** The functions of skein/c/skein.h that this package uses. Handles are numbers; true is any other than 0. */
final class C {
  static {
    // Where both are installed, or built.
    String jar = C.class.getProtectionDomain().getCodeSource().getLocation().getPath();
    for (String folder : new String[] {"lib", "lib/x86_64-linux-gnu", "lib/aarch64-linux-gnu"}) {
      NativeLibrary.addSearchPath("skein_c", Path.of(jar, "..", "..", "..", folder).normalize().toString());
    }
    Native.register(NativeLibrary.getInstance("skein_c", Map.of(Library.OPTION_STRING_ENCODING, "UTF-8")));
  }

  private C() {}

  static final int CDR = 1;

  /** With texts in UTF-8. */
  abstract static class Struct extends Structure {
    Struct() {
      setStringEncoding("UTF-8");
    }
  }

  @FieldOrder({"data", "size", "encoding"})
  public static class Value extends Struct {
    public Pointer data;
    public long size;
    public int encoding = CDR;

    public static class ByValue extends Value implements Structure.ByValue {}
  }

  @FieldOrder({"name", "system", "vendor", "network", "networkSize", "peers", "peersSize", "domain", "multicast", "noSharedMemoryCalls", "lease", "reserved"})
  public static class EntityOptions extends Struct {
    public String name;
    public String system;
    public String vendor;
    public Pointer network;
    public long networkSize;
    public Pointer peers;
    public long peersSize;
    public int domain;
    public byte multicast;
    public byte noSharedMemoryCalls;
    public long lease;
    public long[] reserved = new long[4];
  }

  @FieldOrder({"name", "system", "strategy", "preferredHost", "provider", "constraints", "constraintsSize", "timeout", "hedgeAfter", "reserved"})
  public static class ConnectOptions extends Struct {
    public String name;
    public String system;
    public String strategy;
    public String preferredHost;
    public Pointer provider;
    public Pointer constraints;
    public long constraintsSize;
    public long timeout;
    public long hedgeAfter;
    public long[] reserved = new long[4];
  }

  @FieldOrder({"attributes", "attributesSize", "component", "csp", "owner", "threads", "queue", "encoding", "reserved"})
  public static class ServiceOptions extends Struct {
    public Pointer attributes;
    public long attributesSize;
    public String component;
    public String csp;
    public String owner;
    public long threads;
    public long queue;
    public int encoding = CDR;
    public long[] reserved = new long[4];
  }

  @FieldOrder({"systems", "systemsSize", "period", "profile", "strength", "encoding", "reserved"})
  public static class TopicOptions extends Struct {
    public Pointer systems;
    public long systemsSize;
    public long period;
    public int profile;
    public int strength;
    public int encoding = CDR;
    public long[] reserved = new long[4];
  }

  interface OnResult extends Callback {
    void call(Pointer user, Value result, long error);
  }

  interface OnCall extends Callback {
    void call(Pointer user, Pointer operation, Value arguments, long reply);
  }

  interface OnValue extends Callback {
    void call(Pointer user, Value value);
  }

  interface OnClose extends Callback {
    void call(Pointer user);
  }

  /** Two functions and what they get; of a call, a service, a subscription, or the cancelling of a reply. */
  @FieldOrder({"user", "function", "onClose"})
  public static class Callbacks extends Struct {
    public Pointer user;
    public Callback function;
    public OnClose onClose;
  }

  static native long skein_error_new();

  static native int skein_error_class(long error);

  static native String skein_error_text(long error);

  static native byte skein_error_exception(long error, PointerByReference name, Value members);

  static native byte skein_result_value(long result, Value value, long error);

  static native byte skein_result_free(long result, long error);

  static native byte skein_entity_new(EntityOptions options, LongByReference out, long error);

  static native byte skein_entity_free(long entity, long error);

  static native byte skein_entity_id(long entity, PointerByReference out, long error);

  static native byte skein_interface_new(byte[] description, long size, LongByReference out, long error);

  static native byte skein_interface_free(long type, long error);

  static native byte skein_proxy_connect(long entity, long type, ConnectOptions options, LongByReference out, long error);

  static native byte skein_proxy_free(long proxy, long error);

  static native byte skein_proxy_call(long proxy, String operation, Value.ByValue arguments, long timeout, LongByReference out, long error);

  static native byte skein_proxy_start(long proxy, String operation, Value.ByValue arguments, long timeout, Callbacks callbacks, LongByReference out, long error);

  static native byte skein_call_cancel(long call, long error);

  static native byte skein_call_free(long call, long error);

  static native byte skein_proxy_stream(long proxy, String operation, Value.ByValue arguments, long timeout, Callbacks callbacks, LongByReference out, long error);

  static native byte skein_stream_next(long stream, LongByReference out, long error);

  static native byte skein_stream_free(long stream, long error);

  static native byte skein_provider_new(long entity, long type, ServiceOptions options, Callbacks callbacks, LongByReference out, long error);

  static native byte skein_provider_free(long provider, long error);

  static native byte skein_reply_answer(long reply, Value.ByValue result, long error);

  static native byte skein_reply_fail(long reply, int kind, String text, long error);

  static native byte skein_reply_raise(long reply, String exception, Value.ByValue members, long error);

  static native byte skein_reply_push(long reply, Value.ByValue item, Pointer sent, long error);

  static native byte skein_reply_cancelled(long reply, byte[] out, long error);

  static native byte skein_reply_time_left(long reply, LongByReference out, long error);

  static native byte skein_publisher_new(long entity, long types, String type, String topic, TopicOptions options, LongByReference out, long error);

  static native byte skein_publisher_publish(long publisher, Value.ByValue value, long error);

  static native byte skein_publisher_subscribers(long publisher, LongByReference out, long error);

  static native byte skein_publisher_free(long publisher, long error);

  static native byte skein_subscription_new(long entity, long types, String type, String topic, TopicOptions options, Callbacks callbacks, LongByReference out, long error);

  static native byte skein_subscription_publishers(long subscription, LongByReference out, long error);

  static native byte skein_subscription_free(long subscription, long error);
}
