package skein;

import java.util.Arrays;

/** What exceptions of IDL derive from: their members are fields. */
public abstract class UserException extends SkeinException {
  protected UserException() {
    super("");
  }

  /** How exceptions of one class are written. */
  public record Support<E extends UserException>(String name, int representation, Codec<E> codec) {
    @SuppressWarnings("unchecked")
    byte[] encode(UserException error) {
      return codec.encode(representation, (E) error, name);
    }
  }

  protected abstract Support<?> support();

  /** The values of its members. */
  protected abstract Object[] members();

  @Override
  public String getMessage() {
    return getClass().getSimpleName() + Arrays.deepToString(members());
  }
}
