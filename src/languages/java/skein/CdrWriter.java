package skein;

import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import java.nio.charset.StandardCharsets;

/** Writes a message as XCDR1 or XCDR2, little-endian. Grows as it is written. */
public final class CdrWriter {
  private final int representation;
  private ByteBuffer buffer = ByteBuffer.allocate(256).order(ByteOrder.LITTLE_ENDIAN);

  /** {@code representation} is the second byte of the message's encapsulation header. */
  CdrWriter(int representation) {
    this.representation = representation;
    buffer.put((byte) 0).put((byte) representation).putShort((short) 0);
  }

  boolean isXcdr2() {
    return representation != Codec.XCDR1;
  }

  /** Room for {@code size} bytes behind padding. */
  ByteBuffer room(int size, int alignment) {
    int position = buffer.position() - 4;
    int padding = Math.floorMod(-position, isXcdr2() ? Math.min(alignment, 4) : alignment);
    if (buffer.remaining() < padding + size) {
      ByteBuffer larger = ByteBuffer.allocate(Math.max(2 * buffer.capacity(), buffer.position() + padding + size));
      buffer = larger.order(ByteOrder.LITTLE_ENDIAN).put(buffer.flip());
    }
    for (int i = 0; i < padding; ++i) buffer.put((byte) 0);
    return buffer;
  }

  void int8(int value) {
    room(1, 1).put((byte) value);
  }

  void int16(int value) {
    room(2, 2).putShort((short) value);
  }

  void int32(int value) {
    room(4, 4).putInt(value);
  }

  void int64(long value) {
    room(8, 8).putLong(value);
  }

  void bytes(byte[] bytes) {
    room(bytes.length, 1).put(bytes);
  }

  void string(String text, int bound, String place) {
    byte[] bytes = text.getBytes(StandardCharsets.UTF_8);
    checkBound(bytes.length, bound, place);
    if (text.indexOf('\0') >= 0) throw new InvalidArgument(place + " has a character of 0, which a string cannot have");
    int32(bytes.length + 1);
    bytes(bytes);
    int8(0);
  }

  /** What {@code content} writes, with its length before it if {@code needed}. */
  void delimited(boolean needed, Runnable content) {
    if (!needed) {
      content.run();
      return;
    }
    int32(0);
    int start = buffer.position();
    content.run();
    buffer.putInt(start - 4, buffer.position() - start);
  }

  static void checkBound(int size, int bound, String place) {
    if (bound > 0 && size > bound) throw new InvalidArgument(place + " takes " + bound + " at most, and was given " + size);
  }

  byte[] message() {
    byte[] message = new byte[buffer.position()];
    buffer.flip().get(message);
    return message;
  }
}
