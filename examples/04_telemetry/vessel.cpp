// The vessel: obeys whoever has command, and publishes its state as a sensor does.
#include <cstdio>
#include <mutex>
#include <thread>

#include "boat.idl.hpp"
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/process.hpp"

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  const char* vendor = argc > 1 ? argv[1] : "cyclonedds";
  skein::Entity vessel({.name = "vessel", .vendor = skein::dds::load_vendor(vendor)});

  std::mutex mutex;  // callbacks run on a thread of the entity's
  boat::Pose pose;
  const auto obey = [&](const boat::Command& command) {
    std::lock_guard lock(mutex);
    pose.speed_m_s = command.speed_m_s;
    pose.obeys = command.source;
  };
  const auto commands =
      vessel.subscription<boat::Command>("command", skein::TopicQos::command(), obey);

  auto poses = vessel.publisher<boat::Pose>("pose", skein::TopicQos::sensor());
  std::jthread sails([&](const std::stop_token& told_to_end) {
    while (!skein::await_end(vessel, told_to_end, 50ms)) {
      std::lock_guard lock(mutex);
      pose.along_m += pose.speed_m_s * 0.05;
      poses.publish(pose);
    }
  });
  std::puts("Under way, until Ctrl-C.");
  skein::wait_for_signal();
  std::printf("%llu commands, %llu missed\n",
              static_cast<unsigned long long>(commands.counters().received),
              static_cast<unsigned long long>(commands.counters().missed_deadlines));
}
