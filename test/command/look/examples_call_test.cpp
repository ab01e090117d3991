// `skein call` reaches every operation of every example. The operations are those that the running
// peers tell: one without a case here fails the test.
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

/// A call, and what comes of it.
struct Call {
  std::string service;
  std::string operation;
  Json arguments;
  Json sample;         ///< The reply has its shape: types, and members by name.
  std::string raises;  ///< The exception, instead of a reply.
};

/// An example whose peers wait to be called.
struct Example {
  std::string folder;
  std::string domain;
  std::function<std::shared_ptr<void>()> start;  ///< The peers live as long as the result.
  std::vector<Call> calls;
};

/// Those that have no service in a process that waits to be called, and why.
const std::map<std::string, std::string> kExempt{
    {"02_selecting_algorithms", "both entities are one process, which ends after its own calls"},
    {"03_loopback_test", "it is a test without sockets"},
    {"08_calling_from_c", "it ends by itself"},
    {"09_in_python", "a test of its own runs it, where Skein for Python is built"},
    {"10_in_java", "likewise"},
    {"11_in_ada", "likewise"},
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

bool has_shape(const Json& value, const Json& sample) {
  if (sample.is_number()) return value.is_number();
  if (value.type() != sample.type()) return false;
  if (sample.is_array()) {
    return sample.empty() || std::ranges::all_of(value, [&](const Json& element) {
             return has_shape(element, sample[0]);
           });
  }
  if (!sample.is_object()) return true;
  return value.size() == sample.size() &&
         std::ranges::all_of(sample.items(), [&](const auto& member) {
           return value.contains(member.key()) && has_shape(value[member.key()], member.value());
         });
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

// --- the calls

const Json kFlightLimits{{"speed_m_s", 60},
                         {"maximum_climb_angle_deg", 12},
                         {"maximum_bank_angle_deg", 30},
                         {"maximum_altitude_m", 4000}};
const Json kGroundPoint{{"north_m", 0}, {"east_m", 0}};
const Json kRadar{{"name", "Echo"},
                  {"site", kGroundPoint},
                  {"mast_height_m", 20},
                  {"range_m", 5000},
                  {"strength", 1}};
const Json kMissiles{{"name", "Foxtrot"},
                     {"site", kGroundPoint},
                     {"mast_height_m", 10},
                     {"range_m", 5000},
                     {"kills_per_second", 0.01}};
const Json kPicture{{"terrain", "synthetic:7"},
                    {"epoch", 1},
                    {"radar_sites", {kRadar}},
                    {"missile_sites", {kMissiles}}};
const Json kRoute{{"waypoints", {{{"north_m", 0}, {"east_m", 0}, {"altitude_m", 0}}}},
                  {"length_m", 0},
                  {"lowest_height_above_ground_m", 0},
                  {"radar_exposure", 0},
                  {"expected_kills", 0},
                  {"threat_epoch", 0},
                  {"planner", "AStar"}};
const Json kStatus{
    {"planning", false}, {"request_id", ""}, {"planner", ""}, {"host", ""}, {"pid", 0}};
const Json kReport{{"request_id", "across"},
                   {"strategy", "declared"},
                   {"candidates",
                    {{{"planner", "AStar"},
                      {"available", true},
                      {"quarantined", false},
                      {"declared_ms", 300},
                      {"declared_quality", 0.9},
                      {"runs", 0},
                      {"median_ms", 0},
                      {"p95_ms", 0},
                      {"measured_quality", 0},
                      {"accepted", 0}}}},
                   {"attempts",
                    {{{"planner", "AStar"},
                      {"threat_epoch", 0},
                      {"reason", ""},
                      {"outcome", "accepted"},
                      {"check", ""},
                      {"text", ""},
                      {"took_ms", 0}}}},
                   {"failure", ""},
                   {"elapsed_ms", 0}};

Json zone(const std::string& name, const Json& outline, double margin_m) {
  return {{"name", name},
          {"outline", outline},
          {"margin_m", margin_m},
          {"floor_m", -1000},
          {"ceiling_m", 20000}};
}

/// Across the terrain, which is 111 km wide, with those zones.
Json request(const std::string& id, const Json& zones) {
  const Json problem{{"terrain", "synthetic:7"},
                     {"start", {{"north_m", 5000}, {"east_m", 5000}, {"altitude_m", 2500}}},
                     {"goal", {{"north_m", 38000}, {"east_m", 40000}, {"altitude_m", 2500}}},
                     {"no_fly_zones", zones},
                     {"radar_sites", Json::array()},
                     {"missile_sites", Json::array()},
                     {"threat_epoch", 0},
                     {"minimum_height_above_ground_m", 120},
                     {"limits", kFlightLimits},
                     {"exposure_weight", 1},
                     {"kill_weight_m", 0},
                     {"exposure_cap_m", 0},
                     {"time_limit_ms", 0}};
  const Json nobody{{"interface_name", ""}, {"provider", std::string(32, '0')}, {"instance", ""}};
  return {{"request",
           {{"request_id", id}, {"problem", problem}, {"planner", ""}, {"own_planner", nobody}}}};
}

Json corner(double north_m, double east_m) { return {{"north_m", north_m}, {"east_m", east_m}}; }

Json ring_around_goal() {
  const Json a = corner(33000, 35000), b = corner(43000, 35000), c = corner(43000, 45000),
             d = corner(33000, 45000);
  return Json::array(
      {zone("West", Json::array({a, b}), 1000), zone("North", Json::array({b, c}), 1000),
       zone("East", Json::array({c, d}), 1000), zone("South", Json::array({d, a}), 1000)});
}

std::vector<Call> calls_of_navigator() {
  const std::string navigator = "AE_navigatorI/INavigator";
  const Json on_goal = Json::array({zone("Home", Json::array({corner(38000, 40000)}), 2000)});
  return {
      {"AE_flightControllerI/IFlightController", "flight_limits", Json::object(), kFlightLimits,
       ""},
      {navigator, "status", Json::object(), kStatus, ""},
      {navigator, "request_route", request("across", Json::array()), kRoute, ""},
      {navigator, "request_route", request("home", on_goal), {}, "AE_navigator::InvalidProblem"},
      {navigator,
       "request_route",
       request("ring", ring_around_goal()),
       {},
       "AE_navigator::NoRoute"},
      {navigator, "report", "across", kReport, ""},
      {navigator, "report", "nobody", {}, "AE_navigatorI::UnknownRequest"}};
}

std::vector<Call> calls_of_route_planning() {
  const std::string manager = "AE_adManagerI/IAdManager";
  const std::string invalid = "AE_adManagerI::InvalidReport";
  const auto report = [](const std::string& what, const Json& of) -> Json {
    return {{"terrain", "synthetic:7"}, {what, of}};
  };
  std::vector<Call> calls = calls_of_navigator();
  calls.insert(calls.end(),
               {{manager, "threat_picture", "synthetic:7", kPicture, ""},
                {manager, "threat_picture", "nowhere", {}, invalid},
                {manager, "radar_found", report("radar", kRadar), kPicture, ""},
                {manager, "radar_silent", report("name", "Echo"), kPicture, ""},
                {manager, "radar_silent", report("name", "Echo"), {}, invalid},
                {manager, "missiles_found", report("missiles", kMissiles), kPicture, ""}});
  return calls;
}

/// Of the four peers that have services, without the others, for whom the mission's time waits.
std::vector<Call> calls_of_reconnaissance() {
  const std::string simulator = "recon/IFlightSimulator";
  const std::string controller = "recon/IFlightController";
  const std::string navigator = "recon/INavigator";
  const std::string manager = "recon/IMissionManager";
  const std::string refused = "recon::Refused";
  const Json nothing = Json::object();
  const Json status{
      {"run", 0},        {"tick", 0},        {"paused", false},      {"participants", 0},
      {"awaited", {""}}, {"speed_limit", 0}, {"ticks_per_second", 0}};
  const Json limits{{"speed_m_s", 45},
                    {"greatest_bank_rad", 0.5},
                    {"greatest_climb_rad", 0.1},
                    {"turn_radius_m", 400},
                    {"fuel_kg_s", 0.006}};
  const auto position = [](double latitude_deg, double longitude_deg) -> Json {
    return {{"latitude_deg", latitude_deg}, {"longitude_deg", longitude_deg}, {"height_m", 500}};
  };
  const Json from = position(53.3, 27.4), to = position(53.4, 27.5);
  const Json runway{{"threshold", from}, {"course_rad", 1}, {"length_m", 1500}};
  const Json route{
      {"number", 1}, {"planner", "nobody"}, {"points", {from, to}}, {"length_m", 13000}};
  const auto request = [&](const Json& through) -> Json {
    return {{"request",
             {{"tick", 0},
              {"from", from},
              {"course_rad", 0.5},
              {"through", through},
              {"limits", limits},
              {"least_survival", 0}}}};
  };
  const Json next{{"position", to}, {"straight", false}};
  const Json order{{"order", {{"runway", runway}}}, {"tick", 0}};
  return {{simulator, "status", nothing, status, ""},
          {simulator, "pause", nothing, nothing, ""},
          {simulator, "step", 50, nothing, ""},
          {simulator, "limit_speed", 1, nothing, ""},
          {simulator, "limit_speed", -1, {}, refused},
          {simulator, "resume", nothing, nothing, ""},
          {controller, "limits", nothing, limits, ""},
          {controller, "take_off", {{"from", runway}, {"tick", 0}}, nothing, ""},
          {controller, "follow", {{"route", route}, {"tick", 0}}, nothing, ""},
          {controller, "loiter", {{"about", to}, {"radius_m", 800}, {"tick", 0}}, nothing, ""},
          {controller, "land", {{"route", route}, {"to", runway}, {"tick", 0}}, nothing, ""},
          {navigator, "plan", request(Json::array({next})), route, ""},
          {navigator, "plan", request(Json::array()), {}, "recon::NoRoute"},
          {manager, "begin", order, nothing, ""},
          {manager, "begin", order, {}, refused}};
}

std::vector<Example> examples() {
  return {{"01_first_service",
           "0",
           start_greeter,
           {{"greeting/IGreeter", "greet", "world", "Hello, world!", ""}}},
          {"06_own_planner", "43",
           [] {
             return launch(project_file("examples/06_own_planner/mission.xml"),
                           {"navigator", "flight_controller"});
           },
           calls_of_navigator()},
          {"route_planning", "42",
           [] {
             return launch(project_file("mission_profiles/route_planning/route_planning.xml"),
                           {"navigator", "flight_controller", "ad_manager"});
           },
           calls_of_route_planning()},
          {"reconnaissance", "43",
           [] {
             return launch(
                 project_file("mission_profiles/reconnaissance/reconnaissance.xml"),
                 {"flight_simulator", "flight_controller", "navigator", "mission_manager"});
           },
           calls_of_reconnaissance()}};
}

// --- what runs

/// The services that others than their owner may call, and their operations.
std::set<std::string> operations_on(const std::string& domain) {
  const Done services = done({"services", "--domain", domain, "--json"});
  REQUIRE(services.code == 0);
  std::set<std::string> all;
  for (const Json& service : Json::parse(services.printed)) {
    const std::string name = service["service"];
    const Done described = done({"describe", name, "--domain", domain, "--json"});
    CAPTURE(name, described.said);
    REQUIRE(described.code == 0);
    std::string scoped = name;
    scoped.replace(scoped.find('/'), 1, "::");
    const Json types = Json::parse(described.printed);
    for (const Json& interface : types["interfaces"]) {
      if (interface["name"] != scoped) continue;
      for (const Json& operation : interface["operations"]) {
        all.insert(name + "." + operation["name"].get<std::string>());
      }
    }
  }
  return all;
}

std::set<std::string> operations_of(const std::vector<Call>& calls) {
  std::set<std::string> all;
  for (const Call& call : calls) all.insert(call.service + "." + call.operation);
  return all;
}

void check(const Call& call, const std::string& domain) {
  CAPTURE(call.service, call.operation, call.arguments);
  // A file, and what --example prints, end with a line's end.
  const Done run = done({"call", call.service, call.operation, call.arguments.dump() + "\n",
                         "--domain", domain, "--within", "20s", "--wait", "20", "--json"});
  CAPTURE(run.printed, run.said);
  if (!call.raises.empty()) {
    CHECK(run.code == 1);
    CHECK(run.printed.empty());
    CHECK_THAT(run.said, Contains(" raised " + call.raises + " {"));
    return;
  }
  REQUIRE(run.code == 0);
  CHECK(run.said.empty());
  CHECK(has_shape(Json::parse(run.printed), call.sample));
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
      const auto expected = operations_of(example.calls);
      std::set<std::string> told;
      eventually([&] { return (told = operations_on(example.domain)) == expected; });
      REQUIRE(told == expected);
      for (const Call& call : example.calls) check(call, example.domain);
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
