package skein;

/** Not executed: no provider is available. Try later or elsewhere. */
public class Unavailable extends SkeinException {
  public Unavailable(String text) {
    super(text);
  }
}
