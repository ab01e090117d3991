package skein;

import com.sun.jna.Pointer;
import com.sun.jna.ptr.PointerByReference;
import java.util.List;
import java.util.function.Function;

/** Why an operation of Skein has failed; its text gives cause, place and remedy. The classes say what can be done next. */
public class SkeinException extends RuntimeException {
  private static final List<Function<String, SkeinException>> BY_KIND =
      List.of(SkeinException::new, Unavailable::new, Overloaded::new, Disconnected::new, TimedOut::new, Cancelled::new, Unimplemented::new,
          InvalidArgument::new, Internal::new);
  private static final ThreadLocal<Long> SINK = ThreadLocal.withInitial(C::skein_error_new);
  private static final int DECLARED = 9;

  public SkeinException(String text) {
    super(text);
  }

  /** Where functions of C put their errors. */
  static long sink() {
    return SINK.get();
  }

  /** Throws what the last function on this thread has failed with, if it has. */
  static void check(byte done, InterfaceType type) {
    if (done == 0) throw of(sink(), type);
  }

  static SkeinException of(long error, InterfaceType type) {
    int kind = C.skein_error_class(error);
    if (kind == DECLARED && type != null) {
      PointerByReference name = new PointerByReference();
      C.Value members = new C.Value();
      if (C.skein_error_exception(error, name, members) != 0) {
        Codec<? extends UserException> codec = type.exceptions().get(name.getValue().getString(0, "UTF-8"));
        if (codec != null) return codec.decode(bytes(members));
      }
    }
    return BY_KIND.get(kind < BY_KIND.size() ? kind : 0).apply(C.skein_error_text(error));
  }

  /** How a service tells the error to its caller. */
  static int kindOf(Throwable error) {
    for (int kind = 1; kind < BY_KIND.size(); ++kind) {
      if (BY_KIND.get(kind).apply("").getClass().isInstance(error)) return kind;
    }
    return BY_KIND.size() - 1;
  }

  static java.nio.ByteBuffer bytes(C.Value value) {
    Pointer data = value.data;
    return data == null ? java.nio.ByteBuffer.allocate(0) : data.getByteBuffer(0, value.size);
  }
}
