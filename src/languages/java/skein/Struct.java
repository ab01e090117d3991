package skein;

import java.util.Arrays;

/** What IDL structs and bitsets derive from: values, which are equal if their members are. */
public abstract class Struct {
  /** The values of its members. */
  protected abstract Object[] members();

  @Override
  public boolean equals(Object other) {
    return other != null && other.getClass() == getClass() && Arrays.deepEquals(members(), ((Struct) other).members());
  }

  @Override
  public int hashCode() {
    return Arrays.deepHashCode(members());
  }

  @Override
  public String toString() {
    return getClass().getSimpleName() + Arrays.deepToString(members());
  }
}
