package skein;

/** A failure that the interface does not declare. */
public class Internal extends SkeinException {
  public Internal(String text) {
    super(text);
  }
}
