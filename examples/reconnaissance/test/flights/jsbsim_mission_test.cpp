// All thirteen fly a mission, and JSBSim flies the aircraft: to its verdict, also when JSBSim or
// its adapter is killed in flight. Without the program the point mass flies.
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>

#include "jsbsim_program.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/mission_run.hpp"
#include "test/tools/places.hpp"
#include "track_check.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

const std::filesystem::path kMission =
    project_file("mission_profiles/reconnaissance/reconnaissance.xml");

/// One element of interest, near the runway, and nobody else in the air.
std::vector<std::string> short_mission(const std::string& program) {
  std::vector<std::string> arguments;
  for (const std::string& variable :
       {std::string("flight_model=jsbsim"), "jsbsim=" + program,
        std::string("elements=shed 1 5 0.3 20 53.3089 27.3225"),
        std::string("objects=53.3089 27.3226 3 0 0"),
        std::string("intruders=7200 35 12000 60"),  // long after the landing
        std::string("failures=2 wrong 40 300"), std::string("planner_failures=999 killed")}) {
    arguments.push_back("--variable");
    arguments.push_back(variable);
  }
  return arguments;
}

nlohmann::json report_of(const MissionRun& run) {
  std::ostringstream text;
  text << std::ifstream(run.file("reconnaissance.json")).rdbuf();
  return nlohmann::json::parse(text.str());
}

void check_tracks(const MissionRun& run) {
  const TrackExtremes extremes = extremes_of(run.file("reconnaissance.csv"));
  CHECK(extremes.flown_s > 100);
  CHECK(extremes.least_clearance_m > 150);
  CHECK(extremes.greatest_bank_deg < 32);
}

/// A process of this network namespace, which is the test's alone.
struct Process {
  pid_t pid = 0;
  pid_t parent = 0;
  long processor_ticks = 0;  // that it has used
};

std::optional<Process> jsbsim_process() {
  struct stat own {};
  stat("/proc/self/ns/net", &own);
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    struct stat other {};
    if (stat((entry.path() / "ns/net").c_str(), &other) != 0 || other.st_ino != own.st_ino)
      continue;
    std::ifstream file(entry.path() / "stat");
    std::string text;
    std::getline(file, text);
    if (text.find("(JSBSim)") == std::string::npos) continue;
    std::istringstream words(text);
    std::string name, state, skipped;
    Process process;
    words >> process.pid >> name >> state >> process.parent;
    for (int i = 0; i < 9; ++i) words >> skipped;
    words >> process.processor_ticks;
    return process;
  }
  return std::nullopt;
}

/// A JSBSim that is not that one, once it has flown for a while since it was started.
std::optional<Process> flying(const std::atomic<bool>& over, pid_t but = 0) {
  constexpr long kWhile = 30;
  std::optional<Process> found;
  eventually(
      [&] {
        found = jsbsim_process();
        return over || (found && found->pid != but && found->processor_ticks > kWhile);
      },
      std::chrono::minutes(3));
  return over ? std::nullopt : found;
}

/// The seconds after which a flight went on, by what was told.
std::vector<double> pauses(const std::string& output) {
  const std::regex told(R"(flies on from the last state, ([0-9.]+) s later)");
  std::vector<double> seconds;
  for (std::sregex_iterator i(output.begin(), output.end(), told), end; i != end; ++i)
    seconds.push_back(std::stod((*i)[1]));
  return seconds;
}

}  // namespace

TEST_CASE("thirteen fly with JSBSim, collect an element, and land", "[jsbsim]") {
  const MissionRun run(kMission, short_mission(jsbsim_program()));
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("shed collected: 0."));
  CHECK_THAT(run.output(), !Contains("is lost") && !Contains("does not fly"));
  const auto report = report_of(run);
  CHECK(report["verdict"] == "passed");
  check_tracks(run);
}

TEST_CASE(
    "JSBSim and its adapter are killed in flight; each is back within two seconds, and the "
    "mission ends with a verdict",
    "[jsbsim]") {
  const std::string program = jsbsim_program();
  std::atomic<bool> over = false;
  bool killed_jsbsim = false, killed_adapter = false;
  std::thread killer([&] {
    const auto first = flying(over);
    if (!first) return;
    killed_jsbsim = kill(first->pid, SIGKILL) == 0;
    if (const auto second = flying(over, first->pid))
      killed_adapter = kill(second->parent, SIGKILL) == 0;
  });
  const MissionRun run(kMission, short_mission(program));
  over = true;
  killer.join();
  INFO(run.output());
  REQUIRE(killed_jsbsim);
  REQUIRE(killed_adapter);
  const std::vector<double> seconds = pauses(run.output());
  CHECK(seconds.size() == 2);
  for (const double each : seconds) CHECK(each < 2);
  CHECK_THAT(run.output(), Contains("another JSBSim flies on") &&
                               Contains("JSBSim flies on from the last state"));
  CHECK(run.exit_code() == 0);
  const auto report = report_of(run);
  CHECK(report["verdict"] == "passed");
  std::size_t told = 0;
  for (const auto& fault : report["faults"])
    told += fault["what"] == "JSBSim is lost, which flies the aircraft";
  CHECK(told == 2);
  check_tracks(run);
}

TEST_CASE("without the program that is said, and the point mass flies the same aircraft",
          "[.point_mass]") {
  const MissionRun run(kMission, short_mission("/nowhere/JSBSim"));
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("JSBSim does not fly: there is no program /nowhere/JSBSim"));
  CHECK(report_of(run)["verdict"] == "passed");
  check_tracks(run);
}

TEST_CASE("the whole mission passes with JSBSim, at five times real time or faster", "[.whole]") {
  const std::string program = jsbsim_program();
  const auto began = std::chrono::steady_clock::now();
  const MissionRun run(kMission,
                       {"--variable", "flight_model=jsbsim", "--variable", "jsbsim=" + program});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  const TrackExtremes extremes = extremes_of(run.file("reconnaissance.csv"));
  WARN(extremes.flown_s << " s of flight took " << took.count() << " s");
  CHECK(extremes.flown_s > 5 * took.count());
  check_tracks(run);
}
