import static org.junit.jupiter.api.Assertions.assertTrue;

import java.io.BufferedReader;
import java.io.IOException;
import java.time.Duration;
import java.util.function.BooleanSupplier;
import skein.Entity;

/** What tests share: the vendors of a pairing, entities, and a peer in C. */
final class Peer implements AutoCloseable {
  private static final String[] PAIRING = System.getenv().getOrDefault("SKEIN_PAIRING", "loopback:loopback").split(":");
  static final String SERVER = PAIRING[0];
  static final String CLIENT = PAIRING[1];
  static final Duration PATIENCE = Duration.ofSeconds(30);

  static Entity entity(String name, String vendor, Duration lease) {
    Entity.Options options = new Entity.Options(name);
    options.system = "uav-1";
    options.vendor = vendor;
    options.domain = 17;
    options.lease = lease;
    return new Entity(options);
  }

  static void eventually(BooleanSupplier condition) throws InterruptedException {
    for (long end = System.nanoTime() + PATIENCE.toNanos(); !condition.getAsBoolean() && System.nanoTime() < end; ) Thread.sleep(2);
    assertTrue(condition.getAsBoolean());
  }

  final Process process;
  private final BufferedReader told;

  Peer(String vendor, String side) throws IOException {
    process = new ProcessBuilder(System.getenv("SKEIN_BUOY_PEER"), vendor, side).redirectError(ProcessBuilder.Redirect.INHERIT).start();
    told = process.inputReader();
  }

  void expect(String line) throws IOException {
    for (String each = told.readLine(); !line.equals(each); each = told.readLine()) {
      if (each == null) throw new AssertionError("the peer ended, and did not say " + line);
    }
  }

  void kill() {
    process.destroyForcibly();
  }

  @Override
  public void close() {
    kill();
  }
}
