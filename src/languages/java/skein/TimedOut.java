package skein;

/** The deadline passed; whether the call ran is unknown. */
public class TimedOut extends SkeinException {
  public TimedOut(String text) {
    super(text);
  }
}
