#include <sys/select.h>
#include <unistd.h>

#include <string>

#include "skein/entity.hpp"
#include "stage.idl.hpp"

// An entity for others to look at: `view_stage VENDOR DOMAIN`, until its standard input ends.
namespace {

class Calculator : public stage::ICalculator {
  double add(double a, double b) override { return a + b; }
  void fail() override { throw stage::Broken("the seventh gear"); }
};

/// Whether standard input has ended; waits for that as long as the pace of the poses asks.
bool is_over() {
  fd_set waited;
  FD_ZERO(&waited);
  FD_SET(STDIN_FILENO, &waited);
  timeval pace{0, 10'000};
  return select(STDIN_FILENO + 1, &waited, nullptr, nullptr, &pace) > 0;
}

}  // namespace

int main(int, char** argv) {
  skein::Entity entity({.name = "stage",
                        .system = "site",
                        .vendor = skein::dds::load_vendor(argv[1]),
                        .domain = static_cast<std::uint32_t>(std::stoul(argv[2]))});
  entity.provide<stage::ICalculator>(std::make_shared<Calculator>());
  auto poses = entity.publisher<stage::Pose>("pose", skein::TopicQos::sensor());
  auto modes = entity.publisher<stage::Mode>("mode", skein::TopicQos::state());
  auto commands = entity.subscription<stage::Point>("command");
  modes.publish({"uav-1", stage::Phase::Flying});
  stage::Pose pose{0, {1.5, -2.5}, {{1, 2}, {3, 4}}, "über den Wolken"};
  while (!is_over()) {
    ++pose.number;
    poses.publish(pose);
  }
}
