package skein;

/** The provider does not know the operation, or this version of it. */
public class Unimplemented extends SkeinException {
  public Unimplemented(String text) {
    super(text);
  }
}
