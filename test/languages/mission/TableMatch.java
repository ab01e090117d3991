import java.io.FileOutputStream;
import java.util.List;
import java.util.concurrent.atomic.AtomicBoolean;
import recon.IEmitterClassifier;
import recon.Identification;
import recon.Intercept;
import recon.NotSure;
import recon.RadarMode;
import skein.Entity;
import skein.Provider;

/** The Radar Warner's CSP TableMatch in Java, as examples/reconnaissance/threats/emitter_classification.hpp says: TableMatch DOMAIN VENDOR. */
final class TableMatch {
  private record Interval(double least, double greatest) {
    /** Whether a value is at most three standard deviations outside. */
    boolean isNear(double value, double sigma) {
      return value > least - 3 * sigma && value < greatest + 3 * sigma;
    }
  }

  private record EmitterClass(String type, RadarMode mode, Interval frequency, Interval pulseInterval, Interval scan, double prior) {
    boolean fits(Intercept measured) {
      return frequency.isNear(measured.frequency_hz, 20e6) && pulseInterval.isNear(measured.pulse_interval_s, 0.02 * measured.pulse_interval_s)
          && scan.isNear(measured.scan_s, 0.2);
    }
  }

  private static EmitterClass of(String type, RadarMode mode, double... numbers) {
    return new EmitterClass(type, mode, new Interval(numbers[0], numbers[1]), new Interval(numbers[2], numbers[3]),
        new Interval(numbers[4], numbers[5]), numbers[6]);
  }

  private static final List<EmitterClass> LIBRARY = List.of(
      of("short-range site", RadarMode.Search, 2.9e9, 3.1e9, 0.8e-3, 1.2e-3, 3.5, 4.5, 3),
      of("short-range site", RadarMode.Track, 8.6e9, 9.0e9, 180e-6, 220e-6, 0, 0, 2),
      of("short-range site", RadarMode.Guidance, 8.9e9, 9.2e9, 45e-6, 60e-6, 0, 0, 1),
      of("medium-range site", RadarMode.Search, 3.0e9, 3.3e9, 1.1e-3, 1.6e-3, 4, 6, 3),
      of("medium-range site", RadarMode.Track, 8.8e9, 9.4e9, 200e-6, 260e-6, 0, 0, 2),
      of("medium-range site", RadarMode.Guidance, 9.1e9, 9.6e9, 55e-6, 75e-6, 0, 0, 1),
      of("mobile gun", RadarMode.Search, 14.0e9, 15.0e9, 90e-6, 130e-6, 1.5, 2.5, 2),
      of("mobile gun", RadarMode.Track, 14.5e9, 15.5e9, 80e-6, 110e-6, 0, 0, 1),
      of("coast radar", RadarMode.Search, 3.0e9, 3.1e9, 1.0e-3, 1.3e-3, 2.5, 3.8, 1),
      of("air surveillance", RadarMode.Search, 1.25e9, 1.35e9, 2.5e-3, 4e-3, 9, 12, 2),
      of("air surveillance", RadarMode.Track, 3.1e9, 3.4e9, 1.5e-3, 2.2e-3, 5, 8, 1));

  private static final AtomicBoolean IDENTIFIED = new AtomicBoolean();

  private static Identification classify(List<Intercept> intercepts) {
    if (intercepts.isEmpty()) throw new NotSure("nothing was received");
    Intercept last = intercepts.get(intercepts.size() - 1);
    if (!IDENTIFIED.getAndSet(true)) System.out.println("TableMatch identifies in Java");
    List<EmitterClass> fitting = LIBRARY.stream().filter(each -> each.fits(last)).toList();
    return fitting.stream().reduce((a, b) -> b.prior > a.prior ? b : a)
        .map(first -> new Identification(first.type, first.mode, 1.0 / fitting.size())).orElse(new Identification("", RadarMode.Off, 1));
  }

  public static void main(String[] arguments) throws Exception {
    Entity.Options options = new Entity.Options("table_match");
    options.system = "uav-1";
    options.domain = Integer.parseInt(arguments[0]);
    options.vendor = arguments[1];
    Provider.Options csp = new Provider.Options();
    csp.csp = "TableMatch";
    csp.owner = "uav-1/radar_warner";
    csp.attributes.put("latency", "1 ms");
    csp.attributes.put("quality", "0.5");
    try (Entity own = new Entity(options)) {
      IEmitterClassifier.provide(own, train -> classify(train.intercepts), csp);
      try (FileOutputStream ready = new FileOutputStream("/proc/self/fd/" + System.getenv("SKEIN_READY_FD"))) {
        ready.write('\n');
      }
      Thread.currentThread().join(); // until it is told to end
    }
  }
}
