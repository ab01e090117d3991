package skein;

import java.util.Iterator;
import java.util.NoSuchElementException;

/** The results of an operation under @stream, each of which is waited for. close() cancels the rest. */
public abstract class ResultStream<T> implements Iterator<T>, Iterable<T>, AutoCloseable {
  private Object[] next;
  private boolean ended;

  /** The next result; null at the end. */
  protected abstract Object[] take();

  @Override
  public abstract void close();

  @Override
  public final boolean hasNext() {
    if (next == null && !ended) {
      next = take();
      ended = next == null;
    }
    return next != null;
  }

  @Override
  @SuppressWarnings("unchecked")
  public final T next() {
    if (!hasNext()) throw new NoSuchElementException();
    Object[] taken = next;
    next = null;
    return (T) taken[0];
  }

  @Override
  public final Iterator<T> iterator() {
    return this;
  }
}
