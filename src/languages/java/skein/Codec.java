package skein;

import java.nio.ByteBuffer;
import java.nio.charset.StandardCharsets;
import java.util.ArrayList;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.function.BiConsumer;
import java.util.function.Function;
import java.util.function.Supplier;

/** How values of an IDL type are written and read. Generated code is made of these. */
public abstract class Codec<T> {
  /** Representations, and so extensibilities of types: @final, @appendable, @mutable. */
  public static final int XCDR1 = 1, PLAIN = 7, DELIMITED = 9, PARAMETERS = 11;

  abstract void write(CdrWriter writer, T value, String place);

  abstract T read(CdrReader reader);

  /** Whether XCDR2 has a length before a sequence of such elements. */
  boolean isObject() {
    return true;
  }

  /** A message with its encapsulation header. */
  public final byte[] encode(int representation, T value, String place) {
    CdrWriter writer = new CdrWriter(representation);
    write(writer, value, place);
    return writer.message();
  }

  public final T decode(ByteBuffer message) {
    return read(new CdrReader(message));
  }

  private static <T> Codec<T> plain(Function<CdrReader, T> read, Writes<T> write) {
    return new Of<>(read, write, false);
  }

  private interface Writes<T> {
    void write(CdrWriter writer, T value, String place);
  }

  private static final class Of<T> extends Codec<T> {
    private final Function<CdrReader, T> read;
    private final Writes<T> write;
    private final boolean object;

    Of(Function<CdrReader, T> read, Writes<T> write, boolean object) {
      this.read = read;
      this.write = write;
      this.object = object;
    }

    @Override
    void write(CdrWriter writer, T value, String place) {
      if (value == null) throw new InvalidArgument(place + " is null");
      write.write(writer, value, place);
    }

    @Override
    T read(CdrReader reader) {
      return read.apply(reader);
    }

    @Override
    boolean isObject() {
      return object;
    }
  }

  private static long within(long value, long least, long greatest, String place) {
    if (value >= least && value <= greatest) return value;
    throw new InvalidArgument(place + " takes " + least + " to " + greatest + ", and was given " + value);
  }

  public static final Codec<Boolean> BOOLEAN = plain(r -> r.int8() != 0, (w, v, p) -> w.int8(v ? 1 : 0));
  public static final Codec<Character> CHAR =
      plain(r -> (char) (r.int8() & 0xff), (w, v, p) -> w.int8((int) within(v, 0, 0xff, p)));
  public static final Codec<Character> WIDE_CHAR = plain(r -> (char) r.int16(), (w, v, p) -> w.int16(v));
  public static final Codec<Byte> INT8 = plain(r -> (byte) r.int8(), (w, v, p) -> w.int8(v));
  public static final Codec<Integer> OCTET =
      plain(r -> r.int8() & 0xff, (w, v, p) -> w.int8((int) within(v, 0, 0xff, p)));
  public static final Codec<Short> SHORT = plain(r -> (short) r.int16(), (w, v, p) -> w.int16(v));
  public static final Codec<Integer> UNSIGNED_SHORT =
      plain(r -> r.int16() & 0xffff, (w, v, p) -> w.int16((int) within(v, 0, 0xffff, p)));
  public static final Codec<Integer> LONG = plain(CdrReader::int32, (w, v, p) -> w.int32(v));
  public static final Codec<Long> UNSIGNED_LONG =
      plain(r -> r.int32() & 0xffffffffL, (w, v, p) -> w.int32((int) within(v, 0, 0xffffffffL, p)));
  public static final Codec<Long> LONG_LONG = plain(CdrReader::int64, (w, v, p) -> w.int64(v));
  public static final Codec<Float> FLOAT =
      plain(r -> Float.intBitsToFloat(r.int32()), (w, v, p) -> w.int32(Float.floatToRawIntBits(v)));
  public static final Codec<Double> DOUBLE =
      plain(r -> Double.longBitsToDouble(r.int64()), (w, v, p) -> w.int64(Double.doubleToRawLongBits(v)));

  /** As IEEE 754's binary128: of a double what that can hold. */
  public static final Codec<Double> LONG_DOUBLE = plain(Codec::readLongDouble, Codec::writeLongDouble);
  public static final Codec<Reference> REFERENCE = new Of<>(
      r -> {
        String name = r.string();
        byte[] provider = r.bytes(16);
        return new Reference(name, provider, r.string());
      },
      (w, v, p) -> {
        w.string(v.interfaceName(), 0, p);
        w.bytes(v.provider());
        w.string(v.instance(), 0, p);
      },
      true);

  private static final int BIAS = 16383 - 1023;

  private static double readLongDouble(CdrReader reader) {
    long low = reader.int64();
    long high = reader.int64();
    int exponent = (int) (high >>> 48 & 0x7fff) - BIAS;
    long fraction = (high & 0xffffffffffffL) << 4 | low >>> 60;
    if (exponent <= 0) return high < 0 ? -0.0 : 0.0;
    if (exponent >= 0x7ff) fraction = exponent + BIAS == 0x7fff ? fraction : 0;
    return Double.longBitsToDouble(high & Long.MIN_VALUE | (long) Math.min(exponent, 0x7ff) << 52 | fraction);
  }

  private static void writeLongDouble(CdrWriter writer, double value, String place) {
    long bits = Double.doubleToRawLongBits(Math.abs(value) < Double.MIN_NORMAL ? 0 * value : value);
    int exponent = (int) (bits >>> 52 & 0x7ff);
    long wide = exponent == 0 ? 0 : exponent == 0x7ff ? 0x7fff : exponent + BIAS;
    writer.int64(bits << 60);
    writer.int64(bits & Long.MIN_VALUE | wide << 48 | (bits & 0xfffffffffffffL) >>> 4);
  }

  public static Codec<String> string(int bound) {
    return new Of<>(CdrReader::string, (w, v, p) -> w.string(v, bound, p), true);
  }

  public static Codec<String> wideString(int bound) {
    return new Of<>(
        r -> new String(r.bytes(r.int32()), StandardCharsets.UTF_16LE),
        (w, v, p) -> {
          CdrWriter.checkBound(v.length(), bound, p);
          w.int32(2 * v.length());
          w.bytes(v.getBytes(StandardCharsets.UTF_16LE));
        },
        true);
  }

  /** A sequence of octets, or, with {@code size}, an array. */
  public static Codec<byte[]> bytes(int bound, int size) {
    return new Of<>(
        r -> r.bytes(size > 0 ? size : r.length()),
        (w, v, p) -> {
          count(w, v.length, bound, size, p);
          w.bytes(v);
        },
        true);
  }

  private static void count(CdrWriter writer, int count, int bound, int size, String place) {
    CdrWriter.checkBound(count, bound, place);
    if (size == 0) writer.int32(count);
    else if (count != size) throw new InvalidArgument(place + " takes " + size + " elements, and was given " + count);
  }

  public static <T> Codec<List<T>> list(Codec<T> element, int bound) {
    return elements(element, bound, 0, element.isObject());
  }

  /** An array of arrays is one array on the wire. */
  @SuppressWarnings("unchecked")
  public static <A> Codec<A> array(Codec<?> item, int... sizes) {
    Codec<?> made = item;
    for (int i = sizes.length - 1; i >= 0; --i) made = elements(made, 0, sizes[i], i == 0 && item.isObject());
    return (Codec<A>) made;
  }

  private static <T> Codec<List<T>> elements(Codec<T> element, int bound, int size, boolean delimited) {
    return new Of<>(
        r -> r.delimited(r.isXcdr2() && delimited, () -> {
          List<T> list = new ArrayList<>();
          for (int left = size > 0 ? size : r.length(); left > 0; --left) list.add(element.read(r));
          return list;
        }),
        (w, v, p) -> w.delimited(w.isXcdr2() && delimited, () -> {
          count(w, v.size(), bound, size, p);
          for (T each : v) element.write(w, each, p);
        }),
        true);
  }

  /** A new array's elements. */
  public static <T> List<T> filled(int size, Supplier<T> element) {
    List<T> list = new ArrayList<>();
    for (int i = 0; i < size; ++i) list.add(element.get());
    return list;
  }

  /** A field of a bitset, as bits. */
  public static long field(long value, int width, boolean signed, String place) {
    long shifted = signed ? value << 64 - width >> 64 - width : value << 64 - width >>> 64 - width;
    if (shifted == value) return value << 64 - width >>> 64 - width;
    throw new InvalidArgument(place + " has " + width + " bits, and was given " + value);
  }

  public static <K, V> Codec<Map<K, V>> map(Codec<K> key, Codec<V> mapped, int bound) {
    return new Of<>(
        r -> r.delimited(r.isXcdr2(), () -> {
          Map<K, V> map = new LinkedHashMap<>();
          for (int left = r.length(); left > 0; --left) {
            K found = key.read(r);
            map.put(found, mapped.read(r));
          }
          return map;
        }),
        (w, v, p) -> w.delimited(w.isXcdr2(), () -> {
          count(w, v.size(), bound, 0, p);
          v.forEach((k, m) -> {
            key.write(w, k, p);
            mapped.write(w, m, p);
          });
        }),
        true);
  }

  /** An enumeration, a bitmask or a bitset: a number of so many bits. */
  public static <T> Codec<T> numbered(int bits, boolean object, Function<T, Long> number, Function<Long, T> value) {
    return new Of<>(
        r -> value.apply(bits == 8 ? (long) r.int8() : bits == 16 ? (long) r.int16() : bits == 32 ? (long) r.int32() : r.int64()),
        (w, v, p) -> {
          long written = number.apply(v);
          if (bits == 8) w.int8((int) written);
          else if (bits == 16) w.int16((int) written);
          else if (bits == 32) w.int32((int) written);
          else w.int64(written);
        },
        object);
  }

  /** One that is looked up when it is used: types may contain themselves. */
  public static <T> Codec<T> lazily(Supplier<Codec<T>> codec) {
    return new Of<>(r -> codec.get().read(r), (w, v, p) -> codec.get().write(w, v, p), true);
  }

  /** A member of a struct. An optional one may be null. */
  public static <S, T> Member<S, T> member(
      String name, int id, boolean mustUnderstand, boolean optional, Codec<T> codec, Function<S, T> get, BiConsumer<S, T> set) {
    return new Member<>(name, id, mustUnderstand, optional, codec, get, set);
  }

  public record Member<S, T>(
      String name, int id, boolean mustUnderstand, boolean optional, Codec<T> codec, Function<S, T> get, BiConsumer<S, T> set) {
    void write(CdrWriter writer, S struct, boolean byIdentifier, String place) {
      T value = get.apply(struct);
      String at = place + "." + name;
      if (byIdentifier) {
        if (optional && value == null) return;
        writer.int32((mustUnderstand ? 1 << 31 : 0) | 4 << 28 | id);
        writer.delimited(true, () -> codec.write(writer, value, at));
        return;
      }
      if (optional) writer.int8(value == null ? 0 : 1);
      if (!optional || value != null) codec.write(writer, value, at);
    }

    void read(CdrReader reader, S struct) {
      set.accept(struct, optional && reader.int8() == 0 ? null : codec.read(reader));
    }
  }

  /** A struct or an exception: {@code extensibility} is PLAIN, DELIMITED or PARAMETERS. */
  @SafeVarargs
  public static <S> Codec<S> struct(String name, int extensibility, Supplier<S> make, Member<S, ?>... members) {
    return new Of<>(
        r -> r.delimited(extensibility != PLAIN, () -> {
          S struct = make.get();
          if (extensibility == PARAMETERS) readByIdentifier(r, struct, members);
          else if (members.length == 0) r.int8();
          else for (Member<S, ?> each : members) each.read(r, struct);
          return struct;
        }),
        (w, v, p) -> w.delimited(extensibility != PLAIN, () -> {
          if (members.length == 0 && extensibility != PARAMETERS) w.int8(0);
          for (Member<S, ?> each : members) each.write(w, v, extensibility == PARAMETERS, name);
        }),
        true);
  }

  private static <S> void readByIdentifier(CdrReader reader, S struct, Member<S, ?>[] members) {
    while (reader.more()) {
      int header = reader.int32();
      int code = header >>> 28 & 7;
      int length = code < 4 ? 1 << code : reader.int32();
      reader.within(length, () -> {
        for (Member<S, ?> each : members) {
          if (each.id() == (header & 0xfffffff)) fill(reader, struct, each);
        }
        return null;
      });
    }
  }

  private static <S, T> void fill(CdrReader reader, S struct, Member<S, T> member) {
    member.set().accept(struct, member.codec().read(reader));
  }

  /** A union: {@code selected} gives the member for a discriminator, or null. */
  public static <U extends Union<D>, D> Codec<U> union(
      int extensibility, Supplier<U> make, Codec<D> discriminator, Function<D, Member<U, Object>> selected) {
    Member<U, D> label = new Member<>("discriminator", 0, true, false, discriminator, u -> u.discriminator, (u, d) -> u.discriminator = d);
    boolean byIdentifier = extensibility == PARAMETERS;
    return new Of<>(
        r -> r.delimited(extensibility != PLAIN, () -> {
          U union = make.get();
          readMember(r, byIdentifier, label, union);
          Member<U, Object> member = selected.apply(union.discriminator);
          union.value = null;
          if (member != null) readMember(r, byIdentifier, member, union);
          return union;
        }),
        (w, v, p) -> w.delimited(extensibility != PLAIN, () -> {
          label.write(w, v, byIdentifier, p);
          Member<U, Object> member = selected.apply(v.discriminator);
          if (member != null) member.write(w, v, byIdentifier, p);
        }),
        true);
  }

  private static <S, T> void readMember(CdrReader reader, boolean byIdentifier, Member<S, T> member, S struct) {
    if (!byIdentifier) {
      member.read(reader, struct);
      return;
    }
    reader.int32();
    reader.delimited(true, () -> {
      member.read(reader, struct);
      return null;
    });
  }

  /** The parameters, or the results, of an operation. */
  public static Codec<Object[]> members(String operation, Codec<?>... codecs) {
    return new Of<>(
        r -> {
          Object[] values = new Object[codecs.length];
          for (int i = 0; i < codecs.length; ++i) values[i] = codecs[i].read(r);
          return values;
        },
        (w, v, p) -> {
          if (codecs.length == 0) w.int8(0);
          for (int i = 0; i < codecs.length; ++i) writeAny(codecs[i], w, v[i], operation);
        },
        true);
  }

  @SuppressWarnings("unchecked")
  private static <T> void writeAny(Codec<T> codec, CdrWriter writer, Object value, String place) {
    codec.write(writer, (T) value, place);
  }
}
