package skein;

import com.sun.jna.ptr.LongByReference;
import java.nio.ByteBuffer;
import java.time.Duration;
import java.util.concurrent.CompletableFuture;
import java.util.function.Function;

/** A connection: each call goes to the current provider, or to another one if that is lost. Thread-safe. Generated proxies derive from it. */
public abstract class Proxy implements AutoCloseable {
  /** Which provider to connect to. Members that are null or 0 have their defaults; see skein/c/skein.h. */
  public static final class Choice {
    public String name;
    public String system;
    public String strategy;
    public Duration timeout = Duration.ZERO;
  }

  private final InterfaceType type;
  private final long handle;
  private final long timeout;

  protected Proxy(Entity entity, InterfaceType type, Choice choice) {
    this.type = type;
    timeout = 0;
    C.ConnectOptions options = new C.ConnectOptions();
    options.name = choice.name;
    options.system = choice.system;
    options.strategy = choice.strategy;
    options.timeout = choice.timeout.toNanos();
    LongByReference out = new LongByReference();
    SkeinException.check(C.skein_proxy_connect(entity.handle, type.handle(), options, out, SkeinException.sink()), type);
    handle = out.getValue();
  }

  /** The same connection with another timeout for its calls. */
  protected Proxy(Proxy other, Duration timeout) {
    type = other.type;
    handle = other.handle;
    this.timeout = timeout.toNanos();
  }

  private static Message message(InterfaceType.Operation operation, Object[] arguments) {
    return new Message(operation.in().encode(operation.inRepresentation(), arguments, operation.name()));
  }

  private static Object[] results(InterfaceType.Operation operation, ByteBuffer message) {
    return message.hasRemaining() ? operation.out().decode(message) : new Object[0];
  }

  private static Object[] taken(InterfaceType.Operation operation, long result) {
    C.Value value = new C.Value();
    try {
      SkeinException.check(C.skein_result_value(result, value, SkeinException.sink()), null);
      return results(operation, SkeinException.bytes(value));
    } finally {
      C.skein_result_free(result, 0);
    }
  }

  /** Calls, and waits for the results. */
  protected final Object[] call(InterfaceType.Operation operation, Object... arguments) {
    LongByReference out = new LongByReference();
    try (Message message = message(operation, arguments)) {
      SkeinException.check(C.skein_proxy_call(handle, operation.name(), message.value(), timeout, out, SkeinException.sink()), type);
    }
    return taken(operation, out.getValue());
  }

  /** Begins a call. To cancel the future cancels the call. */
  protected final <R> CompletableFuture<R> start(Function<Object[], R> result, InterfaceType.Operation operation, Object... arguments) {
    Begun<R> future = new Begun<>();
    C.OnResult tell = (user, value, error) -> {
      try {
        if (value == null) future.completeExceptionally(SkeinException.of(error, type));
        else future.complete(result.apply(results(operation, SkeinException.bytes(value))));
      } catch (Throwable wrong) {
        future.completeExceptionally(wrong);
      }
    };
    LongByReference out = new LongByReference();
    try (Message message = message(operation, arguments)) {
      C.Callbacks callbacks = CallbackKeeper.keep(tell);
      if (C.skein_proxy_start(handle, operation.name(), message.value(), timeout, callbacks, out, SkeinException.sink()) == 0) {
        CallbackKeeper.drop(callbacks);
        throw SkeinException.of(SkeinException.sink(), type);
      }
    }
    future.call = out.getValue();
    future.whenComplete((done, error) -> {
      C.skein_call_cancel(future.call, 0);  // without effect on one that has ended
      C.skein_call_free(future.call, 0);
    });
    return future;
  }

  private static final class Begun<R> extends CompletableFuture<R> {
    private volatile long call;
  }

  /** Calls an operation under @stream. */
  protected final <T> ResultStream<T> stream(InterfaceType.Operation operation, Object... arguments) {
    LongByReference out = new LongByReference();
    try (Message message = message(operation, arguments)) {
      SkeinException.check(C.skein_proxy_stream(handle, operation.name(), message.value(), timeout, null, out, SkeinException.sink()), type);
    }
    long stream = out.getValue();
    return new ResultStream<>() {
      @Override
      protected Object[] take() {
        LongByReference next = new LongByReference();
        SkeinException.check(C.skein_stream_next(stream, next, SkeinException.sink()), type);
        return next.getValue() == 0 ? null : taken(operation, next.getValue());
      }

      @Override
      public void close() {
        C.skein_stream_free(stream, 0);
      }
    };
  }

  /** Ends the connection: pending calls end as Cancelled. */
  @Override
  public void close() {
    SkeinException.check(C.skein_proxy_free(handle, SkeinException.sink()), null);
  }

}
