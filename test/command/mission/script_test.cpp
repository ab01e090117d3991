// `skein script`: a mission started by a shell instead of the launcher.
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "errand.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

const std::string kPeers =
    "<peer name='office' component='office.xml'/>"
    "<peer name='client' component='client.xml' role='mission'/>";

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// What follows `label` on each line that has it.
std::vector<std::string> after(const std::string& label, const std::string& text) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find(label);
    if (at != std::string::npos) found.push_back(line.substr(at + label.size()));
  }
  return found;
}

}  // namespace

TEST_CASE("the script has the commands that the dry run shows, and flies the mission") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string profile = errand.profile("", kPeers);
  CommandRun dry({"launch", "--dry-run", profile});
  REQUIRE(dry.wait() == 0);
  CommandRun written({"script", profile, "--output", "start.sh"});
  REQUIRE(written.wait() == 0);
  const auto script = written.folder() / "start.sh";
  const auto commands = after("run:   ", dry.output());
  CHECK(commands.size() == 2);
  CHECK(after("exec setsid env --default-signal=INT,QUIT SKEIN_READY_FD=3 ", text_of(script)) ==
        commands);

  const std::string run =
      "cd '" + written.folder().string() + "' && timeout 120 ./start.sh > output 2> errors";
  CHECK(std::system(run.c_str()) == 0);
  CHECK_THAT(text_of(written.folder() / "output"), Contains("the desk says: yes, dear"));
}

TEST_CASE("the script of one host starts that host's peers alone") {
  const Errand errand;
  const std::string profile = errand.profile(
      "interface='eth0'",
      "<peer name='office' component='office.xml' host='192.0.2.1'/>"
      "<peer name='client' component='client.xml' role='mission' host='192.0.2.2'/>");
  CommandRun run({"script", "--host", "192.0.2.1", profile});
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(), Contains(" office\n") && !Contains(" client\n}") &&
                               Contains("# Not started here: client on 192.0.2.2"));
  CommandRun nobody({"script", "--host", "192.0.2.3", profile});
  CHECK(nobody.wait() == 78);
  CHECK_THAT(nobody.output(), Contains("did you mean '192.0.2.1'?"));
}

TEST_CASE("a script for which the disk has no room is output that was lost") {
  const Errand errand;
  CommandRun run({"script", errand.profile("", kPeers), "--output", "/dev/full"});
  CHECK(run.wait() == 74);
  CHECK_THAT(run.output(), Contains("the script '/dev/full' cannot be written: writing"));
  CommandRun nowhere(
      {"script", errand.profile("", kPeers), "--output", "/no/such/folder/start.sh"});
  CHECK(nowhere.wait() == 74);
  CHECK_THAT(nowhere.output(), Contains("'/no/such/folder/start.sh' cannot be written"));
}
