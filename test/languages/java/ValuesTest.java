import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import harbour.Cargo;
import harbour.Content;
import harbour.Dangers;
import harbour.Depth;
import harbour.Side;
import harbour.Wind;
import java.time.Duration;
import java.util.List;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.TimeUnit;
import org.junit.jupiter.api.Test;
import skein.Entity;
import skein.InvalidArgument;
import skein.Publisher;
import skein.Subscription;
import skein.TopicProfile;
import skein.TypeSupport;

/** Values as C++ reads, checks and writes them, on a topic. */
class ValuesTest {
  private static <T> T back(TypeSupport<T> type, T value) throws Exception {
    CompletableFuture<T> told = new CompletableFuture<>();
    try (Entity entity = Peer.entity("values", "loopback", Duration.ZERO);
        Publisher<T> publisher = entity.publisher(type, "values", TopicProfile.STATE);
        Subscription<T> subscription = entity.subscribe(type, "values", TopicProfile.STATE, told::complete)) {
      publisher.publish(value);
      return told.get(30, TimeUnit.SECONDS);
    }
  }

  private static Cargo cargo() {
    Cargo cargo = new Cargo();
    cargo.name = "wide \ud83d\udc1f";
    cargo.dangers = Dangers.fire | Dangers.poison;
    cargo.seal.ring = 5;
    cargo.seal.number = 31;
    cargo.sides.get(1).set(2, 4.5);
    cargo.shelves.add(List.of(1, -2));
    cargo.winds.put("bow", new Wind(1, 2.5, Side.Starboard));
    cargo.content = Content.winds(List.of(new Wind()));
    cargo.inner.add(new Cargo());
    cargo.mark = 'm';
    cargo.letter = '\u0416';
    cargo.fragile = true;
    cargo.exact = -0.375;
    cargo.depth = new Depth("quay", 3.5);
    cargo.names.add("");
    return cargo;
  }

  @Test
  void aValueOfEveryKindComesBack() throws Exception {
    assertEquals(cargo(), back(Cargo.TYPE, cargo()));
    assertEquals(new Cargo(), back(Cargo.TYPE, new Cargo()));
  }

  @Test
  void longDoublesKeepWhatADoubleHas() throws Exception {
    for (double each : new double[] {0, -0.0, 1, -1e300, 1e-300, Double.MAX_VALUE, Double.MIN_NORMAL, Double.POSITIVE_INFINITY, Math.PI}) {
      Cargo cargo = new Cargo();
      cargo.exact = each;
      assertEquals(each, back(Cargo.TYPE, cargo).exact);
    }
  }

  @Test
  void aUnionIsReadByItsMembers() {
    Content content = Content.label("fish");
    assertEquals("fish", content.label());
    assertTrue(assertThrows(IllegalStateException.class, content::winds).getMessage().contains("does not hold 'winds'"));
  }

  @Test
  void whatFitsNoMemberIsRefusedWithItsPlace() throws Exception {
    Cargo cargo = cargo();
    cargo.seal.ring = 8;
    assertEquals("harbour::Seal.ring has 3 bits, and was given 8", refused(cargo));
    cargo = cargo();
    cargo.content = Content.label("x".repeat(41));
    assertTrue(refused(cargo).contains("label takes 40 at most, and was given 41"));
    cargo = cargo();
    cargo.names.add(null);
    assertEquals("harbour::Cargo.names is null", refused(cargo));
    cargo = cargo();
    cargo.sides.remove(0);
    assertEquals("harbour::Cargo.sides takes 2 elements, and was given 1", refused(cargo));
  }

  private static String refused(Cargo cargo) {
    return assertThrows(InvalidArgument.class, () -> back(Cargo.TYPE, cargo)).getMessage();
  }
}
