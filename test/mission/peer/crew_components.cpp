// A worker that hangs when it is told to, one that does not, a desk in front of them, a strategy of
// selection, and missions: one that tells the first worker to hang and waits until it works again,
// one that asks the desk once, and two that end while others are in calls.

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "skein/call_context.hpp"
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/head.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"
#include "test/tools/eventually.hpp"
#include "worker.idl.hpp"

namespace {

using namespace skein;
using namespace std::chrono_literals;

class Worker final : public crew::Worker {
 public:
  Worker(std::string name, const ParameterValues& values) : name_(std::move(name)) {
    if (values.contains(kSeed)) seed_ = values.live<std::int64_t>(kSeed);
  }

  std::string work(const std::string& task) override {
    if (name_ == "moody" && task.starts_with("stop")) raise(SIGSTOP);
    while (name_ == "moody" && task == "hang") pause();
    while (task == "wait" && !CallContext::current()->cancelled()) std::this_thread::yield();
    return name_ + " did " + task;
  }

 private:
  static constexpr const char* kSeed = "Seed";

  const std::string name_;
  std::optional<LiveParameter<std::int64_t>> seed_;  // which it offers beside its service
};

class Desk final : public crew::Desk {
 public:
  explicit Desk(Head& head) : head_(head) {}
  std::string ask(const std::string& text) override {
    Task<crew::Worker, std::string> task;
    task.run = [&](crew::Worker::Proxy& worker, Duration) { return worker.work(text); };
    return head_.perform(task);
  }

 private:
  Head& head_;
};

/// The least declared quality.
class Humblest final : public SelectionStrategy {
 public:
  std::string name() const override { return "humblest"; }
  Selection select(const std::vector<Candidate>& candidates,
                   const Situation& situation) const override {
    const auto humblest = std::min_element(
        candidates.begin(), candidates.end(),
        [](const Candidate& one, const Candidate& other) { return one.quality < other.quality; });
    return {static_cast<std::size_t>(humblest - candidates.begin()), situation.remaining,
            "it claims the least"};
  }
};

void say(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

int upset_the_moody_one(Entity& entity, const ParameterValues&) {
  auto desk = entity.connect<crew::Desk>();
  const auto moody_works = [&] { return desk.within(5s).ask("it") == "moody did it"; };
  // Beyond its lease it is lost, not late.
  const std::pair<std::string, Duration> troubles[] = {
      {"hang", 1s}, {"stop", 1s}, {"stop beyond its lease", 60s}};
  for (const auto& [trouble, time] : troubles) {
    if (!test::eventually(moody_works)) return 1;
    say(desk.within(time).ask(trouble));
    if (!test::eventually(moody_works)) return 2;
    say("after " + trouble + " moody works again");
  }
  return 0;
}

int ask_once(Entity& entity, const ParameterValues&) {
  auto desk = entity.connect<crew::Desk>();
  say(desk.within(10s).ask("it"));
  return 0;
}

constexpr char kWaits[] = "waits";

/// Ends while `wait_at_desk` is in a call that has much more time.
int leave_early(Entity& entity, const ParameterValues&) {
  const auto waits = entity.subscription<introspection::Attempt>(kWaits);
  return test::eventually([&] { return waits.publishers() > 0; }) ? 0 : 1;
}

int wait_at_desk(Entity& entity, const ParameterValues&, const std::stop_token&) {
  auto desk = entity.connect<crew::Desk>().within(60s);
  const auto waits = entity.publisher<introspection::Attempt>(kWaits);
  try {
    desk.ask("wait");
  } catch (const Error& error) {
    say(std::string("the visitor goes: ") + error.what());
  }
  return 0;
}

/// Ends with a worker that hangs.
int leave_hanging(Entity& entity, const ParameterValues&) {
  say(entity.connect<crew::Desk>().within(1s).ask("hang"));
  return 0;
}

ComponentRegistry::CspFactory worker(const std::string& name) {
  return [name](const ParameterValues& values) {
    return std::make_shared<crew::Worker::Skeleton>(std::make_shared<Worker>(name, values));
  };
}

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_csp<crew::Worker>("moody", worker("moody"));
  registry.add_csp<crew::Worker>("sound", worker("sound"));
  registry.add_body<crew::Desk>("office", [](skein::Entity& entity, const skein::ParameterValues&) {
    return skein::ComponentRegistry::Body{
        std::make_shared<crew::Desk::Skeleton>(std::make_shared<Desk>(entity.head()))};
  });
  registry.add_mission("client", upset_the_moody_one);
  registry.add_mission("caller", ask_once);
  registry.add_mission("leaver", leave_early);
  registry.add_activity("visitor", wait_at_desk);
  registry.add_mission("hanger", leave_hanging);
  registry.add_strategy(std::make_shared<Humblest>());
}
