#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <iostream>
#include <sstream>
#include <thread>

#include "navigator.hpp"
#include "site.hpp"
#include "skein/log.hpp"

using namespace std::chrono_literals;

namespace {

/// Notes on which thread it was called.
struct NotingSurveyor : Surveyor {
  double minutes(const survey::Area& area) override {
    ran_on = std::this_thread::get_id();
    return Surveyor::minutes(area);
  }
  std::atomic<std::thread::id> ran_on;
};

}  // namespace

TEST_CASE("a sink hands the lines of the log to another logger") {
  std::ostringstream journal;
  std::streambuf* const before = std::cerr.rdbuf(journal.rdbuf());
  skein::set_log_sink([](const skein::LogLine& line) {
    constexpr std::array kPriority{"<7>", "<6>", "<4>", "<3>"};  // of sd-daemon(3)
    std::cerr << kPriority[static_cast<std::size_t>(line.level)] << line.place << ": " << line.text
              << std::endl;
  });
  skein::log(skein::LogLevel::Info, "survey", "begins");
  skein::log(skein::LogLevel::Error, "survey", "ends");
  skein::set_log_sink({});
  std::cerr.rdbuf(before);
  CHECK(journal.str() == "<6>survey: begins\n<3>survey: ends\n");
}

TEST_CASE("a service declares on which thread its calls run") {
  Site site;
  skein::Entity& drone = site.drone;
  const auto surveyor = std::make_shared<NotingSurveyor>();
  const auto bounded = std::make_shared<NotingSurveyor>();

  const skein::Guid own = drone.provide<survey::ISurveyor>(
      surveyor, {.thread = skein::CallThread::Own});  // as without it
  const skein::Guid callers =
      drone.provide<survey::ISurveyor>(bounded, {.thread = skein::CallThread::Caller});

  drone.connect<survey::ISurveyor>({.provider = own}).within(30s).minutes(kField);
  CHECK(surveyor->ran_on.load() != std::this_thread::get_id());
  drone.connect<survey::ISurveyor>({.provider = callers}).within(30s).minutes(kField);
  CHECK(bounded->ran_on.load() == std::this_thread::get_id());
}

TEST_CASE("a CSP declares it, too") {
  Site site;
  skein::Entity& drone = site.drone;

  drone.provide_csp<survey::IPlanner>("Spiral", drone.id(), std::make_shared<Spiral>(),
                                      {.thread = skein::CallThread::Caller});

  drone.provide<survey::INavigator>(std::make_shared<Navigator>(drone.head()));
  auto navigator = site.station.connect<survey::INavigator>();
  CHECK(navigator.within(30s).plan(kField).planner == "Spiral");
}
