package skein;

/** The caller gave up; whether the call ran is unknown. */
public class Cancelled extends SkeinException {
  public Cancelled(String text) {
    super(text);
  }
}
