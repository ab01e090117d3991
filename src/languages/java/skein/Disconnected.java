package skein;

/** The provider died or left; whether the call ran is unknown. */
public class Disconnected extends SkeinException {
  public Disconnected(String text) {
    super(text);
  }
}
