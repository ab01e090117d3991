// One side of the table of languages, in C++: table_peer VENDOR SHARED_MEMORY provide|check. See
// table.py.
#include <cstdio>
#include <future>
#include <iostream>

#include "buoy.idl.hpp"
#include "skein/entity.hpp"
#include "skein/head.hpp"
#include "skein/task.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

class Buoy : public harbour::IBuoy {
 public:
  harbour::Wind wind(std::uint8_t level, double at, std::int64_t& stamp) override {
    if (level == 0) throw harbour::Fog("it lies low", at);
    stamp = 77;
    return {level, at * 2, harbour::Side::Starboard};
  }
  std::string greet(const std::string& name) override {
    if (name == "begun") return std::to_string(begun_) + " begun";
    return name == "cancelled" ? std::to_string(cancelled_) + " cancelled" : "Ahoy, " + name;
  }
  void forget() override {}
  void gusts(std::int32_t count, StreamSink<harbour::Wind>& out) override {
    for (std::int32_t i = 0; i < count; ++i) {
      out.push({static_cast<std::uint8_t>(i), i + 0.5, harbour::Side::Port});
    }
  }
  std::int32_t after(std::int32_t ms) override {
    const auto& call = *CallContext::current();
    ++begun_;
    if (test::eventually([&] { return call.cancelled(); }, std::chrono::milliseconds(ms)))
      ++cancelled_;
    return ms;
  }

 private:
  std::atomic<int> begun_{0};
  std::atomic<int> cancelled_{0};
};

class Reporter : public harbour::IReporter {
  harbour::Report report(const harbour::Report& earlier) override {
    return {earlier.winds, "C++", earlier.depth_m};
  }
};

void provide(Entity& own) {
  own.provide<harbour::IBuoy>(std::make_shared<Buoy>(), {.threads = 3});
  own.provide_csp<harbour::IReporter>("Cxx", "uav-1/checker", std::make_shared<Reporter>());
  auto depths = own.publisher<harbour::Depth>("depth", TopicQos::state());
  depths.publish({"quay", 4.5});
  std::puts("provides");
  std::fflush(stdout);
  std::cin.get();
}

bool calls(const harbour::IBuoy::Proxy& buoy) {
  std::int64_t stamp = 0;
  const harbour::Wind wind = buoy.wind(3, 1.5, stamp);
  try {
    buoy.wind(0, 1.25, stamp);
  } catch (const harbour::Fog& fog) {
    return wind == harbour::Wind{3, 3, harbour::Side::Starboard} && stamp == 77 &&
           fog.why == "it lies low" && fog.sight_m == 1.25;
  }
  return false;
}

bool calls_later(const harbour::IBuoy::Proxy& buoy) {
  std::vector<Call<std::string>> begun;
  for (int i = 0; i < 20; ++i) begun.push_back(buoy.async_greet(std::to_string(i)));
  bool right = true;
  for (int i = 0; i < 20; ++i) right &= begun[i].get() == "Ahoy, " + std::to_string(i);
  return right;
}

bool streams(const harbour::IBuoy::Proxy& buoy) {
  int next = 0;
  for (const harbour::Wind& gust : buoy.gusts(20)) next += gust.force == next ? 1 : 100;
  return next == 20;
}

bool subscribes(Entity& own) {
  std::promise<harbour::Depth> told;
  const auto subscription = own.subscription<harbour::Depth>(
      "depth", TopicQos::state(), [&](const harbour::Depth& depth) { told.set_value(depth); });
  return told.get_future().get() == harbour::Depth{"quay", 4.5};
}

/// A CSP of the provider, by the Head of this entity.
bool performs(Entity& own) {
  const Task<harbour::IReporter, harbour::Report> task{
      {}, [](harbour::IReporter::Proxy& csp, Duration) {
        return csp.async_report({{}, "", 3.5});
      }};
  return test::eventually([&] {
    try {
      return own.head().perform(task).depth_m == 3.5;
    } catch (const NoCandidate&) {
      return false;
    }
  });
}

bool cancels(const harbour::IBuoy::Proxy& buoy) {
  auto slow = buoy.async_after(60'000);
  if (!test::eventually([&] { return buoy.greet("begun") != "0 begun"; })) return false;
  slow.cancel();
  return test::eventually([&] { return buoy.greet("cancelled") != "0 cancelled"; });
}

bool keeps_deadlines(harbour::IBuoy::Proxy buoy) {
  try {
    buoy.within(100ms).after(60'000);
  } catch (const TimedOut&) {
    return true;
  }
  return false;
}

void tell(const char* feature, bool right) {
  std::printf("%s %s\n", feature, right ? "ok" : "wrong");
  std::fflush(stdout);
}

void check(Entity& own) {
  const auto buoy = own.connect<harbour::IBuoy>({.timeout = 30s}).within(30s);
  tell("call", calls(buoy));
  tell("asynchronous", calls_later(buoy));
  tell("stream", streams(buoy));
  tell("topics", subscribes(own));
  tell("CSP", performs(own));
  tell("cancel", cancels(buoy));
  tell("deadline", keeps_deadlines(buoy));
}

}  // namespace

int main(int, char** arguments) {
  const bool provides = arguments[3] == std::string("provide");
  EntityOptions options{.name = provides ? "provider" : "checker", .system = "uav-1"};
  options.vendor = dds::load_vendor(arguments[1]);
  options.domain = 17;
  options.lease = 60s;
  options.shared_memory_calls = arguments[2] == std::string("yes");
  Entity own(options);
  provides ? provide(own) : check(own);
}
