// Measures Skein beside its rivals and writes results.json and report.html. Exit code 1: something
// failed; what did not fail is written all the same.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "calls/benchmarks.hpp"
#include "calls/skein_peer.hpp"
#include "data_files.hpp"
#include "decisions/compare_decisions.hpp"
#include "grids/compare_grids.hpp"
#include "harness/goals.hpp"
#include "harness/machine.hpp"
#include "harness/private_network.hpp"
#include "recording/compare_recording.hpp"
#include "selection/compare_selection.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

struct Plan {
  CallPlan calls;
  CallPlan ways;
  CallPlan same_host;
  LoanPlan loans;
  RivalPlan rivals;
  IdleClientsPlan idle_clients;
  CallPlan recorded_calls;
  TopicPlan recorded_topics;
  HeadPlan head;
  FindPlan find;
  std::size_t cold_starts;
  JoinPlan joins;
  IdlePlan idle_peers;
  std::size_t kills_on_one_host;
  std::size_t kills_across_hosts;
  FaultPlan faults;
  GridPlan grids;
  DecisionPlan decisions;
  SelectionPlan selection;
  std::filesystem::path output{};
};

Plan full_plan() {
  const std::vector<CallPlan::Size> sizes{
      {16, 200}, {64, 200}, {1024, 200}, {65'536, 100}, {1'048'576, 15}};
  const CallPlan ways{{{64, 200}, {65'536, 60}, {1'048'576, 15}}, 10};
  return {{sizes, 90},
          ways,
          {{{64, 1000}}, 30},
          {100, 30},
          {sizes, 15, 400, 80, 1000, 200, 3000},
          {{{{64, 300}}, 60}, 1000},
          {{{64, 300}, {1024, 300}, {65'536, 100}}, 40},
          {{{64, 5000}, {65'536, 500}, {1'048'576, 60}}, 10},
          {300, 60},
          {200, 20},
          20,
          {50, 3},
          {{10, 50, 100}, 3, std::chrono::milliseconds(1500)},
          15,
          5,
          {2, 5, 2, std::chrono::seconds(5)},
          {300, 1},
          {1},
          {SIZE_MAX}};
}

/// Shows that everything runs; its figures mean nothing.
Plan quick_plan() {
  const std::vector<CallPlan::Size> sizes{{16, 3}, {64, 3}, {1024, 3}, {65'536, 3}, {1'048'576, 2}};
  return {{sizes, 1},
          {sizes, 1},
          {{{64, 3}}, 1},
          {3, 1},
          {sizes, 1, 5, 2, 64, 5, 10},
          {{{{64, 3}}, 1}, 33},
          {{{64, 3}}, 1},
          {{{64, 20}}, 1},
          {20, 2},
          {3, 1},
          1,
          {4, 1},
          {{4}, 1, std::chrono::milliseconds(1000)},
          1,
          1,
          {1, 2, 1, std::chrono::milliseconds(1500)},
          {3, 100},
          {35},
          {1}};
}

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw Internal(path + " cannot be written; is its folder there and writable?");
}

/// What README.md says of results.json and goals.md; run.json has what the report needs besides.
void write_results(const std::vector<Comparison>& comparisons, const nlohmann::json& run) {
  nlohmann::json results = nlohmann::json::array();
  for (const Comparison& comparison : comparisons) results.push_back(to_json(comparison));
  write("results.json", results.dump(2) + '\n');
  write("run.json", run.dump(2) + '\n');
  write("goals.md", goals_table(comparisons));
}

struct Part {
  const char* name;
  std::function<std::vector<Comparison>(Configurations&, const Plan&)> measure;
};

/// One that takes its own piece of the plan.
template <class Piece, class Parameter>
Part part(const char* name, std::vector<Comparison> (*compare)(Configurations&, Parameter),
          Piece Plan::*piece) {
  return {name, [=](Configurations& all, const Plan& plan) { return compare(all, plan.*piece); }};
}

const std::vector<Part> kParts{
    part("calls", compare_calls, &Plan::calls),
    part("ways", compare_ways, &Plan::ways),
    part("same_host", compare_same_host, &Plan::same_host),
    part("loans", compare_loans, &Plan::loans),
    part("rivals", compare_rivals, &Plan::rivals),
    part("in_process", compare_in_process, &Plan::rivals),
    part("head", compare_head, &Plan::head),
    part("idle_clients", compare_idle_clients, &Plan::idle_clients),
    part("recorded_calls", compare_recorded_calls, &Plan::recorded_calls),
    part("recorded_topics", compare_recorded_topics, &Plan::recorded_topics),
    part("find_service", compare_find_service, &Plan::find),
    part("cold_starts", compare_cold_starts, &Plan::cold_starts),
    part("joins", compare_joins, &Plan::joins),
    part("idle_peers", compare_idle_peers, &Plan::idle_peers),
    {"deaths",
     [](Configurations& all, const Plan& plan) {
       auto deaths = compare_deaths_on_one_host(all, plan.kills_on_one_host);
       append(deaths, compare_deaths_across_hosts(all, plan.kills_across_hosts));
       return deaths;
     }},
    {"faults",
     [](Configurations& all, const Plan& plan) {
       auto faults = compare_faults_on_one_host(all, plan.faults);
       append(faults, compare_faults_across_hosts(all, plan.faults));
       return faults;
     }},
    {"grids", [](Configurations&, const Plan& plan) { return compare_grids(plan.grids); }},
    {"decisions", [](Configurations&,
                     const Plan& plan) { return compare_decisions(plan.decisions, plan.output); }},
    {"selection",
     [](Configurations&, const Plan& plan) { return compare_selection(plan.selection); }},
};

std::vector<std::string> names_of_parts() {
  std::vector<std::string> names;
  for (const Part& part : kParts) names.push_back(part.name);
  return names;
}

/// The part's comparisons; or one that tells why there are none.
std::vector<Comparison> measure(const Part& part, Configurations& configurations,
                                const Plan& plan) {
  std::vector<Comparison> comparisons;
  const Absence absence =
      attempt(part.name, [&] { comparisons = part.measure(configurations, plan); });
  if (!absence) return comparisons;
  Comparison missing{part.name, "skein", "all its rivals"};
  missing.absence = absence;
  return {missing};
}

/// Whether everything was measured that could be.
bool run(const std::string& output, bool quick, const std::vector<std::string>& wanted) {
  const MachineFacts machine = machine_facts();
  const nlohmann::json remarks{quick ? "A quick run: its figures mean nothing." : "",
                               enter_private_network()};
  std::filesystem::create_directories(output);
  Plan plan = quick ? quick_plan() : full_plan();
  plan.output = output;
  Configurations configurations(std::filesystem::read_symlink("/proc/self/exe").parent_path());
  std::vector<Comparison> comparisons;
  for (const Part& part : kParts) {
    if (std::ranges::find(wanted, part.name) == wanted.end()) continue;
    append(comparisons, measure(part, configurations, plan));
  }
  set_goals(comparisons);
  std::filesystem::current_path(output);
  write_results(comparisons, {{"machine", machine}, {"remarks", remarks}});
  const bool reported = std::system(("'" + std::string(kReport) + "' .").c_str()) == 0;
  if (!reported)
    std::fprintf(stderr, "no report.html: see above; it needs the package python3-matplotlib\n");
  std::printf("\n%s\n", goals_table(comparisons).c_str());
  std::printf("%s/report.html, %s/results.json, %s/goals.md\n", output.c_str(), output.c_str(),
              output.c_str());
  return reported &&
         std::ranges::none_of(comparisons, [](const auto& each) { return each.absence.failed; });
}

}  // namespace
}  // namespace skein::benchmarks

int main(int argc, char** argv) {
  using namespace skein::benchmarks;
  CLI::App app("Skein beside its rivals, in one interleaved run");
  std::string output = "bench";
  bool quick = false;
  const std::vector<std::string> known = names_of_parts();
  std::vector<std::string> parts = known;
  app.add_option("--output", output, "Folder for results.json and report.html");
  app.add_flag("--quick", quick, "A smoke test of a few seconds");
  app.add_option("--only", parts, "Parts of the run")->check(CLI::IsMember(known));
  SkeinPeer peer;
  CLI::App* as_peer =
      app.add_subcommand("peer", "One process of a measured configuration")->group("");
  as_peer->add_option("--role", peer.role)->required();
  as_peer->add_option("--vendor", peer.vendor);
  as_peer->add_option("--domain", peer.domain);
  as_peer->add_option("--threads", peer.threads);
  as_peer->add_option("--interface", peer.interface);
  as_peer->add_option("--peer", peer.peer);
  as_peer->add_option("--peers", peer.peers);
  as_peer->add_flag("--shared-memory", peer.shared_memory);
  as_peer->add_option("--spin-us", peer.spin_us);
  as_peer->add_flag("--survives", peer.survives);
  CLI11_PARSE(app, argc, argv);
  try {
    if (*as_peer) return run_skein_peer(peer);
    std::signal(SIGPIPE, SIG_IGN);  // a peer that has died does not read
    return run(output, quick, parts) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "skein_bench: %s\n", error.what());
    return 1;
  }
}
