package skein;

import com.sun.jna.ptr.LongByReference;

/** Publishes values on a topic, until it is closed, or its entity ends. Thread-safe. */
public final class Publisher<T> implements AutoCloseable {
  private final TypeSupport<T> type;
  private final long handle;

  Publisher(Entity entity, TypeSupport<T> type, String topic, TopicProfile profile) {
    this.type = type;
    C.TopicOptions options = new C.TopicOptions();
    options.profile = profile.ordinal();
    LongByReference out = new LongByReference();
    SkeinException.check(
        C.skein_publisher_new(entity.handle, type.types().handle(), type.name(), topic, options, out, SkeinException.sink()), null);
    handle = out.getValue();
  }

  /** Throws Overloaded if reliable subscribers make no room in time. */
  public void publish(T value) {
    try (Message message = new Message(type.codec().encode(type.representation(), value, type.name()))) {
      SkeinException.check(C.skein_publisher_publish(handle, message.value(), SkeinException.sink()), null);
    }
  }

  public long subscribers() {
    LongByReference out = new LongByReference();
    SkeinException.check(C.skein_publisher_subscribers(handle, out, SkeinException.sink()), null);
    return out.getValue();
  }

  @Override
  public void close() {
    SkeinException.check(C.skein_publisher_free(handle, SkeinException.sink()), null);
  }
}
