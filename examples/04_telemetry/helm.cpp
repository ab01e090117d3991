// One who would command the vessel. Of several the strongest is obeyed; the next when that one is
// late.
#include <cstdlib>
#include <thread>

#include "boat.idl.hpp"
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/process.hpp"

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  const char* vendor = argc > 1 ? argv[1] : "fastdds";
  const char* name = argc > 2 ? argv[2] : "autopilot";
  const int strength = argc > 3 ? std::atoi(argv[3]) : 1;
  skein::Entity helm({.name = name, .vendor = skein::dds::load_vendor(vendor)});
  auto commands =
      helm.publisher<boat::Command>("command", skein::TopicQos::command(strength, 100ms));
  std::jthread steers([&](const std::stop_token& told_to_end) {
    while (!skein::await_end(helm, told_to_end, 100ms)) commands.publish({name, 1.0 + strength});
  });
  skein::wait_for_signal();
}
