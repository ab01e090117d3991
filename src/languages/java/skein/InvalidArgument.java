package skein;

/** The input is invalid; the same input will fail again. */
public class InvalidArgument extends SkeinException {
  public InvalidArgument(String text) {
    super(text);
  }
}
