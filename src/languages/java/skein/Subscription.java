package skein;

import com.sun.jna.ptr.LongByReference;
import java.util.function.Consumer;

/** Receives the values of a topic, until it is closed, or its entity ends. */
public final class Subscription<T> implements AutoCloseable {
  private final long handle;

  Subscription(Entity entity, TypeSupport<T> type, String topic, TopicProfile profile, Consumer<T> callback) {
    C.TopicOptions options = new C.TopicOptions();
    options.profile = profile.ordinal();
    C.OnValue tell = (user, value) -> callback.accept(type.codec().decode(SkeinException.bytes(value)));
    C.Callbacks callbacks = CallbackKeeper.keep(tell);
    LongByReference out = new LongByReference();
    if (C.skein_subscription_new(entity.handle, type.types().handle(), type.name(), topic, options, callbacks, out, SkeinException.sink()) == 0) {
      CallbackKeeper.drop(callbacks);
      throw SkeinException.of(SkeinException.sink(), null);
    }
    handle = out.getValue();
  }

  public long publishers() {
    LongByReference out = new LongByReference();
    SkeinException.check(C.skein_subscription_publishers(handle, out, SkeinException.sink()), null);
    return out.getValue();
  }

  /** Refused in its own callback. */
  @Override
  public void close() {
    SkeinException.check(C.skein_subscription_free(handle, SkeinException.sink()), null);
  }
}
