package skein;

import com.sun.jna.Memory;
import com.sun.jna.Native;
import com.sun.jna.Pointer;
import com.sun.jna.ptr.LongByReference;
import java.nio.charset.StandardCharsets;
import java.time.Duration;
import java.util.ArrayList;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.concurrent.CompletionException;
import java.util.concurrent.CompletionStage;
import java.util.function.Consumer;

/** A service, or a CSP, that this program provides, until it is closed, or its entity ends. */
public final class Provider implements AutoCloseable {
  /** Members that are null or 0 have their defaults; see skein/c/skein.h. */
  public static final class Options {
    public Map<String, String> attributes = new LinkedHashMap<>();
    /** The name of a CSP, which {@code owner} alone may use: the id of an entity. */
    public String csp;
    public String owner;
    public int threads = 1;
  }

  /** What answers the calls of one operation: with its results, or a stage that will have them; of a stream, by {@code items}. */
  public interface Method {
    Object call(Object[] arguments, Consumer<Object[]> items);
  }

  /** The call that this thread answers. */
  public static final class Context {
    private static final ThreadLocal<Context> CURRENT = new ThreadLocal<>();
    private final long reply;

    private Context(long reply) {
      this.reply = reply;
    }

    /** Null outside of a call. */
    public static Context current() {
      return CURRENT.get();
    }

    /** Whether nobody waits for the answer any more. */
    public boolean cancelled() {
      byte[] out = {1};
      C.skein_reply_cancelled(reply, out, 0);
      return out[0] != 0;
    }

    /** Until the caller's deadline; negative if it has passed. */
    public Duration timeLeft() {
      LongByReference out = new LongByReference();
      SkeinException.check(C.skein_reply_time_left(reply, out, SkeinException.sink()), null);
      return Duration.ofNanos(out.getValue());
    }
  }

  private final long handle;

  /** {@code methods} by the names of operations; used by generated code. */
  public Provider(Entity entity, InterfaceType type, List<InterfaceType.Operation> operations, Map<String, Method> methods, Options given) {
    if (given.threads < 0) throw new InvalidArgument("a service has 1 thread at least, and was given " + given.threads);
    long handleOfType = type.handle();
    C.ServiceOptions options = new C.ServiceOptions();
    List<Pointer> kept = new ArrayList<>();
    options.attributes = attributes(given.attributes, kept);
    options.attributesSize = given.attributes.size();
    options.csp = given.csp;
    options.owner = given.owner;
    options.threads = given.threads;
    C.OnCall answer = (user, operation, arguments, reply) -> {
      String name = operation.getString(0, "UTF-8");
      operations.stream().filter(each -> each.name().equals(name)).findFirst()
          .ifPresent(each -> answer(type, each, methods.get(name), arguments, reply));
    };
    C.Callbacks callbacks = CallbackKeeper.keep(answer);
    LongByReference out = new LongByReference();
    if (C.skein_provider_new(entity.handle, handleOfType, options, callbacks, out, SkeinException.sink()) == 0) {
      CallbackKeeper.drop(callbacks);
      throw SkeinException.of(SkeinException.sink(), type);
    }
    java.lang.ref.Reference.reachabilityFence(kept);
    handle = out.getValue();
  }

  private static Pointer attributes(Map<String, String> attributes, List<Pointer> kept) {
    if (attributes.isEmpty()) return null;
    Memory pairs = new Memory(2L * Native.POINTER_SIZE * attributes.size());
    long at = 0;
    for (Map.Entry<String, String> each : attributes.entrySet()) {
      for (String text : List.of(each.getKey(), each.getValue())) {
        byte[] bytes = text.getBytes(StandardCharsets.UTF_8);
        Memory copy = new Memory(bytes.length + 1);
        copy.write(0, bytes, 0, bytes.length);
        copy.setByte(bytes.length, (byte) 0);
        kept.add(copy);
        pairs.setPointer(at, copy);
        at += Native.POINTER_SIZE;
      }
    }
    return pairs;
  }

  private static void answer(InterfaceType type, InterfaceType.Operation operation, Method method, C.Value arguments, long reply) {
    Context outer = Context.CURRENT.get();
    Context.CURRENT.set(new Context(reply));
    try {
      Object[] given = operation.in().decode(SkeinException.bytes(arguments));
      Object result = method.call(given, item -> push(operation, item, reply));
      if (operation.stream() || operation.oneway()) return;
      if (result instanceof CompletionStage<?> later) {
        later.whenComplete((results, error) -> {
          if (error == null) finish(type, operation, (Object[]) results, reply);
          else fail(type, error instanceof CompletionException && error.getCause() != null ? error.getCause() : error, reply);
        });
      } else {
        finish(type, operation, (Object[]) result, reply);
      }
    } catch (Throwable error) {
      fail(type, error, reply);
    } finally {
      Context.CURRENT.set(outer);
    }
  }

  private static void finish(InterfaceType type, InterfaceType.Operation operation, Object[] results, long reply) {
    try (Message message = new Message(operation.out().encode(operation.outRepresentation(), results, operation.name()))) {
      SkeinException.check(C.skein_reply_answer(reply, message.value(), SkeinException.sink()), null);
    } catch (Throwable error) {
      fail(type, error, reply);
    }
  }

  private static void push(InterfaceType.Operation operation, Object[] item, long reply) {
    try (Message message = new Message(operation.out().encode(operation.outRepresentation(), item, operation.name()))) {
      SkeinException.check(C.skein_reply_push(reply, message.value(), null, SkeinException.sink()), null);
    }
  }

  private static void fail(InterfaceType type, Throwable error, long reply) {
    try {
      if (error instanceof UserException declared && raise(type, declared, reply)) return;
      String text = error instanceof SkeinException ? error.getMessage() : error.toString();
      C.skein_reply_fail(reply, SkeinException.kindOf(error), text, 0);
    } catch (Throwable wrong) {
      C.skein_reply_fail(reply, SkeinException.kindOf(wrong), error + ", which cannot be told: " + wrong.getMessage(), 0);
    }
  }

  private static boolean raise(InterfaceType type, UserException error, long reply) {
    UserException.Support<?> support = error.support();
    try (Message message = new Message(support.encode(error))) {
      return type.exceptions().containsKey(support.name()) && C.skein_reply_raise(reply, support.name(), message.value(), 0) != 0;
    }
  }

  /** Withdraws the service: calls that have no answer end as Disconnected. */
  @Override
  public void close() {
    SkeinException.check(C.skein_provider_free(handle, SkeinException.sink()), null);
  }
}
