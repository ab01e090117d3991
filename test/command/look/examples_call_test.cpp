// `skein call` reaches every operation of every example: those that the running peers tell.
#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "test/tools/child_process.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/places.hpp"

using namespace skein;
using namespace skein::test;
using Catch::Contains;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

namespace {

/// An example whose peers wait to be called.
struct Example {
  std::string folder;
  std::string domain;
  std::function<std::shared_ptr<void>()> start;  ///< The peers live as long as the result.
  std::set<std::string> services;
};

/// Those that have no service in a process that waits to be called, and why.
const std::map<std::string, std::string> kExempt{
    {"02_selecting_algorithms", "both entities are one process, which ends after its own calls"},
    {"03_loopback_test", "it is a test without sockets"},
    {"04_telemetry", "its peers have topics alone"},
    {"05_voting_sensors", "both entities are one process, which ends after its own calls"},
    {"07_answering_later", "its entities are one process, which ends after its own calls"},
    {"page", "it is what the pages of examples share"},
};

struct Done {
  int code;
  std::string printed;
  std::string said;
};

Done done(const Words& words) {
  CommandRun run(words, {.output = "printed"});
  const int code = run.wait();
  std::ostringstream printed;
  printed << std::ifstream(run.folder() / "printed").rdbuf();
  return {code, printed.str(), run.output()};
}

// --- the peers, as the examples' README start them

std::shared_ptr<void> start_greeter() {
  auto provider = std::make_shared<ChildProcess>(
      "first_service_provider", ChildProcess::Options{.arguments = {"cyclonedds"}});
  return provider;
}

/// Without the peer whose end is the mission's.
std::shared_ptr<void> launch(const std::string& profile, const Words& peers) {
  Words words{"launch", profile};
  for (const std::string& peer : peers) words.insert(words.end(), {"--only", peer});
  auto mission = std::make_shared<CommandRun>(words);
  CAPTURE(mission->output());
  REQUIRE(mission->writes("processes are ready"));
  return {mission.get(), [mission](void*) {
            mission->signal(SIGINT);
            mission->wait();
          }};
}

std::vector<Example> examples() {
  return {{"01_first_service", "0", start_greeter, {"greeting/IGreeter"}},
          {"06_own_planner",
           "43",
           [] {
             return launch(project_file("examples/06_own_planner/mission.xml"),
                           {"navigator", "flight_controller"});
           },
           {"AE_flightControllerI/IFlightController", "AE_navigatorI/INavigator"}},
          {"route_planning",
           "42",
           [] {
             return launch(project_file("mission_profiles/route_planning/route_planning.xml"),
                           {"navigator", "flight_controller", "ad_manager"});
           },
           {"AE_adManagerI/IAdManager", "AE_flightControllerI/IFlightController",
            "AE_navigatorI/INavigator"}},
          {"reconnaissance",
           "43",
           [] {
             return launch(
                 project_file("mission_profiles/reconnaissance/reconnaissance.xml"),
                 {"flight_simulator", "flight_controller", "navigator", "mission_manager"});
           },
           {"recon/IFlightController", "recon/IFlightSimulator", "recon/IMissionManager",
            "recon/INavigator"}}};
}

// --- what runs

/// The services that others than their owner may call.
std::set<std::string> services_on(const std::string& domain) {
  const Done services = done({"services", "--domain", domain, "--json"});
  REQUIRE(services.code == 0);
  std::set<std::string> names;
  for (const Json& service : Json::parse(services.printed)) names.insert(service["service"]);
  return names;
}

std::vector<std::string> operations_of(const std::string& service, const std::string& domain) {
  const Done described = done({"describe", service, "--domain", domain, "--json"});
  CAPTURE(described.said);
  REQUIRE(described.code == 0);
  std::string scoped = service;
  scoped.replace(scoped.find('/'), 1, "::");
  const Json types = Json::parse(described.printed);
  std::vector<std::string> names;
  for (const Json& interface : types["interfaces"]) {
    if (interface["name"] != scoped) continue;
    for (const Json& operation : interface["operations"]) names.push_back(operation["name"]);
  }
  return names;
}

/// With the template that it tells; what it makes of that is its own.
void check(const std::string& service, const std::string& operation, const std::string& domain) {
  CAPTURE(service, operation);
  const Done example =
      done({"call", service, operation, "--example", "--json", "--domain", domain});
  REQUIRE(example.code == 0);
  const Done run = done({"call", service, operation, example.printed, "--domain", domain,
                         "--within", "20s", "--wait", "20", "--json"});
  CAPTURE(example.printed, run.printed, run.said);
  if (run.code == 1) {
    CHECK(run.printed.empty());
    CHECK_THAT(run.said, Contains("." + operation + " raised "));
    return;
  }
  REQUIRE(run.code == 0);
  CHECK(run.said.empty());
  CHECK(Json::accept(run.printed));
}

}  // namespace

TEST_CASE("every example is called here, or exempt") {
  std::set<std::string> known;
  for (const Example& example : examples()) known.insert(example.folder);
  for (const auto& [folder, why] : kExempt) known.insert(folder);
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(project_file("examples"))) {
    if (entry.is_directory()) there.insert(entry.path().filename());
  }
  CHECK(known == there);
}

TEST_CASE("the command calls every operation of every example") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  for (const Example& example : examples()) {
    DYNAMIC_SECTION(example.folder) {
      const auto peers = example.start();
      std::set<std::string> told;
      eventually([&] { return (told = services_on(example.domain)) == example.services; });
      REQUIRE(told == example.services);
      for (const std::string& service : told) {
        for (const std::string& operation : operations_of(service, example.domain))
          check(service, operation, example.domain);
      }
    }
  }
}

TEST_CASE("a managed interface of an example is its entity's alone") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const auto peers = launch(project_file("examples/06_own_planner/mission.xml"),
                            {"navigator", "flight_controller"});
  for (const char* operation : {"plan", "improve"}) {
    const Done run = done({"call", "IPlanner", operation, "{}", "--domain", "43", "--wait", "2"});
    CHECK(run.code == 69);
    CHECK_THAT(run.said, Contains("it is a managed interface of navigator (uav-1)"));
  }
}
