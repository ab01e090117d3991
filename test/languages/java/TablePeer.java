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
import java.util.concurrent.Callable;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.TimeUnit;
import skein.Entity;
import skein.Provider;
import skein.Proxy;
import skein.Subscription;
import skein.TimedOut;
import skein.TopicProfile;

/** One side of the table of languages, in Java: VENDOR SHARED_MEMORY provide|check. See table.py. */
final class TablePeer {
  private static final class Told extends Buoy {
    @Override
    public String greet(String name) {
      if (name.equals("begun")) return begun + " begun";
      return name.equals("cancelled") ? cancelled + " cancelled" : super.greet(name);
    }
  }

  public static void main(String[] arguments) throws Exception {
    boolean provides = arguments[2].equals("provide");
    Entity.Options options = new Entity.Options(provides ? "provider" : "checker");
    options.system = "uav-1";
    options.vendor = arguments[0];
    options.domain = 17;
    options.lease = Duration.ofMinutes(1);
    options.sharedMemoryCalls = arguments[1].equals("yes");
    try (Entity own = new Entity(options)) {
      if (provides) provide(own);
      else check(own);
    }
  }

  private static void provide(Entity own) throws Exception {
    Provider.Options threads = new Provider.Options();
    threads.threads = 3;
    IBuoy.provide(own, new Told(), threads);
    Provider.Options csp = new Provider.Options();
    csp.csp = "Java";
    csp.owner = "uav-1/checker";
    IReporter.provide(own, earlier -> new Report(earlier.winds, "Java", earlier.depth_m), csp);
    own.publisher(Depth.TYPE, "depth", TopicProfile.STATE).publish(new Depth("quay", 4.5));
    System.out.println("provides");
    while (System.in.read() >= 0) {}
  }

  private static void tell(String feature, Callable<Boolean> check) throws Exception {
    System.out.println(feature + (check.call() ? " ok" : " wrong"));
  }

  private static void check(Entity own) throws Exception {
    Proxy.Choice choice = new Proxy.Choice();
    choice.timeout = Duration.ofSeconds(30);
    IBuoy.Proxy buoy = IBuoy.connect(own, choice).within(Duration.ofSeconds(30));
    tell("call", () -> calls(buoy));
    tell("asynchronous", () -> callsLater(buoy));
    tell("stream", () -> streams(buoy));
    tell("topics", () -> subscribes(own));
    tell("cancel", () -> cancels(buoy));
    tell("deadline", () -> keepsDeadlines(buoy));
  }

  private static boolean calls(IBuoy.Proxy buoy) {
    IBuoy.WindResult result = buoy.wind(3, 1.5);
    try {
      buoy.wind(0, 1.25);
      return false;
    } catch (Fog fog) {
      return result.equals(new IBuoy.WindResult(new Wind(3, 3, Side.Starboard), 77)) && fog.why.equals("it lies low") && fog.sight_m == 1.25;
    }
  }

  private static boolean callsLater(IBuoy.Proxy buoy) throws Exception {
    List<CompletableFuture<String>> begun = new ArrayList<>();
    for (int i = 0; i < 20; ++i) begun.add(buoy.greetAsync("" + i));
    boolean right = true;
    for (int i = 0; i < 20; ++i) right &= begun.get(i).get().equals("Ahoy, " + i);
    return right;
  }

  private static boolean streams(IBuoy.Proxy buoy) {
    int next = 0;
    for (Wind gust : buoy.gusts(20)) next += gust.force == next ? 1 : 100;
    return next == 20;
  }

  private static boolean subscribes(Entity own) throws Exception {
    CompletableFuture<Depth> told = new CompletableFuture<>();
    try (Subscription<Depth> subscription = own.subscribe(Depth.TYPE, "depth", TopicProfile.STATE, told::complete)) {
      return told.get(30, TimeUnit.SECONDS).equals(new Depth("quay", 4.5));
    }
  }

  private static boolean cancels(IBuoy.Proxy buoy) throws InterruptedException {
    CompletableFuture<Integer> slow = buoy.afterAsync(60_000);
    if (!awaitCount(buoy, "begun")) return false;
    slow.cancel(true);
    return awaitCount(buoy, "cancelled");
  }

  /** Until the provider has counted one. */
  private static boolean awaitCount(IBuoy.Proxy buoy, String of) throws InterruptedException {
    for (int i = 0; i < 10_000; ++i) {
      if (!buoy.greet(of).equals("0 " + of)) return true;
      Thread.sleep(2);
    }
    return false;
  }

  private static boolean keepsDeadlines(IBuoy.Proxy buoy) {
    try {
      buoy.within(Duration.ofMillis(100)).after(60_000);
      return false;
    } catch (TimedOut late) {
      return true;
    }
  }
}
