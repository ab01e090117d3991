#include <list>

#include "calls/benchmarks.hpp"
#include "calls/contest.hpp"
#include "harness/goals.hpp"

namespace skein::benchmarks {
namespace {

constexpr std::size_t kSmall = 64;

Trial crowd(std::size_t clients, std::size_t count) {
  return {"clients that call at once", {{"clients", clients}}, [=](Running& running) {
            running.times("crowd" + words({clients, kSmall, 2}));
            return running.times("crowd" + words({clients, kSmall, count / clients + 1}));
          }};
}

Trial pipelined(std::size_t count, std::size_t depth) {
  return {"time per call, many in flight", {{"calls_in_flight", depth}}, [=](Running& running) {
            running.times("pipelined" + words({kSmall, depth, depth}));
            return running.times("pipelined" + words({kSmall, count, depth}));
          }};
}

Trial cpu(std::size_t size, std::size_t count) {
  return {"processor time per call, both sides", {{"size_bytes", size}}, [=](Running& running) {
            running.call(size, count / 10 + 1);
            const double before = running.cpu_us();
            running.call(size, count);
            return std::vector{(running.cpu_us() - before) / static_cast<double>(count)};
          }};
}

std::vector<Trial> trials_of(const RivalPlan& plan) {
  std::vector<Trial> trials;
  for (const auto& size : plan.sizes)
    trials.push_back(closed_loop("one call after the other", size.size_bytes, size.calls_per_turn));
  trials.push_back(paced("at a fixed rate, from the intended send", plan.paced_calls, 500));
  for (const std::size_t clients : {1, 4, 32}) trials.push_back(crowd(clients, plan.crowd_calls));
  trials.push_back(pipelined(plan.pipelined_calls, 64));
  for (const std::size_t size : {std::size_t{64}, std::size_t{65'536}}) {
    trials.push_back(cpu(size, plan.cpu_calls));
  }
  return trials;
}

}  // namespace

std::vector<Comparison> compare_rivals(Configurations& configurations, const RivalPlan& plan) {
  Contest contest("rivals", trials_of(plan), {Placement::OneCore, Placement::OneCoreEach});
  std::vector<std::string> rivals;
  const auto enter_rival = [&](const Configuration& rival) {
    rivals.push_back(rival.name);
    contest.enter(rival);
  };
  std::vector<std::string> subjects;
  const auto enter_subject = [&](const Configuration& skein) {
    subjects.push_back(skein.name);
    contest.enter(skein);
  };
  for (const char* vendor : kVendors) enter_subject(configurations.skein(vendor, vendor));
  using Memory = Configurations::SharedMemory;
  enter_subject(configurations.skein_same_host(Memory::OwnThread));
  enter_subject(configurations.skein_same_host(Memory::OnArrival));
  for (const char* transport : {"unix", "tcp"})
    enter_rival(configurations.rival("omniorb", transport));
  for (const char* transport : {"unix", "tcp"})
    enter_rival(configurations.rival("grpc", transport));
  for (const char* transport : {"ipc", "tcp"})
    enter_rival(configurations.rival("zeromq", transport));
  contest.enter(configurations.unix_socket());
  contest.enter(configurations.shared_memory());
  contest.run(plan.rounds);
  std::vector<Comparison> comparisons;
  for (const std::string& skein : subjects) {
    for (const std::string& rival : rivals) append(comparisons, contest.compare(skein, rival));
    for (const char* floor : {"unix socket", "spinning shared memory"}) {
      append(comparisons, contest.compare(skein, std::string(floor)));
    }
  }
  return comparisons;
}

std::vector<Comparison> compare_in_process(Configurations& configurations, const RivalPlan& plan) {
  std::vector<Trial> trials;
  for (const std::size_t size : {16, 64, 1024}) {
    trials.push_back(
        {"a call in the same process", {{"size_bytes", size}}, [&, size](Running& running) {
           running.call(size, plan.in_process_calls / 10 + 1);
           return running.call(size, plan.in_process_calls);
         }});
  }
  Contest contest("in one process", std::move(trials), {Placement::OneCore});
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

std::vector<Comparison> compare_idle_clients(Configurations& configurations, const CallPlan& plan) {
  std::vector<Trial> trials;
  for (const auto& size : plan.sizes) {
    trials.push_back(
        closed_loop("a call beside idle clients", size.size_bytes, size.calls_per_turn));
  }
  Contest contest("idle clients", std::move(trials), {Placement::OneCore, Placement::OneCoreEach});
  std::list<Child> crowds;
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const char* vendor : kVendors) {
    Configuration alone = configurations.skein(vendor, vendor);
    Configuration crowded = configurations.skein(vendor, vendor);
    alone.name += ", no idle clients";
    crowded.name += ", 32 idle clients";
    pairs.emplace_back(crowded.name, alone.name);
    contest.enter(alone);
    contest.enter(crowded, [&](Running&) {
      Child& crowd = crowds.emplace_back(crowded.client);
      crowd.receive();
      crowd.send("idle 31");
      crowd.receive();
    });
  }
  contest.run(plan.rounds);
  std::vector<Comparison> comparisons;
  for (const auto& [crowded, alone] : pairs) {
    append(comparisons, contest.compare(crowded, alone));
  }
  return comparisons;
}

}  // namespace skein::benchmarks
