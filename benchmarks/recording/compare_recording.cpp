#include "recording/compare_recording.hpp"

#include <list>
#include <thread>

#include "calls/contest.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

constexpr auto kPatience = 20s;
constexpr std::size_t kIntervalUs = 1000;
/// Longer than a message waits for its chunk.
constexpr auto kSettled = 1500ms;

std::uint64_t recorded(Child& receiver, const std::string& topic) {
  receiver.send("recorded " + topic);
  return std::stoull(receiver.receive());
}

void await_recorded_call(Running& running, Child& recorder) {
  const auto end = steady_clock::now() + kPatience;
  while (recorded(recorder, "skein/call_records") == 0) {
    if (steady_clock::now() > end) throw Internal("the calls are not recorded");
    running.call(64, 1);
    std::this_thread::sleep_for(50ms);
  }
}

void refuse_drops(Child& recorder) {
  recorder.send("dropped");
  const std::string dropped = recorder.receive();
  if (dropped != "0") throw Internal("the recording has dropped " + dropped + " messages");
}

/// How many more than `before` arrive, of `most`.
std::uint64_t arrivals(Child& receiver, const std::string& topic, std::uint64_t before,
                       std::uint64_t most) {
  std::uint64_t arrived = 0;
  auto end = steady_clock::now() + kSettled;
  while (arrived < most && steady_clock::now() < end) {
    const std::uint64_t now = recorded(receiver, topic) - before;
    if (now > arrived) end = steady_clock::now() + kSettled;
    arrived = now;
    std::this_thread::sleep_for(20ms);
  }
  return arrived;
}

const char* name_of(bool reliable) { return reliable ? "reliable" : "best_effort"; }

Trial full_speed(const TopicPlan::Size& size, bool reliable) {
  return {"a topic at full speed, time per value",
          {{"size_bytes", size.size_bytes}, {"reliable", reliable}},
          [=](Running& running) {
            const std::string topic = name_of(reliable);
            const std::uint64_t before = recorded(*running.server, topic);
            const auto took_us =
                running.times("publish " + topic + " " + std::to_string(size.size_bytes) + " " +
                              std::to_string(size.values_per_turn));
            const std::uint64_t arrived =
                arrivals(*running.server, topic, before, size.values_per_turn);
            if (arrived == 0) throw Internal("nothing of the topic has arrived");
            return std::vector{took_us.front() / static_cast<double>(arrived)};
          }};
}

}  // namespace

std::vector<Comparison> compare_recorded_calls(Configurations& configurations,
                                               const CallPlan& plan) {
  std::vector<Trial> trials = closed_loops("a call that is recorded", plan.sizes);
  trials.push_back({"a call that is recorded",
                    {{"size_bytes", 64}, {"calls_per_second", 1'000'000 / kIntervalUs}},
                    [&](Running& running) {
                      return running.times("paced 64 " +
                                           std::to_string(plan.sizes.front().calls_per_turn) + " " +
                                           std::to_string(kIntervalUs));
                    }});
  Contest contest("recorded calls", std::move(trials));
  std::list<Child> recorders;
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const char* vendor : kVendors) {
    Configuration alone = configurations.skein(vendor, vendor);
    Configuration watched = configurations.skein(vendor, vendor);
    alone.name += ", not recorded";
    watched.name += ", recorded";
    pairs.emplace_back(watched.name, alone.name);
    contest.enter(alone);
    contest.enter(watched, [&](Running& running) {
      Child& recorder = recorders.emplace_back(Configurations::recorder_of(watched));
      recorder.receive();
      await_recorded_call(running, recorder);
    });
  }
  contest.run(plan.rounds);
  for (Child& recorder : recorders) refuse_drops(recorder);
  return contest.compare(pairs);
}

std::vector<Comparison> compare_recorded_topics(Configurations& configurations,
                                                const TopicPlan& plan) {
  std::vector<Trial> trials;
  for (const auto& size : plan.sizes) {
    for (const bool reliable : {true, false}) trials.push_back(full_speed(size, reliable));
  }
  Contest contest("recorded topics", std::move(trials));
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const char* vendor : kVendors) {
    const Configuration recorder = configurations.skein_topic(vendor, "recorder");
    const Configuration counter = configurations.skein_topic(vendor, "counter");
    pairs.emplace_back(recorder.name, counter.name);
    for (const Configuration& each : {recorder, counter}) {
      contest.enter(each, [](Running& running) {
        running.client.send("subscribed");
        running.client.receive();
      });
    }
  }
  contest.run(plan.rounds);
  return contest.compare(pairs);
}

}  // namespace skein::benchmarks
