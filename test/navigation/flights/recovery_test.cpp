// What the launcher does when processes of a mission are killed, hang, and fail.
#include <signal.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <regex>
#include <sstream>

#include "ad_manager.idl.hpp"
#include "flight_controller.idl.hpp"
#include "navigation/routes/demo_problem.hpp"
#include "navigation/terrain/terrain_provider.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/mission_status.idl.hpp"
#include "test/command/mission/errand.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/places.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using Catch::Contains;
using std::chrono::steady_clock;

namespace {

const std::string kOffice = "<peer name='office' component='office.xml'/>";

/// What `skein status` says of a running mission; without processes where it says nothing.
launch::MissionStatus status_of(const std::string& profile) {
  CommandRun run({"status", "--json", profile});
  return run.wait() == 0 ? idl::from_json<launch::MissionStatus>(run.output())
                         : launch::MissionStatus{};
}

launch::ProcessStatus status_of(const std::string& profile, const std::string& process) {
  for (const auto& status : status_of(profile).processes) {
    if (status.name == process) return status;
  }
  return {};
}

bool becomes(const std::string& profile, const std::string& process, const std::string& state) {
  return eventually([&] { return status_of(profile, process).state == state; }, 3 * kPatience);
}

bool runs(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(file, text);
  const auto end = text.rfind(") ");
  return end != std::string::npos && text[end + 2] != 'Z';  // its parent may not wait for it
}

/// The route mission's peers without the one that ends it.
std::string write_route_mission(const std::filesystem::path& folder) {
  const std::string components = project_file("mission_profiles/route_planning/components/");
  const auto file = folder / "routes.xml";
  std::ofstream(file)
      << "<mission name='routes' domain='46' system='uav-1' dictionary='"
      << project_file("mission_profiles/dictionary.xml")
      << "' plugin='skein_navigation_components'>"
         "<peer name='navigator' component='"
      << components
      << "navigator.xml' vendor='cyclonedds' restart='on-failure' max_restarts='50' "
         "progress_timeout='5 s' restart_window='10 min'>"
         "<csp component='"
      << components << "a_star.xml' process='in'/><csp component='" << components
      << "rrt_connect.xml' process='own' restart='on-failure'>"
         "<parameter name='Seed' value='1'/></csp></peer>"
         "<peer name='flight_controller' component='"
      << components
      << "flight_controller.xml' vendor='fastdds' restart='on-failure' "
         "max_restarts='50' restart_window='10 min'/>"
         "<peer name='ad_manager' component='"
      << components
      << "ad_manager.xml' vendor='fastdds' restart='on-failure' max_restarts='50' "
         "restart_window='10 min'/></mission>";
  return file.string();
}

/// Calls until the answer comes, whatever becomes of the connection, and of a planner's time on a
/// busy machine, meanwhile.
template <class Call>
bool answers(const Call& call) {
  return eventually([&] {
    try {
      call();
      return true;
    } catch (const std::exception&) {
      return false;
    }
  });
}

}  // namespace

TEST_CASE("each peer of the route mission that is killed is in service again") {
  if (!installed("cyclonedds") || !installed("fastdds")) return;
  const Errand folder;
  const std::string profile = write_route_mission(folder.path());
  CommandRun launcher({"launch", profile});
  REQUIRE(launcher.writes("all 4 processes are ready"));
  Entity client({.name = "client",
                 .system = "uav-1",
                 .vendor = dds::load_vendor("cyclonedds"),
                 .domain = 46});
  AE_navigatorI::RouteRequest request;
  request.request_id = "again";
  request.problem = navigation::demo_problem(*navigation::TerrainProvider().load("synthetic:7"));
  request.problem.time_limit_ms = 5000;
  const std::pair<std::string, std::function<void()>> peers[] = {
      {"flight_controller",
       [&] {
         client.connect<AE_flightControllerI::IFlightController>().within(500ms).flight_limits();
       }},
      {"ad_manager",
       [&] {
         client.connect<AE_adManagerI::IAdManager>().within(500ms).threat_picture("synthetic:7");
       }},
      {"navigator",
       [&] { client.connect<AE_navigatorI::INavigator>().within(5s).request_route(request); }},
  };
  std::vector<double> times;
  for (int round = 0; round < 4; ++round) {
    for (const auto& [peer, call] : peers) {
      CAPTURE(peer, round);
      REQUIRE(becomes(profile, peer, "ready"));
      REQUIRE(answers(call));
      const auto killed = static_cast<pid_t>(status_of(profile, peer).pid);
      const auto begin = steady_clock::now();
      REQUIRE(kill(killed, SIGKILL) == 0);
      REQUIRE(eventually([&] { return !runs(killed); }));
      REQUIRE(answers(call));
      times.push_back(std::chrono::duration<double>(steady_clock::now() - begin).count());
    }
  }
  std::ranges::sort(times);
  WARN("from SIGKILL to an answer: median " << times[times.size() / 2] << " s, greatest "
                                            << times.back() << " s of " << times.size());
  launcher.signal(SIGINT);
  CHECK(launcher.wait() == 128 + SIGINT);
}

TEST_CASE("no process of a mission outlives a launcher that was killed") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string profile = errand.profile("", kOffice +
                                                     "<peer name='sick' component='sick.xml' "
                                                     "restart='on-failure'/>");
  CommandRun launcher({"launch", profile});
  REQUIRE(becomes(profile, "office", "ready"));
  std::vector<pid_t> processes;
  for (const auto& process : status_of(profile).processes) {
    if (process.pid != 0) processes.push_back(static_cast<pid_t>(process.pid));
  }
  REQUIRE_FALSE(processes.empty());
  launcher.signal(SIGKILL);
  CHECK(launcher.wait() == 128 + SIGKILL);
  CHECK(eventually([&] { return std::ranges::none_of(processes, runs); }, 2s));
}

TEST_CASE("a peer whose service spins is not alive: it is killed, and its successor answers") {
  if (!installed("fastdds")) return;
  const Errand errand;
  CommandRun launcher(
      {"launch", errand.profile("",
                                "<peer name='office' component='office.xml' "
                                "restart='on-failure' progress_timeout='1 s'/>"
                                "<peer name='vexer' component='vexer.xml' role='mission'/>")});
  const int code = launcher.wait();
  INFO(launcher.output());
  CHECK(code == 0);
  CHECK_THAT(launcher.output(), Contains("office: made no progress for 1.00 s (last it said: the "
                                         "calls of 'office' do not return"));
  CHECK_THAT(launcher.output(), Contains("the desk answers again"));
}

TEST_CASE("a peer that fails its self-test is never ready, and the reason is the launch's") {
  if (!installed("fastdds")) return;
  const Errand errand;
  CommandRun launcher({"launch", errand.profile("", "<peer name='sick' component='sick.xml'/>")});
  CHECK(launcher.wait() == 71);
  CHECK_THAT(launcher.output(),
             Contains("skein: sick ended with exit code 71 (last it said: the self-test of "
                      "'sick' has failed: no compass)"));
}

TEST_CASE("who was given up is shown, is started anew on request, and marks the mission") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string profile =
      errand.profile("", kOffice + "<peer name='sick' component='sick.xml' on_loss='degrade'/>");
  CommandRun launcher({"launch", profile});
  REQUIRE(becomes(profile, "sick", "lost"));
  CommandRun status({"status", profile});
  CHECK(status.wait() == 0);
  CHECK_THAT(status.output(), Contains("mission errand") && Contains(", degraded") &&
                                  Contains("sick: lost") && Contains("no compass"));
  CommandRun restart({"restart", profile, "sick"});
  CHECK(restart.wait() == 0);
  CHECK_THAT(restart.output(), Contains("sick is started anew"));
  CHECK(launcher.writes("is asked to start sick anew"));
  REQUIRE(becomes(profile, "sick", "lost"));
  CommandRun with_system({"restart", profile, "uav-1/sick"});  // as `skein peers` names it
  CHECK(with_system.wait() == 0);
  CHECK_THAT(with_system.output(), Contains("sick is started anew"));
  REQUIRE(becomes(profile, "sick", "lost"));

  CommandRun unknown({"restart", profile, "sickk"});
  CHECK(unknown.wait() == 71);
  CHECK_THAT(unknown.output(), Contains("did you mean 'sick'?"));
  launcher.signal(SIGINT);
  CHECK(launcher.wait() == 128 + SIGINT);
  CommandRun nobody({"status", profile});
  CHECK(nobody.wait() == 71);
  CHECK_THAT(nobody.output(), Contains("the mission 'errand' is not flown here on domain 48"));
}

TEST_CASE("all missions that fly here are shown to who names none") {
  if (!installed("fastdds")) return;
  const auto all = [](std::vector<std::string> options) {
    options.insert(options.begin(), "status");
    CommandRun run(options);
    CHECK(run.wait() == 0);
    return run.output();
  };
  CHECK(all({}) == "no mission of this user flies here\n");
  CHECK(all({"--json"}) == "[]\n");
  const Errand errand;
  const std::string other =
      errand.write("other.xml", "<mission name='other' domain='47' dictionary='" +
                                    project_file("mission_profiles/dictionary.xml") +
                                    "' plugin='skein_errand_components'>" + kOffice + "</mission>");
  CommandRun first({"launch", errand.profile("", kOffice)});
  CommandRun second({"launch", other});
  REQUIRE(first.writes("all 1 processes are ready"));
  REQUIRE(second.writes("all 1 processes are ready"));
  CHECK_THAT(
      all({}),
      Contains("mission errand, on domain 48, by launcher " + std::to_string(first.pid())) &&
          Contains("mission other, on domain 47, by launcher " + std::to_string(second.pid())) &&
          Contains("office: ready"));
}

TEST_CASE("the process of a CSP is started anew by each name under which it is shown") {
  if (!installed("cyclonedds") || !installed("fastdds")) return;
  const Errand folder;
  const std::string profile = write_route_mission(folder.path());
  CommandRun launcher({"launch", profile});
  REQUIRE(launcher.writes("all 4 processes are ready"));
  for (const std::string name :
       {"navigator/RRTConnect", "navigator.RRTConnect", "RRTConnect", "uav-1/navigator/RRTConnect",
        "uav-1/navigator.RRTConnect", "uav-1/RRTConnect"}) {
    CAPTURE(name);
    REQUIRE(becomes(profile, "navigator/RRTConnect", "ready"));
    CommandRun restart({"restart", profile, name});
    CHECK(restart.wait() == 0);
    CHECK(restart.output() == "navigator/RRTConnect is started anew\n");
  }
}

TEST_CASE("a launcher keeps logs of all that happened, with what the run depended on") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string profile =
      errand.profile("", kOffice + "<peer name='client' component='client.xml' role='mission'/>");
  CommandRun launcher({"launch", "--log-folder", "logs", profile});
  CHECK(launcher.wait() == 0);
  const auto text_of = [&](const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(launcher.folder() / "logs" / name).rdbuf();
    return text.str();
  };
  const std::string events = text_of("mission.log");
  for (const std::string part : {" skein: ", " host: ", "command: ", "office: ready after",
                                 "client: started as process", "exit code: 0"})
    CHECK_THAT(events, Contains(part));
  CHECK(events.find("office: ready after") < events.find("client: started as process"));
  CHECK_THAT(text_of("processes/client.log"), Contains("the desk says: yes, dear \\x1b[31mclient"));

  CommandRun usual({"launch", profile});
  CHECK(usual.wait() == 0);
  CHECK(exists(usual.folder() / "skein" / "errand-48" / "mission.log"));
  CommandRun none({"launch", "--no-log", profile});
  CHECK(none.wait() == 0);
  CHECK_FALSE(exists(none.folder() / "skein"));
  CommandRun impossible({"launch", "--log-folder", "/proc/logs", profile});
  CHECK(impossible.wait() == 71);
  CHECK_THAT(impossible.output(), Contains("the log folder /proc/logs cannot be made"));
}
