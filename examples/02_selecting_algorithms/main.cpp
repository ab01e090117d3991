// An entity with two algorithms for one task. Which of them runs, its Head decides by the time that
// the caller gives.
#include <cstdio>

#include "estimators.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"

using namespace std::chrono_literals;

/// The Body: holds no algorithm of its own, and hands the task to whichever CSP the Head selects.
class BatteryBody : public battery::IBattery {
 public:
  explicit BatteryBody(skein::Head& head) : head_(head) {}

  double endurance_min(const battery::Plan& plan, std::string& estimated_by) override {
    if (plan.power_w.empty())
      throw skein::InvalidArgument("a plan needs the power of one minute at least");
    skein::Task<battery::IEstimator, double> task;
    task.run = [&](battery::IEstimator::Proxy& csp, skein::Duration) {
      return csp.endurance_min(plan);
    };
    task.evaluate = [](const double& minutes) {
      return minutes > 0 ? std::nullopt : std::optional<std::string>("no battery lasts so short");
    };
    skein::introspection::Decision record;
    const double minutes = head_.perform(task, &record);
    estimated_by = record.attempts.back().csp + ": " + record.attempts.back().reason;
    return minutes;
  }

 private:
  skein::Head& head_;
};

/// What a CSP's description declares, and the Head selects by.
skein::ServiceOptions declared(const char* latency_ms, const char* quality) {
  return {.attributes = {{"latency", latency_ms}, {"quality", quality}}};
}

int main(int argc, char** argv) {
  const auto vendor = skein::dds::load_vendor(argc > 1 ? argv[1] : "loopback");

  skein::Entity monitor({.name = "battery_monitor", .vendor = vendor});
  monitor.provide_csp<battery::IEstimator>("MeanPower", monitor.id(), std::make_shared<MeanPower>(),
                                           declared("1", "0.2"));
  monitor.provide_csp<battery::IEstimator>("Discharge", monitor.id(), std::make_shared<Discharge>(),
                                           declared("500", "0.9"));
  monitor.provide<battery::IBattery>(std::make_shared<BatteryBody>(monitor.head()));

  skein::Entity pilot({.name = "pilot", .vendor = vendor});
  auto battery = pilot.connect<battery::IBattery>();
  const battery::Plan plan{.capacity_wh = 90, .power_w = {400, 400, 180, 180, 180, 350}};
  for (const auto time : {100ms, 5000ms}) {
    std::string estimated_by;
    const double minutes = battery.within(time).endurance_min(plan, estimated_by);
    std::printf("with %lld ms: %.1f min (%s)\n", static_cast<long long>(time.count()), minutes,
                estimated_by.c_str());
  }
}
