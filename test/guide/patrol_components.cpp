// What the peers of the guide's patrol load: they publish and subscribe, and provide nothing.
#include <chrono>
#include <cstdio>
#include <stdexcept>

#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "survey.idl.hpp"

using namespace std::chrono_literals;

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_activity("Beacon", [](skein::Entity& entity, const skein::ParameterValues& values,
                                     const std::stop_token& told_to_end) {
    const auto period =
        values.live<std::chrono::milliseconds>("Period", [](std::chrono::milliseconds wanted) {
          if (wanted > 10s) throw std::invalid_argument("nobody would see the drone move");
        });
    auto poses = entity.publisher<survey::Pose>("pose", skein::TopicQos::sensor());
    for (double north_m = 0; !skein::await_end(entity, told_to_end, period.get()); ++north_m)
      poses.publish({"drone", north_m, 0});
    return 0;  // the process's exit code
  });
  registry.add_activity("Chart", [](skein::Entity& entity, const skein::ParameterValues&,
                                    const std::stop_token& told_to_end) {
    auto poses = entity.subscription<survey::Pose>("pose", skein::TopicQos::sensor());
    while (!skein::await_end(entity, told_to_end, 50ms)) {
      const auto pose = poses.latest();
      if (!pose) continue;
      std::printf("%s: %.0f m north\n", pose->vehicle.c_str(), pose->north_m);
      return 0;
    }
    return 1;  // it was told to end before a pose came
  });
}
