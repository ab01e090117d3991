package skein;

import java.nio.BufferUnderflowException;
import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import java.nio.charset.StandardCharsets;
import java.util.function.Supplier;

/** Reads a message that Skein has checked: all members of this side's version, in their order. */
public final class CdrReader {
  private final ByteBuffer buffer;
  private final boolean xcdr2;

  CdrReader(ByteBuffer message) {
    buffer = message.order((message.get(1) & 1) == 0 ? ByteOrder.BIG_ENDIAN : ByteOrder.LITTLE_ENDIAN).position(4);
    xcdr2 = message.get(1) > Codec.XCDR1;
  }

  boolean isXcdr2() {
    return xcdr2;
  }

  private ByteBuffer at(int alignment) {
    int padding = Math.floorMod(4 - buffer.position(), xcdr2 ? Math.min(alignment, 4) : alignment);
    return buffer.position(buffer.position() + padding);
  }

  int int8() {
    return buffer.get();
  }

  int int16() {
    return at(2).getShort();
  }

  int int32() {
    return at(4).getInt();
  }

  long int64() {
    return at(8).getLong();
  }

  byte[] bytes(int size) {
    if (size < 0 || size > buffer.remaining()) throw new BufferUnderflowException();
    byte[] bytes = new byte[size];
    buffer.get(bytes);
    return bytes;
  }

  /** A sequence's length, of elements that take a byte at least. */
  int length() {
    int length = int32();
    if (length < 0 || length > buffer.remaining()) throw new BufferUnderflowException();
    return length;
  }

  String string() {
    byte[] bytes = bytes(int32());
    return new String(bytes, 0, Math.max(0, bytes.length - 1), StandardCharsets.UTF_8);
  }

  boolean more() {
    return buffer.hasRemaining();
  }

  /** What {@code content} reads within its length, which is read first if {@code needed}. */
  <T> T delimited(boolean needed, Supplier<T> content) {
    return needed ? within(int32(), content) : content.get();
  }

  <T> T within(int length, Supplier<T> content) {
    int end = buffer.position() + length;
    int outer = buffer.limit();
    if (length < 0 || end > outer) throw new BufferUnderflowException();
    buffer.limit(end);
    T value = content.get();
    buffer.limit(outer).position(end);
    return value;
  }
}
