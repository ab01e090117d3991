// A radar warner whose three classifiers vote. Each looks at the pulse in its own way; the Head
// asks all of them at once, takes no answer that is no radar, and is content as soon as two agree.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"
#include "warner.idl.hpp"

using namespace std::chrono_literals;
using warner::Pulse;

struct Radar {
  std::string name;
  Pulse pulse;
};

const std::vector<Radar> kKnown{
    {"weather", {5.6, 800, 0.9}}, {"search", {3.0, 2800, 6.0}}, {"tracking", {9.4, 250, 0.4}}};

/// A CSP: the known radar that is nearest by one way of looking at a pulse.
class Nearest : public warner::IClassifier {
 public:
  using Distance = std::function<double(const Pulse&, const Pulse&)>;
  explicit Nearest(Distance distance) : distance_(std::move(distance)) {}

  std::string classify(const Pulse& pulse) override {
    const auto nearest =
        std::min_element(kKnown.begin(), kKnown.end(), [&](const Radar& a, const Radar& b) {
          return distance_(a.pulse, pulse) < distance_(b.pulse, pulse);
        });
    return nearest->name;
  }

 private:
  Distance distance_;
};

/// A CSP that is defective: it answers, but with nonsense.
class Defective : public warner::IClassifier {
 public:
  std::string classify(const Pulse&) override { return "#?!"; }
};

std::optional<std::string> unknown(const std::string& name) {
  for (const Radar& radar : kKnown) {
    if (radar.name == name) return std::nullopt;
  }
  return "'" + name + "' is no radar";
}

/// The Body: states the task, and how results are judged and put together.
class WarnerBody : public warner::IRadarWarner {
 public:
  explicit WarnerBody(skein::Head& head) : head_(head) {}

  std::string identify(const Pulse& pulse) override {
    skein::Task<warner::IClassifier, std::string> task;
    task.run = [&](warner::IClassifier::Proxy& csp, skein::Duration) {
      return csp.async_classify(pulse);
    };
    task.execution = skein::Execution::All;
    task.evaluate.check("known radar", unknown);
    task.enough = 2;
    task.synthesis = skein::majority_vote<std::string>(2);
    try {
      return head_.perform(task);
    } catch (const skein::NoneAccepted& error) {
      throw warner::Unclear(error.what());
    }
  }

 private:
  skein::Head& head_;
};

double off(double a, double b) { return std::abs(std::log(a / b)); }

int main(int argc, char** argv) {
  const auto vendor = skein::dds::load_vendor(argc > 1 ? argv[1] : "loopback");

  skein::Entity warner({.name = "radar_warner", .vendor = vendor});
  const auto add = [&](const char* name, std::shared_ptr<warner::IClassifier> csp) {
    warner.provide_csp<warner::IClassifier>(name, warner.id(), std::move(csp));
  };
  add("ByFrequency", std::make_shared<Nearest>([](const Pulse& a, const Pulse& b) {
        return off(a.frequency_ghz, b.frequency_ghz);
      }));
  add("ByRhythm", std::make_shared<Nearest>([](const Pulse& a, const Pulse& b) {
        return off(a.interval_us, b.interval_us);
      }));
  add("ByPower", std::make_shared<Nearest>([](const Pulse& a, const Pulse& b) {
        return off(a.width_us / a.interval_us, b.width_us / b.interval_us);
      }));
  add("Defective", std::make_shared<Defective>());
  warner.provide<warner::IRadarWarner>(std::make_shared<WarnerBody>(warner.head()));

  skein::Entity pilot({.name = "pilot", .vendor = vendor});
  auto service = pilot.connect<warner::IRadarWarner>();
  for (const Pulse& pulse : {Pulse{9.1, 700, 1.1}, Pulse{5.5, 2700, 4.4}}) {
    try {
      std::printf("%.1f GHz, %.0f us: %s\n", pulse.frequency_ghz, pulse.interval_us,
                  service.within(2s).identify(pulse).c_str());
    } catch (const warner::Unclear& unclear) {
      std::printf("%.1f GHz, %.0f us: %s\n", pulse.frequency_ghz, pulse.interval_us,
                  unclear.why.c_str());
    }
  }
  std::fputs(skein::explain(warner.head().decisions().front()).c_str(), stdout);
}
