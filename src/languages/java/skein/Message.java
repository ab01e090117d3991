package skein;

import com.sun.jna.Memory;

/** A message in memory that C may read. */
final class Message implements AutoCloseable {
  private final Memory memory;

  Message(byte[] bytes) {
    memory = new Memory(bytes.length);
    memory.write(0, bytes, 0, bytes.length);
  }

  C.Value.ByValue value() {
    C.Value.ByValue value = new C.Value.ByValue();
    value.data = memory;
    value.size = memory.size();
    return value;
  }

  @Override
  public void close() {
    memory.close();
  }
}
