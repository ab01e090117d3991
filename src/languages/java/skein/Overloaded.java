package skein;

/** Not executed: a queue is full. Back off, then try again. */
public class Overloaded extends SkeinException {
  public Overloaded(String text) {
    super(text);
  }
}
