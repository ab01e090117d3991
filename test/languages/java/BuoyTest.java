import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import harbour.Depth;
import harbour.Fog;
import harbour.IBuoy;
import harbour.IReporter;
import harbour.Report;
import harbour.Side;
import harbour.Wind;
import java.time.Duration;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.CopyOnWriteArrayList;
import java.util.concurrent.ExecutionException;
import java.util.function.Consumer;
import org.junit.jupiter.api.AfterEach;
import org.junit.jupiter.api.BeforeEach;
import org.junit.jupiter.api.Test;
import skein.Entity;
import skein.Internal;
import skein.InvalidArgument;
import skein.Overloaded;
import skein.Provider;
import skein.Proxy;
import skein.Publisher;
import skein.ResultStream;
import skein.Subscription;
import skein.TimedOut;
import skein.TopicProfile;
import skein.Unavailable;

/** A service in Java, and its caller. */
class BuoyTest {
  private final Buoy buoy = new Buoy();
  private Entity server;
  private Entity client;
  private IBuoy.Proxy proxy;

  @BeforeEach
  void meet() {
    server = Peer.entity("server", Peer.SERVER, Duration.ZERO);
    client = Peer.entity("client", Peer.CLIENT, Duration.ZERO);
    Provider.Options options = new Provider.Options();
    options.threads = 2;
    IBuoy.provide(server, buoy, options);
    proxy = IBuoy.connect(client, patiently());
  }

  private static Proxy.Choice patiently() {
    Proxy.Choice choice = new Proxy.Choice();
    choice.timeout = Peer.PATIENCE;
    return choice;
  }

  @AfterEach
  void part() {
    client.close();
    server.close();
  }

  @Test
  void callsBringResultsAndExceptions() throws InterruptedException {
    assertEquals("uav-1/server", server.id());
    assertEquals("Ahoy, wörld", proxy.greet("wörld"));
    assertEquals(new IBuoy.WindResult(new Wind(3, 3, Side.Starboard), 77), proxy.wind(3, 1.5));
    Fog fog = assertThrows(Fog.class, () -> proxy.wind(0, 1.25));
    assertEquals("Fog[it lies low, 1.25]", fog.getMessage());
    proxy.forget();
    Peer.eventually(() -> buoy.forgotten.get() == 1);
  }

  @Test
  void typesThatGrowTravel() {
    IReporter.provide(server, earlier -> new Report(List.of(new Wind(9, 1, Side.Port)), earlier.place + " again", null));
    Report report = IReporter.connect(client, patiently()).report(new Report(List.of(), "quay", 3.5));
    assertEquals(new Report(List.of(new Wind(9, 1, Side.Port)), "quay again", null), report);
  }

  @Test
  void asynchronousCallsAreFutures() throws Exception {
    List<CompletableFuture<String>> calls = new ArrayList<>();
    for (int i = 0; i < 50; ++i) calls.add(proxy.greetAsync("no. " + i));
    for (int i = 0; i < 50; ++i) assertEquals("Ahoy, no. " + i, calls.get(i).get());
    ExecutionException failed = assertThrows(ExecutionException.class, () -> proxy.windAsync(0, 1).get());
    assertTrue(failed.getCause() instanceof Fog);
  }

  @Test
  void whatIsCancelledIsCancelledAtItsProvider() throws InterruptedException {
    CompletableFuture<Integer> call = proxy.within(Duration.ofMinutes(1)).afterAsync(50_000);
    Peer.eventually(() -> buoy.begun.get() == 1);
    call.cancel(true);
    Peer.eventually(() -> buoy.cancelled.get() == 1);
    assertThrows(TimedOut.class, () -> proxy.within(Duration.ofMillis(50)).after(50_000));
  }

  @Test
  void streamsEndOrAreClosed() {
    List<Integer> forces = new ArrayList<>();
    for (Wind gust : proxy.gusts(100)) forces.add(gust.force);
    assertEquals(100, forces.size());
    assertEquals(99, forces.get(99));
    try (ResultStream<Wind> gusts = proxy.gusts(10_000_000)) {
      assertEquals(0.5, gusts.next().speed_m_s);
    }
    assertEquals("Ahoy, again", proxy.greet("again"));
  }

  @Test
  void errorsSayWhatCanBeDone() {
    Proxy.Choice soon = new Proxy.Choice();
    soon.timeout = Duration.ofMillis(100);
    assertTrue(assertThrows(Unavailable.class, () -> IReporter.connect(client, soon)).getMessage().contains("IReporter"));
    InvalidArgument wrong = assertThrows(InvalidArgument.class, () -> proxy.wind(256, 1));
    assertEquals("harbour::IBuoy::wind takes 0 to 255, and was given 256", wrong.getMessage());
    assertThrows(InvalidArgument.class, () -> proxy.greet(null));
  }

  @Test
  void whatAServiceThrowsIsToldByItsClass() {
    Provider.Options options = new Provider.Options();
    options.attributes.put("quality", "0.5");
    server.close();
    server = Peer.entity("server", Peer.SERVER, Duration.ZERO);
    IBuoy.provide(server, new Buoy() {
      @Override
      public String greet(String name) {
        throw name.equals("late") ? new Overloaded("not now") : new IllegalStateException("a bug");
      }
    }, options);
    IBuoy.Proxy failing = IBuoy.connect(client, patiently());
    assertEquals("not now", assertThrows(Overloaded.class, () -> failing.greet("late")).getMessage());
    assertTrue(assertThrows(Internal.class, () -> failing.greet("bug")).getMessage().contains("a bug"));
  }

  @Test
  void anExceptionThatCannotBeToldIsToldAsSuch() {
    server.close();
    server = Peer.entity("server", Peer.SERVER, Duration.ZERO);
    IBuoy.provide(server, new Buoy() {
      @Override
      public IBuoy.WindResult wind(int level, double at) {
        throw new Fog(null, at);
      }
    });
    IBuoy.Proxy failing = IBuoy.connect(client, patiently()).within(Peer.PATIENCE);
    assertTrue(assertThrows(InvalidArgument.class, () -> failing.wind(1, 1)).getMessage().contains("harbour::Fog.why is null"));
  }

  @Test
  void aCspServesItsOwnerAlone() {
    Provider.Options options = new Provider.Options();
    options.csp = "Java";
    options.owner = server.id();
    options.attributes.put("quality", "0.9");
    IReporter.provide(server, earlier -> earlier, options);
    Proxy.Choice soon = new Proxy.Choice();
    soon.timeout = Duration.ofMillis(300);
    assertThrows(Unavailable.class, () -> IReporter.connect(client, soon));
  }

  @Test
  void topicsCarryValues() throws InterruptedException {
    List<Depth> told = new CopyOnWriteArrayList<>();
    Consumer<Depth> tell = told::add;
    try (Publisher<Depth> depths = server.publisher(Depth.TYPE, "depth", TopicProfile.EVERY_VALUE);
        Subscription<Depth> subscription = client.subscribe(Depth.TYPE, "depth", TopicProfile.EVERY_VALUE, tell)) {
      Peer.eventually(() -> depths.subscribers() == 1 && subscription.publishers() == 1);
      for (int i = 0; i < 5; ++i) depths.publish(new Depth("quay", i));
      Peer.eventually(() -> told.size() == 5);
      assertEquals(new Depth("quay", 4), told.get(4));
    }
  }
}
