// Whom the commands speak to: station_process VENDOR DOMAIN. It provides a surveyor, publishes
// `corner` twenty times a second and subscribes to `plot`. It says `ready`, `inside` when somebody
// greets it as "forever", which it never answers, and `heard N` of a plot with N corners.
#include <poll.h>
#include <unistd.h>

#include <iostream>
#include <mutex>

#include "skein/entity.hpp"
#include "skein/log.hpp"
#include "test/dynamic/surveyor.hpp"

using namespace skein;

namespace {

constexpr int kPeriodMs = 50;

void say(const std::string& line) {
  static std::mutex mutex;
  std::lock_guard lock(mutex);
  std::cout << line << std::endl;
}

class Station final : public test::Surveyor {
 public:
  std::string greet(const std::string& name) override {
    log(LogLevel::Info, "greeter", "greets " + name);
    if (name != "forever") return Surveyor::greet(name);
    say("inside");
    for (;;) pause();
  }
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  EntityOptions options;
  options.name = "station";
  options.system = "field";
  options.vendor = dds::load_vendor(arguments[1]);
  options.domain = static_cast<std::uint32_t>(std::stoul(arguments[2]));
  Entity entity(std::move(options));
  entity.provide<survey::ISurveyor>(std::make_shared<Station>());
  const auto plots = entity.subscription<survey::Plot>(
      "plot", TopicQos(),
      [](const survey::Plot& plot) { say("heard " + std::to_string(plot.corners.size())); });
  auto corners = entity.publisher<survey::Corner>("corner", TopicQos());
  say("ready");
  pollfd input{STDIN_FILENO, POLLIN, 0};
  for (double x = 0; poll(&input, 1, kPeriodMs) == 0; ++x) corners.publish({x, 0.5});
}
