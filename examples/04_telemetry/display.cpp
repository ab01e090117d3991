// Shows each change of command; ends after as many as it is told, or never.
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "boat.idl.hpp"
#include "skein/entity.hpp"

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  const char* vendor = argc > 1 ? argv[1] : "fastdds";
  const int changes = argc > 2 ? std::atoi(argv[2]) : -1;
  skein::Entity display({.name = "display", .vendor = skein::dds::load_vendor(vendor)});
  auto poses = display.subscription<boat::Pose>("pose", skein::TopicQos::sensor());
  std::string obeyed;
  for (int shown = 0; shown != changes; std::this_thread::sleep_for(20ms)) {
    const auto pose = poses.latest();  // polled: a display wants the newest, and no other
    if (!pose || pose->obeys == obeyed) continue;
    obeyed = pose->obeys;
    std::printf("obeys %s: %.1f m/s\n", obeyed.c_str(), pose->speed_m_s);
    std::fflush(stdout);
    ++shown;
  }
}
