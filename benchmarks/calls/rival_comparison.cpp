#include <algorithm>
#include <chrono>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <utility>

#include "calls/benchmarks.hpp"
#include "calls/contest.hpp"
#include "harness/goals.hpp"

namespace skein::benchmarks {
namespace {

constexpr std::size_t kSmall = 64;

Trial crowd(std::size_t clients, std::size_t count) {
  return {"clients that call at once", {{"clients", clients}}, [=](Running& running) {
            running.times("crowd" + words({clients, kSmall, 2}));
            return running.times("crowd" + words({clients, kSmall, count}));
          }};
}

Trial pipelined(std::size_t count, std::size_t depth) {
  return {"time per call, many in flight", {{"calls_in_flight", depth}}, [=](Running& running) {
            running.times("pipelined" + words({kSmall, depth, depth}));
            return running.times("pipelined" + words({kSmall, count, depth}));
          }};
}

std::vector<Trial> trials_of(const RivalPlan& plan) {
  std::vector<Trial> trials = closed_loops("one call after the other", plan.sizes);
  trials.push_back(paced("at a fixed rate, from the intended send", plan.paced_calls, 500));
  for (const std::size_t clients : {1, 4, 32}) trials.push_back(crowd(clients, plan.crowd_calls));
  trials.push_back(pipelined(plan.pipelined_calls, 64));
  for (const std::size_t size : {std::size_t{64}, std::size_t{65'536}}) {
    trials.push_back(processor_time("processor time per call, both sides", size, plan.cpu_calls));
  }
  return trials;
}

/// Connections over which nothing goes, in as few processes as a provider lets have so many.
class Crowd {
 public:
  Crowd(std::vector<std::string> client, std::size_t count)
      : client_(std::move(client)), count_(count) {}

  void join(Child& server) {
    std::size_t left = count_;
    const double before = memory_of(server);
    double own = 0;
    std::size_t more = 0;
    while (left > 0) {
      // A process may have no more than are left to others.
      const std::size_t share = std::min({left, kOfProcess, (kOfAll - (count_ - left)) / 2});
      Child& process = processes_.emplace_back(client_);
      process.receive();
      const double alone = memory_of(process);
      process.send("idle " + std::to_string(share - 1));
      process.receive(std::chrono::minutes(2));
      own += memory_of(process) - alone;
      more += share - 1;
      left -= share;
    }
    octets_each_ = (memory_of(server) - before) / static_cast<double>(count_) +
                   own / static_cast<double>(std::max<std::size_t>(more, 1));
  }
  std::size_t size() const { return count_; }
  /// Of both sides, for each connection.
  std::optional<double> octets_each() const { return octets_each_; }

 private:
  static constexpr std::size_t kOfProcess = 125;
  static constexpr std::size_t kOfAll = 1020;  // 1,024, but for who measures

  static double memory_of(Child& child) {
    child.send("memory");
    return std::stod(child.receive());
  }

  const std::vector<std::string> client_;
  const std::size_t count_;
  std::optional<double> octets_each_;
  std::list<Child> processes_;
};

}  // namespace

std::vector<Comparison> compare_rivals(Configurations& configurations, const RivalPlan& plan) {
  Contest contest("rivals", trials_of(plan));
  using Memory = Configurations::SharedMemory;
  const std::vector<Configuration> subjects{configurations.skein("fastdds", "fastdds"),
                                            configurations.skein("cyclonedds", "cyclonedds"),
                                            configurations.skein_same_host(Memory::Sleeping)};
  const std::vector<Configuration> rivals{configurations.rival("omniorb", "unix"),
                                          configurations.rival("omniorb", "tcp"),
                                          configurations.rival("grpc", "unix"),
                                          configurations.rival("grpc", "tcp"),
                                          configurations.rival("zeromq", "ipc"),
                                          configurations.rival("zeromq", "tcp"),
                                          configurations.unix_socket(),
                                          configurations.shared_memory()};
  for (const auto* entering : {&subjects, &rivals}) {
    for (const Configuration& each : *entering) contest.enter(each);
  }
  contest.run(plan.rounds);
  std::vector<Comparison> comparisons;
  for (const Configuration& skein : subjects) {
    for (const Configuration& rival : rivals)
      append(comparisons, contest.compare(skein.name, rival.name));
  }
  return comparisons;
}

std::vector<Comparison> compare_in_process(Configurations& configurations, const RivalPlan& plan) {
  const std::size_t calls = plan.in_process_calls;
  Contest contest(
      "in one process",
      closed_loops("a call in the same process", {{16, calls}, {64, calls}, {1024, calls}}),
      {Placement::OneCore});
  const Configuration skein = configurations.skein_in_process();
  const Configuration collocated = configurations.omniorb_in_process("collocated");
  const Configuration shortcut = configurations.omniorb_in_process("shortcut");
  for (const Configuration& each : {skein, collocated, shortcut}) contest.enter(each);
  contest.run(plan.rounds);
  std::vector<Comparison> comparisons;
  append(comparisons, contest.compare(skein.name, Limit{"limit 1 us", kCallInProcessUs}));
  append(comparisons, contest.compare(skein.name, collocated.name));
  append(comparisons, contest.compare(skein.name, shortcut.name));
  return comparisons;
}

std::vector<Comparison> compare_idle_clients(Configurations& configurations,
                                             const IdleClientsPlan& plan) {
  Contest contest("idle clients", closed_loops("a call beside idle clients", plan.calls.sizes));
  std::list<Crowd> crowds;
  std::vector<std::pair<std::string, std::string>> pairs;
  const auto enter = [&](const std::function<Configuration()>& make,
                         std::initializer_list<std::size_t> counts) {
    Configuration alone = make();
    alone.name += ", no idle clients";
    contest.enter(alone);
    for (const std::size_t count : counts) {
      Configuration crowded = make();
      crowded.name += ", " + std::to_string(count) + " idle clients";
      pairs.emplace_back(crowded.name, alone.name);
      contest.enter(crowded, [&, count, client = crowded.client](Running& running) {
        crowds.emplace_back(client, count).join(*running.server);
      });
    }
  };
  for (const char* vendor : kVendors) {
    enter([&] { return configurations.skein(vendor, vendor); }, {32});
  }
  using Memory = Configurations::SharedMemory;
  enter([&] { return configurations.skein_same_host(Memory::Sleeping); }, {32, plan.many});
  contest.run(plan.calls.rounds);
  std::vector<Comparison> comparisons = contest.compare(pairs);
  Comparison& memory = comparisons.emplace_back(
      Comparison{kIdleMemory, "skein shared memory", "limit 64 KiB", {{"connections", plan.many}}});
  memory.unit = "octets";
  const auto many = std::ranges::find(crowds, plan.many, &Crowd::size);
  if (many != crowds.end() && many->octets_each()) {
    fill(memory, Outcome{{*many->octets_each()}}, Outcome{{kIdleOctets}});
  } else {
    fill(memory, Outcome{{}, {"so many clients did not come", true}}, Outcome{{kIdleOctets}});
  }
  return comparisons;
}

}  // namespace skein::benchmarks
