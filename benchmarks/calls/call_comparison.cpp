#include "calls/benchmarks.hpp"
#include "calls/contest.hpp"

namespace skein::benchmarks {
namespace {

/// Each comparison with whichever rival is slower there: a mixed pair can be no better. Where one
/// of both is not known, neither is the slower one.
std::vector<Comparison> with_slower_rival(std::vector<Comparison> one,
                                          std::vector<Comparison> other) {
  for (std::size_t i = 0; i < one.size(); ++i) {
    const bool unknown = one[i].absence || other[i].absence;
    const bool use_other = unknown ? &graver(one[i].absence, other[i].absence) == &other[i].absence
                                   : other[i].rival_summary().p50 > one[i].rival_summary().p50;
    if (use_other) one[i] = std::move(other[i]);
  }
  return one;
}

std::vector<Comparison> comparisons_of(const Contest& contest, const std::string& server,
                                       const std::string& client) {
  const std::string pair = pair_name(server, client), subject = "skein " + pair;
  auto comparisons = with_slower_rival(contest.compare(subject, "raw " + server),
                                       contest.compare(subject, "raw " + client));
  if (server != client) append(comparisons, contest.compare(subject, "raw " + pair));
  append(comparisons, contest.compare(subject, std::string("unix socket")));
  append(comparisons, contest.compare("raw " + pair, std::string("unix socket")));
  return comparisons;
}

}  // namespace

std::vector<Comparison> compare_calls(Configurations& configurations, const CallPlan& plan) {
  std::vector<Trial> trials = closed_loops("a call over DDS", plan.sizes);
  for (const auto& [size, calls] : plan.sizes)
    trials.push_back(processor_time("processor time of a call over DDS", size, calls));
  Contest contest("calls", std::move(trials));
  for (const auto& [server, client] : vendor_pairs()) {
    contest.enter(configurations.skein(server, client));
    contest.enter(configurations.raw(server, client));
  }
  contest.enter(configurations.unix_socket());
  contest.run(plan.rounds);
  std::vector<Comparison> comparisons;
  for (const auto& [server, client] : vendor_pairs()) {
    append(comparisons, comparisons_of(contest, server, client));
  }
  return comparisons;
}

std::vector<Comparison> compare_ways(Configurations& configurations, const CallPlan& plan) {
  Contest contest("ways", closed_loops("other ways of the vendors", plan.sizes));
  std::vector<std::pair<std::string, std::string>> pairs;
  const auto enter = [&](const std::string& vendor, std::initializer_list<const char*> ways) {
    const Configuration skein = configurations.skein(vendor, vendor);
    contest.enter(skein);
    for (const char* way : ways) {
      const Configuration other = configurations.raw_by(vendor, way);
      contest.enter(other);
      pairs.emplace_back(skein.name, other.name);
    }
  };
  enter("fastdds", {"shared_memory", "data_sharing", "listener", "polling"});
  enter("cyclonedds", {"polling"});
  contest.run(plan.rounds);
  return contest.compare(pairs);
}

}  // namespace skein::benchmarks
