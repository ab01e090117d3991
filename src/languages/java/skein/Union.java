package skein;

import java.util.Objects;

/** What IDL unions derive from: a discriminator, and the value that it selects, or null. */
public abstract class Union<D> {
  public D discriminator;
  public Object value;

  protected Union(D discriminator, Object value) {
    this.discriminator = discriminator;
    this.value = value;
  }

  @Override
  public boolean equals(Object other) {
    return other != null && other.getClass() == getClass() && Objects.equals(discriminator, ((Union<?>) other).discriminator)
        && Objects.deepEquals(value, ((Union<?>) other).value);
  }

  @Override
  public int hashCode() {
    return Objects.hash(discriminator, value);
  }

  @Override
  public String toString() {
    return getClass().getSimpleName() + "[" + discriminator + ": " + value + "]";
  }
}
