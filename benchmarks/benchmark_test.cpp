#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/comparison.hpp"
#include "harness/goals.hpp"
#include "skein/selection.hpp"
#include "test/tools/places.hpp"
#include "test/tools/shell.hpp"

using Catch::Contains;
using nlohmann::json;
using skein::benchmarks::Comparison;
using skein::test::built_file;
using skein::test::built_program;
using skein::test::shell;
using skein::test::ShellResult;

namespace {

/// What one quick run of the benchmark wrote.
struct QuickRun {
  std::filesystem::path folder;
  int exit_code = 0;
  json results;

  explicit QuickRun(const std::string& name,
                    const std::filesystem::path& program = built_program("skein_bench"),
                    const std::string& options = "")
      : folder(std::filesystem::current_path() / name) {
    std::filesystem::remove_all(folder);
    exit_code = std::system(
        (program.string() + " --quick --output '" + folder.string() + "'" + options).c_str());
    std::ifstream file(folder / "results.json");
    results = json::parse(file, nullptr, false);
  }

  static const QuickRun& get() {
    static const QuickRun run("quick_bench");
    return run;
  }
};

/// A folder with the benchmark and its peers, of which the raw ones of Fast DDS are `script`
/// instead.
class Workshop {
 public:
  explicit Workshop(const std::string& script) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    const std::filesystem::path programs = built_file("bin");
    std::filesystem::copy_file(built_program("skein_bench"),
                               program());  // looks for its peers beside itself
    for (const char* name : {"skein_bench_raw_unix", "skein_bench_raw_cyclonedds"}) {
      if (std::filesystem::exists(programs / name))
        std::filesystem::create_symlink(programs / name, folder_ / name);
    }
    const auto broken = folder_ / "skein_bench_raw_fastdds";
    std::ofstream(broken) << "#!/bin/sh\n" << script << '\n';
    std::filesystem::permissions(broken, std::filesystem::perms::owner_all);
  }
  std::filesystem::path program() const { return folder_ / "skein_bench"; }

 private:
  // Beside the folder of programs: they look for their libraries from where they stand.
  const std::filesystem::path folder_ = built_file("broken_workshop");
};

bool is_about_raw_fastdds(const json& row) {
  for (const char* side : {"subject", "rival"}) {
    const auto name = row.at(side).get<std::string>();
    const bool raw = name.starts_with("raw ") || name.starts_with("fastdds by ");
    if (raw && name.find("fastdds") != std::string::npos) return true;
  }
  return false;
}

const std::set<std::string> kPairs{"fastdds", "cyclonedds", "fastdds-cyclonedds",
                                   "cyclonedds-fastdds"};

ShellResult command_result(const std::string& arguments) {
  return shell(built_program("skein") + " " + arguments);
}

bool has(const json& results, const std::string& claim, const std::string& subject,
         const json& parameters, const std::string& rival = "") {
  for (const json& row : results) {
    bool same = row.at("claim") == claim && row.at("subject") == subject;
    same = same && (rival.empty() || row.at("rival") == rival);
    for (const auto& [name, value] : parameters.items()) {
      same = same && row.at("parameters").contains(name) && row.at("parameters").at(name) == value;
    }
    if (same) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("a percentile is the smallest sample that so many do not exceed") {
  std::vector<double> samples;
  for (int i = 1000; i >= 1; --i) samples.push_back(i);
  const auto summary = skein::benchmarks::summarize(samples);
  CHECK(summary.p50 == 500);
  CHECK(summary.p90 == 900);
  CHECK(summary.p99 == 990);
  CHECK(summary.p999 == 999);
  CHECK(skein::benchmarks::summarize({7}).p999 == 7);
  CHECK(skein::benchmarks::summarize({}).samples == 0);
}

TEST_CASE("a comparison that was not measured has no figures, only the reason") {
  Comparison comparison{"claim", "subject", "rival"};
  comparison.absence = {"not here"};
  const json row = skein::benchmarks::to_json(comparison);
  CHECK(row.at("skipped") == "not here");
  CHECK(row.at("samples") == 0);
  CHECK(row.at("p50_us").is_null());
  CHECK(row.at("ratio_p50").is_null());
}

TEST_CASE("where both took turns, a ratio is the median of the rounds' ratios") {
  skein::benchmarks::Comparison comparison{"claim", "own", "other"};
  comparison.samples = {2, 2, 200, 200, 6, 6};
  comparison.rival_samples = {1, 1, 10, 10, 3, 3};
  CHECK(comparison.ratio_p50() == 6.0 / 3.0);
  comparison.rounds = 3;
  CHECK(comparison.ratio_p50() == 2.0);
  CHECK(comparison.ratio_p99() == 20.0);  // too few for a p99 of each turn
}

TEST_CASE("a failure is never taken for a thing that is missing here") {
  using namespace skein::benchmarks;
  const Outcome measured{{1}}, skipped{{}, {"not here"}}, failed{{}, {"died", true}};
  const auto row_of = [](const Outcome& own, const Outcome& rival) {
    Comparison comparison{"claim", "subject", "rival"};
    fill(comparison, own, rival);
    return to_json(comparison);
  };
  for (const json& row :
       {row_of(skipped, failed), row_of(failed, skipped), row_of(measured, failed)}) {
    CHECK(row.at("failed") == "died");
    CHECK_FALSE(row.contains("skipped"));
    CHECK(row.at("samples") == 0);
  }
  CHECK(row_of(skipped, measured).at("skipped") == "not here");
}

TEST_CASE("a ratio is the subject's time by the rival's") {
  Comparison comparison{"claim", "subject", "rival"};
  comparison.samples = {30, 10, 20};
  comparison.rival_samples = {10};
  CHECK(skein::benchmarks::to_json(comparison).at("ratio_p50") == 2.0);
}

TEST_CASE("a goal is missed where one comparison misses it, and unknown where none was measured") {
  using namespace skein::benchmarks;
  const auto start = [](double took, const char* skipped) {
    Comparison comparison{"process start to first reply", "skein fastdds", "raw fastdds"};
    comparison.samples = {took};
    comparison.rival_samples = {100};
    comparison.absence = {skipped};
    return comparison;
  };
  const auto verdict_of = [](const std::vector<Comparison>& comparisons) {
    for (const Verdict& verdict : judge(comparisons)) {
      if (verdict.goal->covers(comparisons.front())) return verdict;
    }
    throw std::logic_error("no goal covers it");
  };
  std::vector<Comparison> measured{start(119, ""), start(121, ""), start(500, "not here")};
  set_goals(measured);
  const Verdict verdict = verdict_of(measured);
  CHECK(verdict.measured == 2);
  CHECK(verdict.met == 1);
  CHECK(verdict.worst == &measured[1]);
  std::vector<Comparison> skipped{start(1, "not here")};
  set_goals(skipped);
  CHECK(verdict_of(skipped).worst == nullptr);
  std::vector<Comparison> failed{start(119, ""), start(1, "died")};
  failed.back().absence.failed = true;
  set_goals(failed);
  CHECK(verdict_of(failed).failed == 1);
  CHECK(verdict_of(failed).met == 1);
  CHECK_FALSE(is_met(verdict_of(failed)));
}

TEST_CASE("a raw mixed pair has no goal: it is there for information") {
  using namespace skein::benchmarks;
  std::vector<Comparison> comparisons{
      {"a call over DDS", "skein fastdds-cyclonedds", "raw fastdds"},
      {"a call over DDS", "skein fastdds-cyclonedds", "raw fastdds-cyclonedds"}};
  set_goals(comparisons);
  CHECK(comparisons[0].goal_p99 == 1.15);
  CHECK_FALSE(comparisons[1].goal_p50);
}

TEST_CASE("a quick run writes every row of results.json in the common shape", "[long]") {
  const QuickRun& run = QuickRun::get();
  REQUIRE(run.exit_code == 0);
  REQUIRE(run.results.is_array());
  for (const json& row : run.results) {
    CAPTURE(row.dump());
    for (const char* name : {"claim", "subject", "rival"})
      CHECK_FALSE(row.at(name).get<std::string>().empty());
    CHECK(row.at("parameters").is_object());
    const bool skipped = row.contains("skipped");
    CHECK((row.at("samples") > 0) != skipped);
    for (const char* name : {"p50", "p90", "p99", "p999", "rival_p50", "rival_p99"}) {
      CHECK(row.at(name + ("_" + row.at("unit").get<std::string>())).is_number() != skipped);
    }
    for (const char* name : {"ratio_p50", "ratio_p99"}) CHECK(row.at(name).is_number() != skipped);
    if (skipped)
      WARN(row.at("claim") << ", " << row.at("subject") << " skipped: " << row.at("skipped"));
  }
}

TEST_CASE("a contender that dies costs its own rows and nobody else's, and the exit code tells") {
  struct Death {
    const char* script;
    const char* parts;
    std::set<std::string> claims;
  };
  const auto death = GENERATE(
      Death{"exit 1",
            "calls ways cold_starts joins idle_peers",
            {"a call over DDS", "processor time of a call over DDS", "other ways of the vendors",
             "process start to first reply", "peers that start at once until all see all",
             "octets that an idle peer sends, per second",
             "packets that an idle peer sends, per second",
             "processor time of an idle peer, per second"}},
      Death{"echo ready 1; read command",
            "calls",
            {"a call over DDS", "processor time of a call over DDS"}});
  CAPTURE(death.script);
  const Workshop workshop(death.script);
  const QuickRun run("broken_bench", workshop.program(), std::string(" --only ") + death.parts);
  CHECK(WEXITSTATUS(run.exit_code) == 1);
  std::set<std::string> failed, measured;
  for (const json& row : run.results) {
    CAPTURE(row.dump());
    const auto claim = row.at("claim").get<std::string>();
    if (is_about_raw_fastdds(row)) {
      CHECK(row.at("failed").get<std::string>().find("skein_bench_raw_") != std::string::npos);
      failed.insert(claim);
    } else {
      CHECK_FALSE(row.contains("failed"));
      if (row.at("samples") > 0) measured.insert(claim);
    }
  }
  CHECK(failed == death.claims);
  CHECK(measured == death.claims);
}

TEST_CASE("no pair of vendors, size, way to die or other fault is missing", "[long]") {
  const json& results = QuickRun::get().results;
  for (const std::string& pair : kPairs) {
    CAPTURE(pair);
    for (const int size : {16, 64, 1024, 65'536, 1'048'576}) {
      for (const char* placement : {"both on one core", "one core each"}) {
        const json parameters{{"size_bytes", size}, {"placement", placement}};
        CHECK(has(results, "a call over DDS", "skein " + pair, parameters));
        CHECK(has(results, "processor time of a call over DDS", "skein " + pair, parameters));
        CHECK(has(results, "a call over DDS", "skein " + pair, parameters, "unix socket"));
      }
    }
    CHECK(has(results, "process start to first reply", "skein " + pair, json::object()));
    for (const char* where : {"one host", "across two hosts"}) {
      CHECK(has(results, "provider killed to caller told", "skein " + pair, {{"where", where}}));
    }
    const std::string stopped = "provider stopped beyond its lease";
    CHECK(has(results, "deadline to its call's end", "skein " + pair, {{"where", stopped}}));
    for (const std::string& fault :
         {stopped, std::string("provider killed, from its new process's start"),
          std::string("network cut")}) {
      CHECK(has(results, "a fault's end to an answer", "skein " + pair, {{"where", fault}}));
      CHECK(has(results, "a fault's end to a complete registry", "skein " + pair,
                {{"where", fault}}));
    }
  }
}

TEST_CASE("no other way of the vendors is missing", "[long]") {
  const json& results = QuickRun::get().results;
  for (const char* way : {"shared memory", "data sharing", "listener", "polling"}) {
    CHECK(has(results, "other ways of the vendors", "skein fastdds", json::object(),
              std::string("fastdds by ") + way));
  }
  CHECK(has(results, "other ways of the vendors", "skein cyclonedds", json::object(),
            "cyclonedds by polling"));
}

TEST_CASE("no vendor is missing where peers start at once and where they are idle", "[long]") {
  const json& results = QuickRun::get().results;
  for (const std::string vendor : {"fastdds", "cyclonedds"}) {
    CAPTURE(vendor);
    for (const char* claim : {"peers that start at once until all see all",
                              "octets that an idle peer sends, per second",
                              "packets that an idle peer sends, per second",
                              "processor time of an idle peer, per second"}) {
      CHECK(has(results, claim, "skein " + vendor, {{"peers", 4}}, "raw " + vendor));
    }
    CHECK(has(results, "octets that an idle peer sends, per second", "skein " + vendor,
              {{"peers", 4}}, "participants of " + vendor));
  }
}

TEST_CASE("no rival and no way to call is missing", "[long]") {
  const json& results = QuickRun::get().results;
  for (const char* vendor : {"skein fastdds", "skein cyclonedds"}) {
    for (const char* rival :
         {"omniorb unix", "omniorb tcp", "grpc unix", "grpc tcp", "zeromq ipc", "zeromq tcp"}) {
      CAPTURE(vendor, rival);
      for (const int size : {16, 64, 1024, 65'536, 1'048'576}) {
        CHECK(has(results, "one call after the other", vendor, {{"size_bytes", size}}, rival));
      }
      for (const int clients : {1, 4, 32}) {
        CHECK(has(results, "clients that call at once", vendor, {{"clients", clients}}, rival));
      }
      CHECK(has(results, "at a fixed rate, from the intended send", vendor,
                {{"calls_per_second", 2000}}, rival));
      CHECK(
          has(results, "time per call, many in flight", vendor, {{"calls_in_flight", 64}}, rival));
      CHECK(
          has(results, "processor time per call, both sides", vendor, {{"size_bytes", 64}}, rival));
    }
  }
  CHECK(has(results, "a call in the same process", "skein in one process", json::object(),
            "omniorb collocated"));
  for (const int count : {10, 100, 1000, 10'000}) {
    CHECK(has(results, "find_service among many descriptions", "skein", {{"descriptions", count}}));
    CHECK(has(results, "find_service by constraints among many providers of one interface", "skein",
              {{"descriptions", count}}));
  }
}

TEST_CASE("no kind of decision is missing", "[long]") {
  const json& results = QuickRun::get().results;
  CHECK(has(results, "Head and dispatch around a CSP in the process", "skein",
            {{"where", "1 CSPs, declared"}}, "limit 2 us"));
  CHECK(has(results, "Head and dispatch with a decision by what was learned", "skein",
            {{"where", "4 CSPs, learned"}}, "limit 20 us"));
}

TEST_CASE("no kind of grid is missing, and those of the test data are skipped without it",
          "[long]") {
  const json& results = QuickRun::get().results;
  const std::string mean = "a path on a grid, mean over a map";
  CHECK(has(results, mean, "skein jps", {{"where", "made caves"}}, "plain A*"));
  CHECK(has(results, mean, "skein landmarks", {{"where", "made scatter, a third blocked"}},
            "plain A*"));
  CHECK(has(results, mean, "skein canonical-astar", json::object(), "plain A*"));
}

TEST_CASE("each strategy is scored, and decisions.csv has a row for each request", "[long]") {
  const QuickRun& run = QuickRun::get();
  const std::string loss = "PAR10 beyond the virtual best, mean over requests";
  std::size_t requests = 0;
  for (const std::string& name : skein::StrategyFactory().names()) {
    const std::string strategy = "skein " + name;
    CHECK(has(run.results, loss, strategy, {{"where", "held-out"}}, "single best"));
    CHECK(has(run.results, "results that the Head accepts", strategy, json::object()));
    CHECK(has(run.results, "deadline to the answer, an algorithm hangs", strategy, json::object()));
  }
  for (const json& row : run.results) {
    if (row.at("claim") == loss && row.at("subject") == "skein learned")
      requests += row.at("parameters").at("requests").get<std::size_t>();
  }
  std::ifstream table(run.folder / "decisions.csv");
  std::size_t lines = 0;
  for (std::string line; std::getline(table, line);) ++lines;
  CHECK(lines == requests + 1);
  CHECK(requests > 20);
}

TEST_CASE("each strategy is scored on recorded problems, which are skipped without the test data",
          "[long]") {
  const json& results = QuickRun::get().results;
  const std::string claim = "recorded problems: PAR10 beyond the virtual best";
  if (std::getenv("SKEIN_TEST_DATA") == nullptr) {
    CHECK(has(results, claim, "skein learned", json::object(), "single best"));
    return;
  }
  for (const std::string& name : skein::StrategyFactory().names()) {
    const std::string strategy = "skein " + name;
    for (const char* mode : {"learned from the other folds", "online, from nothing"}) {
      CHECK(has(results, claim, strategy, {{"mode", mode}}, "single best"));
      CHECK(has(results, "recorded problems: share of the gap left open", strategy,
                {{"mode", mode}}));
    }
  }
  CHECK(has(results, claim, "skein learned", json::object(), "random forests"));
}

TEST_CASE("a user measures calls by the command, and compares what it saved") {
  const auto folder = std::filesystem::current_path() / "command_bench";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::string command = built_program("skein") + " bench ";
  const auto file = [&](const std::string& name) {
    return " '" + (folder / (name + ".json")).string() + "'";
  };
  for (const std::string what :
       {"latency --payload 64 1024 --count 20", "throughput --payload 64 --count 200"}) {
    for (const std::string vendor : {"fastdds", "cyclonedds"}) {
      CAPTURE(what, vendor);
      REQUIRE(std::system(
                  (command + what + " --vendor " + vendor + " --output" + file(vendor)).c_str()) ==
              0);
      std::ifstream saved(folder / (vendor + ".json"));
      for (const json& row : json::parse(saved)) CHECK(row.at("p50_us") > 0);
    }
    CHECK(std::system((command + "compare" + file("fastdds") + file("cyclonedds")).c_str()) == 0);
  }
  for (const std::string transport : {"dds", "shared-memory"}) {
    const std::string latency = command + "latency --payload 64 --count 20 --transport ";
    REQUIRE(std::system((latency + transport + " --output" + file(transport)).c_str()) == 0);
    std::ifstream saved(folder / (transport + ".json"));
    for (const json& row : json::parse(saved))
      CHECK(row.at("transport") == (transport == "dds" ? "DDS" : "shared memory"));
  }
  const ShellResult compared =
      command_result("bench compare" + file("dds") + file("shared-memory"));
  CHECK_THAT(compared.output, Contains(", shared memory "));
  std::ofstream(folder / "broken.json") << "{}";
  CHECK(std::system((command + "compare" + file("fastdds") + file("broken")).c_str()) != 0);
}

TEST_CASE("calls are measured as a mission's peers would make them") {
  const auto folder = std::filesystem::current_path() / "profile_bench";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "dictionary.xml") << "<dictionary/>";
  std::ofstream(folder / "mirror.xml") << "<component name='Mirror'/>";
  std::ofstream(folder / "mission.xml") << R"(<mission name="survey" vendor="cyclonedds">
      <peer name="navigator" component="mirror.xml" threads="2" nice="1" spin="50us"/>
      <peer name="camera" component="mirror.xml" vendor="fastdds" shared_memory="true"/>
      <peer name="alone" component="mirror.xml" vendor="loopback"/>
    </mission>)";
  const auto run = [&](const std::string& options) {
    return command_result("bench latency --payload 64 --count 20 --profile '" +
                          (folder / "mission.xml").string() + "' " + options);
  };
  const auto measured = [&](const std::string& options) {
    const auto file = folder / "result.json";
    const ShellResult result = run(options + " --output '" + file.string() + "'");
    INFO(result.output);
    REQUIRE(result.exit_code == 0);
    std::ifstream saved(file);
    const json row = json::parse(saved).at(0);
    CHECK(row.at("p50_us") > 0);
    return row.at("vendor").get<std::string>();
  };
  CHECK(measured("") == "cyclonedds");
  CHECK(measured("--provider camera") == "fastdds");
  CHECK(measured("--provider camera --caller navigator") == "fastdds-cyclonedds");

  const auto complaint = [&](const std::string& options) {
    const ShellResult result = run(options);
    CHECK(result.exit_code != 0);
    return result.output;
  };
  CHECK_THAT(complaint("--provider navigatr"),
             Contains("has no peer 'navigatr'") && Contains("navigator"));
  CHECK_THAT(complaint("--caller alone"), Contains("mission.xml") && Contains("loopback"));
  CHECK_THAT(complaint("--vendor fastdds"), Contains("excludes"));
  CHECK_THAT(complaint("--peer 10.77.0.2"), Contains("10.77.0.2") && Contains("interface"));
  std::ofstream(folder / "mission.xml") << "<mission name='m' vendr='fastdds'/>";
  CHECK_THAT(complaint(""), Contains("mission.xml:1") && Contains("did you mean 'vendor'?"));
}

TEST_CASE("the report is one page that refers to nothing outside", "[long]") {
  std::ifstream file(QuickRun::get().folder / "report.html");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::string picture = "src='data:image/svg+xml;base64,";
  CHECK(page.find(picture) != std::string::npos);
  CHECK(page.find("Where Skein loses") != std::string::npos);
  for (const auto& goal : skein::benchmarks::goals())
    CHECK(page.find(goal.text.substr(0, 20)) != std::string::npos);
  for (const char* reference : {"http://", "https://", "<link", "@import", "url("}) {
    CHECK(page.find(reference) == std::string::npos);
  }
  for (auto at = page.find("src="); at != std::string::npos; at = page.find("src=", at + 1))
    CHECK(page.compare(at, picture.size(), picture) == 0);
}
