// `skein script`: a mission started by a shell, or by systemd, instead of the launcher.
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "command_run.hpp"
#include "errand.hpp"
#include "installed.hpp"

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

TEST_CASE("units of systemd are written to the folder, which is made, and named") {
  const Errand errand;
  CommandRun run({"script", errand.profile("", kPeers), "--systemd", "new/units"});
  CHECK(run.wait() == 0);
  for (const char* name : {"skein-errand.target", "skein-errand.over.target",
                           "skein-errand-office.service", "skein-errand-client.service"}) {
    CHECK_THAT(run.output(), Contains(name));
    CHECK(std::filesystem::exists(run.folder() / "new/units" / name));
  }
  CommandRun nowhere(
      {"script", errand.profile("", kPeers), "--output", "/no/such/folder/start.sh"});
  CHECK(nowhere.wait() == 74);
  CHECK_THAT(nowhere.output(), Contains("'/no/such/folder/start.sh' cannot be written"));
  CommandRun no_folder({"script", errand.profile("", kPeers), "--systemd", "/dev/null/units"});
  CHECK(no_folder.wait() == 74);
  CHECK_THAT(no_folder.output(), Contains("the folder '/dev/null/units' cannot be made"));
}

TEST_CASE("a script for which the disk has no room is output that was lost") {
  const Errand errand;
  CommandRun run({"script", errand.profile("", kPeers), "--output", "/dev/full"});
  CHECK(run.wait() == 74);
  CHECK_THAT(run.output(), Contains("the script '/dev/full' cannot be written: writing"));
}

TEST_CASE("a peer that systemd has started tells it what it waits for, and when it is ready") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string profile = errand.profile("", kPeers);
  const std::string name = "@skein-script-test-" + std::to_string(getpid());
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.substr(1).copy(address.sun_path + 1, name.size() - 1);
  REQUIRE(bind(socket, reinterpret_cast<sockaddr*>(&address),
               static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size())) == 0);
  std::string told;
  const auto hears = [&](const std::string& part) {
    return eventually([&] {
      std::array<char, 4096> buffer;
      const auto size = recv(socket, buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (size > 0) told.append(buffer.data(), static_cast<std::size_t>(size));
      return told.find(part) != std::string::npos;
    });
  };
  const CommandOptions options{.prepare = [&] { setenv("NOTIFY_SOCKET", name.c_str(), 1); }};
  CommandRun client({"peer", profile, "client"}, options);
  CHECK(hears("STATUS=waits for its dependency: no provider of 'crew/Desk'"));
  CHECK_THAT(told, !Contains("READY=1"));
  CommandRun office({"peer", profile, "office"});
  CHECK(hears("READY=1"));
  CHECK(client.wait() == 0);
  close(socket);
}
