// One who would command the vessel. Of several the strongest is obeyed; the next when that one is
// late.
#include <cstdlib>

#include "boat.idl.hpp"
#include "every.hpp"
#include "skein/entity.hpp"

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  const char* vendor = argc > 1 ? argv[1] : "fastdds";
  const char* name = argc > 2 ? argv[2] : "autopilot";
  const int strength = argc > 3 ? std::atoi(argv[3]) : 1;
  skein::Entity helm({.name = name, .vendor = skein::dds::load_vendor(vendor)});
  auto commands =
      helm.publisher<boat::Command>("command", skein::TopicQos::command(strength, 100ms));
  every(100ms, [&] { commands.publish({name, 1.0 + strength}); });
}
