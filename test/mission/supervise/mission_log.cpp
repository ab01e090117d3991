#include "mission/supervise/mission_log.hpp"

#include <catch2/catch.hpp>
#include <cerrno>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "mission/supervise/environment_record.hpp"
#include "test/mission/profile/profile_folder.hpp"
#include "test/tools/size_limit.hpp"

using namespace skein::launch;

namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The record of a run with these variables in its environment.
std::string record_with(const std::map<std::string, std::string>& variables,
                        const skein::profile::MissionProfile& mission) {
  for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
  std::string text;
  for (const std::string& fact : environment_record(mission, "1.2.3")) text += fact + "\n";
  for (const auto& [name, value] : variables) ::unsetenv(name.c_str());
  return text;
}

}  // namespace

TEST_CASE("A log rotates by size, keeps so many files, and loses none of the newest lines") {
  TemporaryFolder folder;
  const auto file = folder.path() / "a.log";
  const auto write = [&](int first, int last) {
    RotatingFile log(file, {.size = 10, .files = 3});
    for (int i = first; i <= last; ++i) REQUIRE(log.write("line" + std::to_string(i)));
  };
  write(0, 4);  // five characters and a line break: one goes into a file, two do not
  CHECK(text_of(file) == "line4\n");
  CHECK(text_of(folder.path() / "a.1.log") == "line3\n");
  CHECK(text_of(folder.path() / "a.2.log") == "line2\n");
  CHECK_FALSE(exists(folder.path() / "a.3.log"));
  SECTION("the next run begins a file of its own") {
    write(5, 5);
    CHECK(text_of(file) == "line5\n");
    CHECK(text_of(folder.path() / "a.1.log") == "line4\n");
  }
}

TEST_CASE("A line that is longer than a file is kept whole") {
  TemporaryFolder folder;
  RotatingFile log(folder.path() / "a.log", {.size = 10, .files = 2});
  CHECK(log.write(std::string(100, 'x')));
  CHECK(text_of(folder.path() / "a.log").size() == 101);
}

TEST_CASE("Each process has its log, and events theirs; each line begins with both clocks") {
  TemporaryFolder folder;
  MissionLog log(folder.path() / "logs", {});
  CHECK(log.add_line("navigator", "hello"));
  CHECK(log.add_line("navigator/RRTstar", "red \x1b[31m"));
  CHECK(log.add_event(ChildEvent{"navigator", ChildState::Ready, "ready after 0.21 s"}));
  CHECK(log.add_event(ChildEvent{"", ChildState::Idle, "ends: all is done"}));
  const std::string clocks = R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z \d+\.\d{6} )";
  const auto processes = folder.path() / "logs" / "processes";
  CHECK(std::regex_match(text_of(processes / "navigator.log"), std::regex(clocks + "hello\n")));
  CHECK_THAT(text_of(processes / "navigator.RRTstar.log"), Catch::Contains("red \\x1b[31m"));
  CHECK(std::regex_match(text_of(folder.path() / "logs" / "mission.log"),
                         std::regex(clocks + "navigator: ready after 0.21 s\n" + clocks +
                                    "mission: ends: all is "
                                    "done\n")));
}

TEST_CASE("A folder that cannot be made is named, with the reason") {
  TemporaryFolder folder;
  folder.write("file", "");
  CHECK_THROWS_WITH(MissionLog(folder.path() / "file" / "logs", {}),
                    Catch::Contains("/file/logs cannot be made (Not a directory)"));
}

TEST_CASE("A log that cannot be written says so once, and later lines are tried again") {
  TemporaryFolder folder;
  MissionLog log(folder.path() / "logs", {});
  std::filesystem::remove(folder.path() / "logs" / "processes");
  CHECK_FALSE(log.add_line("a", "lost"));
  CHECK_THAT(log.failure(),
             Catch::Contains("/processes/a.log cannot be written: No such file or directory"));
  CHECK(log.add_line("a", "lost"));
  std::filesystem::create_directory(folder.path() / "logs" / "processes");
  CHECK(log.add_line("a", "kept"));
  CHECK_THAT(text_of(folder.path() / "logs" / "processes" / "a.log"), Catch::Contains(" kept\n"));
}

TEST_CASE("A log that may not grow says so, and ends nobody") {
  TemporaryFolder folder;
  RotatingFile log(folder.path() / "a.log", {.size = 1000, .files = 2});
  const skein::test::SizeLimit limit(8);
  REQUIRE(log.write("first"));
  CHECK_FALSE(log.write("second"));
  CHECK(errno == EFBIG);
}

TEST_CASE("A log that cannot begin its next file keeps those that it has, and goes on later") {
  TemporaryFolder folder;
  const auto file = folder.path() / "a.log";
  RotatingFile log(file, {.size = 10, .files = 3});
  for (const char* line : {"first", "second", "third"}) REQUIRE(log.write(line));
  const auto in_the_way = folder.path() / "a.new";
  std::filesystem::create_directory(in_the_way);
  for (int i = 0; i < 5; ++i) CHECK_FALSE(log.write("lost"));
  CHECK(text_of(file) == "third\n");
  CHECK(text_of(folder.path() / "a.1.log") == "second\n");
  CHECK(text_of(folder.path() / "a.2.log") == "first\n");
  std::filesystem::remove(in_the_way);
  CHECK(log.write("fourth"));
  CHECK(text_of(file) == "fourth\n");
  CHECK(text_of(folder.path() / "a.1.log") == "third\n");
}

TEST_CASE("Only its user can read a log") {
  TemporaryFolder folder;
  MissionLog log(folder.path(), {});
  REQUIRE(log.add_event("an event"));
  REQUIRE(log.add_line("a", "a line"));
  using std::filesystem::perms;
  for (const char* name : {"mission.log", "processes/a.log"}) {
    CHECK(std::filesystem::status(folder.path() / name).permissions() ==
          (perms::owner_read | perms::owner_write));
  }
}

TEST_CASE("Logs are kept by mission and domain, in a folder that no name can lead out of") {
  skein::profile::MissionProfile mission;
  mission.name = "../a mission";
  mission.domain = 7;
  ::setenv("XDG_STATE_HOME", "/state", 1);
  CHECK(log_folder(mission) == "/state/skein/___a_mission-7");
  ::unsetenv("XDG_STATE_HOME");
  ::setenv("HOME", "/own", 1);
  CHECK(log_folder(mission) == "/own/.local/state/skein/___a_mission-7");
}

TEST_CASE("The record of a run's environment has versions, machine, command line and parameters") {
  ProfileFolder folder;
  const auto mission = skein::profile::read_mission_profile(folder.mission(
      R"(<peer name="n" component="n.xml" vendor="loopback">
           <csp component="p.xml"><parameter name="Seed" value="7"/></csp></peer>)"));
  const std::string text = record_with({{"SKEIN_TRIAL", "1"}}, mission);
  for (const std::string part : {"skein: 1.2.3, ABI ", "host: ", " processors\n", "launch_test",
                                 "m.xml, mission 'm', domain 0, vendors loopback\n",
                                 "parameter: n/P.Seed = 7\n", "environment: SKEIN_TRIAL=1\n"}) {
    CHECK_THAT(text, Catch::Contains(part));
  }
}

TEST_CASE("The record of a run's environment does not tell secrets") {
  const std::string text = record_with({{"SKEIN_VIEW_TOKEN", "hush"},
                                        {"SKEIN_CLIENT_SECRET", "hush"},
                                        {"FASTDDS_PASSWORD", "hush"},
                                        {"CYCLONEDDS_PRIVATE_KEY", "hush"},
                                        {"SKEIN_KEYBOARD", "told"}},
                                       {});
  CHECK_THAT(text, !Catch::Contains("hush"));
  for (const std::string part :
       {"SKEIN_VIEW_TOKEN (not shown)\n", "SKEIN_CLIENT_SECRET (not shown)\n",
        "FASTDDS_PASSWORD (not shown)\n", "CYCLONEDDS_PRIVATE_KEY (not shown)\n",
        "SKEIN_KEYBOARD=told\n"})
    CHECK_THAT(text, Catch::Contains("environment: " + part));
}
