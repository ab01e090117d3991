import harbour.Fog;
import harbour.IBuoy;
import harbour.Side;
import harbour.Wind;
import java.util.concurrent.atomic.AtomicInteger;
import java.util.function.Consumer;
import skein.Provider;

/** The service that is called here. */
class Buoy implements IBuoy {
  final AtomicInteger forgotten = new AtomicInteger();
  final AtomicInteger begun = new AtomicInteger();
  final AtomicInteger cancelled = new AtomicInteger();

  @Override
  public WindResult wind(int level, double at) {
    if (level == 0) throw new Fog("it lies low", at);
    return new WindResult(new Wind(level, 2 * at, Side.Starboard), 77);
  }

  @Override
  public String greet(String name) {
    return "Ahoy, " + name;
  }

  @Override
  public void forget() {
    forgotten.incrementAndGet();
  }

  @Override
  public void gusts(int count, Consumer<Wind> items) {
    for (int i = 0; i < count; ++i) items.accept(new Wind(i, i + 0.5, Side.Port));
  }

  @Override
  public int after(int ms) {
    Provider.Context call = Provider.Context.current();
    begun.incrementAndGet();
    try {
      for (long end = System.nanoTime() + ms * 1_000_000L; System.nanoTime() < end && !call.cancelled(); ) Thread.sleep(1);
    } catch (InterruptedException ended) {
      Thread.currentThread().interrupt();
    }
    if (call.cancelled()) cancelled.incrementAndGet();
    return ms;
  }
}
