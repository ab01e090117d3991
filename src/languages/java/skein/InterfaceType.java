package skein;

import com.sun.jna.ptr.LongByReference;
import java.util.Base64;
import java.util.HashMap;
import java.util.Map;
import java.util.function.Supplier;

/** What this program knows of an IDL interface, or of types alone. Generated code makes it. */
public final class InterfaceType {
  /** An operation: how its parameters and results are written. */
  public record Operation(String name, int inRepresentation, Codec<Object[]> in, int outRepresentation, Codec<Object[]> out, boolean stream, boolean oneway) {}

  private final Map<String, Codec<? extends UserException>> exceptions;
  private final Supplier<Long> handle;

  public InterfaceType(String description, Map<String, Codec<? extends UserException>> exceptions) {
    this.exceptions = new HashMap<>(exceptions);
    handle = new Supplier<>() {
      private long made;

      @Override
      public synchronized Long get() {
        if (made != 0) return made;
        byte[] bytes = Base64.getDecoder().decode(description);
        LongByReference out = new LongByReference();
        SkeinException.check(C.skein_interface_new(bytes, bytes.length, out, SkeinException.sink()), null);
        return made = out.getValue();
      }
    };
  }

  long handle() {
    return handle.get();
  }

  Map<String, Codec<? extends UserException>> exceptions() {
    return exceptions;
  }
}
