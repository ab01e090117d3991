import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import harbour.IBuoy;
import java.time.Duration;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.CountDownLatch;
import java.util.concurrent.ExecutionException;
import java.util.concurrent.TimeUnit;
import java.util.concurrent.atomic.AtomicBoolean;
import org.junit.jupiter.api.Test;
import skein.Disconnected;
import skein.Entity;
import skein.Provider;
import skein.Proxy;

/** The lease is a minute: of a death the kernel tells. */
class DeathTest {
  private static final Duration LEASE = Duration.ofMinutes(1);

  @Test
  void theDeathOfAProviderEndsItsCallsAndItsNextLifeServes() throws Exception {
    try (Entity client = Peer.entity("mourner", Peer.CLIENT, LEASE)) {
      IBuoy.Proxy buoy;
      try (Peer peer = new Peer(Peer.SERVER, "provide")) {
        peer.expect("provides");
        Proxy.Choice choice = new Proxy.Choice();
        choice.timeout = Peer.PATIENCE;
        buoy = IBuoy.connect(client, choice).within(Peer.PATIENCE);
        CompletableFuture<String> call = buoy.greetAsync("nobody");
        peer.expect("called");
        peer.kill();
        ExecutionException ended = assertThrows(ExecutionException.class, () -> call.get(30, TimeUnit.SECONDS));
        assertTrue(ended.getCause() instanceof Disconnected, ended.toString());
      }
      try (Peer peer = new Peer(Peer.SERVER, "provide")) {
        peer.expect("provides");
        assertEquals("you", buoy.greet("you"));
      }
    }
  }

  @Test
  void theDeathOfACallerCancelsItsCalls() throws Exception {
    CountDownLatch called = new CountDownLatch(1);
    AtomicBoolean gone = new AtomicBoolean();
    try (Entity server = Peer.entity("waiting", Peer.SERVER, LEASE); Peer peer = startCaller(server, called, gone)) {
      assertTrue(called.await(30, TimeUnit.SECONDS));
      peer.kill();
      Peer.eventually(gone::get);
    }
  }

  private static Peer startCaller(Entity server, CountDownLatch called, AtomicBoolean gone) throws Exception {
    IBuoy.provide(server, new Buoy() {
      @Override
      public String greet(String name) {
        called.countDown();
        after(30_000);
        gone.set(Provider.Context.current().cancelled());
        return name;
      }
    });
    return new Peer(Peer.CLIENT, "call");
  }
}
