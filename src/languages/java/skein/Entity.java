package skein;

import com.sun.jna.Native;
import com.sun.jna.Pointer;
import com.sun.jna.StringArray;
import com.sun.jna.ptr.LongByReference;
import com.sun.jna.ptr.PointerByReference;
import java.time.Duration;
import java.util.List;
import java.util.function.Consumer;

/** An autonomous entity: provides services, connects to those of others, publishes and subscribes. Thread-safe. Close it. */
public final class Entity implements AutoCloseable {
  /** Members that are null, 0 or empty have their defaults; see skein/c/skein.h. */
  public static final class Options {
    public String name;
    public String system;
    public String vendor = "cyclonedds";
    public List<String> network = List.of();
    public List<String> peers = List.of();
    public int domain;
    public boolean multicast;
    public boolean sharedMemoryCalls = true;
    public Duration lease = Duration.ZERO;

    public Options(String name) {
      this.name = name;
    }
  }

  final long handle;

  public Entity(String name) {
    this(new Options(name));
  }

  public Entity(Options given) {
    C.EntityOptions options = new C.EntityOptions();
    options.name = given.name;
    options.system = given.system;
    options.vendor = given.vendor;
    options.network = texts(given.network);
    options.networkSize = given.network.size();
    options.peers = texts(given.peers);
    options.peersSize = given.peers.size();
    options.domain = given.domain;
    options.multicast = (byte) (given.multicast ? 1 : 0);
    options.noSharedMemoryCalls = (byte) (given.sharedMemoryCalls ? 0 : 1);
    options.lease = given.lease.toNanos();
    LongByReference out = new LongByReference();
    SkeinException.check(C.skein_entity_new(options, out, SkeinException.sink()), null);
    handle = out.getValue();
  }

  static Pointer texts(List<String> texts) {
    return texts.isEmpty() ? null : new StringArray(texts.toArray(String[]::new), "UTF-8");
  }

  /** {@code system/name}. */
  public String id() {
    PointerByReference out = new PointerByReference();
    SkeinException.check(C.skein_entity_id(handle, out, SkeinException.sink()), null);
    return out.getValue().getString(0, "UTF-8");
  }

  public <T> Publisher<T> publisher(TypeSupport<T> type, String topic, TopicProfile profile) {
    return new Publisher<>(this, type, topic, profile);
  }

  /** {@code callback} gets each value on a thread of Skein's. */
  public <T> Subscription<T> subscribe(TypeSupport<T> type, String topic, TopicProfile profile, Consumer<T> callback) {
    return new Subscription<>(this, type, topic, profile, callback);
  }

  /** Leaves the mission. Calls that wait end as Disconnected. */
  @Override
  public void close() {
    SkeinException.check(C.skein_entity_free(handle, SkeinException.sink()), null);
  }

  static {
    Native.setCallbackExceptionHandler((callback, error) -> error.printStackTrace());
  }
}
