#include "launch/systemd_units.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <sstream>

#include "../tools/seed.hpp"
#include "../tools/shell.hpp"
#include "../tools/temporary_folder.hpp"
#include "launch/ready.hpp"
#include "service_manager.hpp"
#include "shell_mission.hpp"
#include "skein/error.hpp"

using namespace skein::launch;
using namespace std::chrono_literals;
using Catch::Contains;
using skein::profile::RestartPolicy;

namespace {

constexpr const char* kManager = "/lib/systemd/systemd";

void write_units(const TemporaryFolder& folder, const LaunchPlan& plan) {
  for (const auto& [name, text] : systemd_units(plan)) folder.write(name, text);
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
}

/// What systemd understood of a unit: its own account of the transaction that would start it.
/// Empty where systemd does not give one here.
std::string understood(const TemporaryFolder& folder, const std::string& unit) {
  if (::access(kManager, X_OK) != 0 || ::geteuid() != 0) return "";
  TemporaryFolder home;  // It gives its account to others than root alone.
  std::filesystem::permissions(home.path(), std::filesystem::perms(0777));
  const std::string text = skein::test::shell("env SYSTEMD_UNIT_PATH='" + folder.path().string() +
                                              ":' XDG_RUNTIME_DIR='" + home.path().string() +
                                              "' HOME='" + home.path().string() +
                                              "' timeout 60 setpriv --reuid=65534 --clear-groups " +
                                              kManager + " --test --user --unit='" + unit + "'")
                               .output;
  const auto begin = text.find("-> Unit " + unit + ":");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find("-> Unit ", begin + 1) - begin);
}

/// The words of a line in systemd's own notation: words in double quotes where they need it, with
/// the escapes of C in them.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::size_t at = 0;
  while (at < line.size()) {
    std::string word;
    bool quoted = false;
    for (; at < line.size() && (quoted || line[at] != ' '); ++at) {
      if (line[at] == '"') {
        quoted = !quoted;
      } else if (line[at] == '\\') {
        const char next = line[++at];
        const auto letter = std::string("abfnrtv").find(next);
        if (next >= '0' && next <= '7') {
          word += static_cast<char>(std::stoi(line.substr(at, 3), nullptr, 8));
          at += 2;
        } else if (next == 'x') {
          word += static_cast<char>(std::stoi(line.substr(at + 1, 2), nullptr, 16));
          at += 2;
        } else {
          word += letter == std::string::npos ? next : "\a\b\f\n\r\t\v"[letter];
        }
      } else {
        word += line[at];
      }
    }
    words.push_back(word);
    ++at;
  }
  return words;
}

std::string line_after(const std::string& text, const std::string& label) {
  const auto begin = text.find(label);
  if (begin == std::string::npos) return "";
  return text.substr(begin + label.size(), text.find('\n', begin) - begin - label.size());
}

ChildPlan restarted_child() {
  ChildPlan child = shell_child("navigator/RRT star", "exit 0");
  child.rules.restart.policy = RestartPolicy::OnFailure;
  child.rules.restart.delay = 100ms;
  child.rules.restart.max_restarts = 5;
  child.rules.restart.window = 30s;
  child.rules.ready_timeout = 30s;
  child.rules.stop_timeout = 3s;
  return child;
}

/// A socket for what services tell, as systemd has it.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& name) : socket_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path, sizeof address.sun_path);
    if (name[0] == '@') address.sun_path[0] = '\0';
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    REQUIRE(::bind(socket_, reinterpret_cast<sockaddr*>(&address), size) == 0);
    ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }
  ~NotifySocket() {
    ::unsetenv("NOTIFY_SOCKET");
    ::close(socket_);
  }

  std::string receive() const {
    std::array<char, 4096> buffer;
    const auto size = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
    return size < 0 ? "" : std::string(buffer.data(), static_cast<std::size_t>(size));
  }

 private:
  int socket_;
};

}  // namespace

TEST_CASE("A service has the rules of its process in systemd's words") {
  const auto units = systemd_units({"route planning", {restarted_child()}, {}});
  const std::string& text = units.at("skein-route\\x20planning-navigator-RRT\\x20star.service");
  for (const char* line : {"Type=notify\n", "Restart=on-failure\n", "RestartSec=0.100000\n",
                           "StartLimitIntervalSec=30.000000\n", "StartLimitBurst=6\n",
                           "TimeoutStartSec=30.000000\n", "TimeoutStopSec=3.000000\n",
                           "KillMode=control-group\n", "PartOf=skein-route\\x20planning.target\n",
                           "OnFailure=skein-route\\x20planning.over.target\n",
                           "StateDirectory=skein/route_planning\n"}) {
    CHECK_THAT(text, Contains(line));
  }
  CHECK_THAT(units.at("skein-route\\x20planning.target"),
             Contains("Requires=skein-route\\x20planning-navigator-RRT\\x20star.service"));
  CHECK_THAT(units.at("skein-route\\x20planning.over.target"),
             Contains("Conflicts=skein-route\\x20planning.target"));
}

TEST_CASE("The end of the mission's peer, and of nobody else, ends the mission whatever its code") {
  auto mission = shell_child("client", "exit 0");
  mission.runs_mission = true;
  auto optional = shell_child("extra", "exit 0");
  optional.rules.on_loss = skein::profile::LossPolicy::Continue;
  const auto units = systemd_units({"m", {mission, optional, shell_child("office", "")}, {}});
  CHECK_THAT(units.at("skein-m-client.service"), Contains("OnSuccess=skein-m.over.target"));
  CHECK_THAT(units.at("skein-m-office.service"),
             Contains("OnFailure=skein-m.over.target") && !Contains("OnSuccess"));
  CHECK_THAT(units.at("skein-m-extra.service"), !Contains("over.target"));
  CHECK_THAT(units.at("skein-m.target"), Contains("Wants=skein-m-extra.service"));
}

TEST_CASE(
    "A service comes after those that provide what it needs, and has systemd watch its progress") {
  auto office = shell_child("office", "");
  auto client = shell_child("client", "");
  client.layer = 1;
  client.after = {{"M/IDesk", {"office"}}, {"M/IRoom", {"office", "elsewhere"}}};
  client.rules.progress_timeout = 2s;
  const auto units = systemd_units({"m", {office, client}, {}});
  CHECK_THAT(units.at("skein-m-client.service"),
             Contains("After=skein-m-office.service\nRequires=skein-m-office.service\n") &&
                 Contains("Wants=skein-m-office.service\n") && Contains("WatchdogSec=2.000000\n"));
  CHECK_THAT(units.at("skein-m-office.service"), !Contains("After=") && !Contains("WatchdogSec"));
}

TEST_CASE("systemd understands each word of a command and each variable as the plan has it") {
  std::mt19937 random(skein::test::seed_of_this_run());
  const std::string alphabet = " abc019'\"\\$%;:@!+-{}#=\t\n\x01\x7f";
  const auto word = [&](const std::string& letters) {
    std::string text(random() % 12, ' ');
    for (char& c : text) c = letters[random() % letters.size()];
    return random() % 4 == 0 ? text + "\xc3\xa4" : text;
  };
  ChildPlan child = shell_child("a", "");
  child.argv = {"/bin/true", ";", "", "%h", "$HOME", "${HOME}", "\\x41", "'", "\"", "# no"};
  for (int i = 0; i < 200; ++i) child.argv.push_back(word(alphabet));
  child.environment = {{"VALUE", word(" abc019'\"\\$%;#=")}};
  const TemporaryFolder folder;
  write_units(folder, {"m", {child}, {}});
  const std::string text = understood(folder, "skein-m-a.service");
  if (text.empty()) {
    WARN("skipped: systemd does not tell here what it understands");
    return;
  }
  CHECK(words_of(line_after(text, "Command Line: ")) == child.argv);
  CHECK(line_after(text, "Environment: ") == "VALUE=" + child.environment[0].second);
}

TEST_CASE("systemd finds nothing wrong with the units") {
  const TemporaryFolder folder;
  write_units(
      folder,
      {"a 50% mission/of \"them\"", {restarted_child(), shell_child("b", "it's")}, {"c on beta"}});
  if (std::system("command -v systemd-analyze >/dev/null") != 0) {
    WARN("skipped: systemd-analyze is not installed");
    return;
  }
  CHECK(skein::test::shell("cd '" + folder.path().string() + "' && SYSTEMD_UNIT_PATH=\"$PWD:\" " +
                           "systemd-analyze verify ./*.service ./*.target")
            .output == "");
}

TEST_CASE("What a unit cannot hold is refused, and said") {
  auto child = shell_child("a", "");
  child.environment = {{"A", "bell\a"}};
  CHECK_THROWS_WITH(systemd_units({"m", {child}, {}}),
                    Contains("no control characters") && Contains("'A' of a"));
  child.environment.clear();
  child.argv = {"/opt/it's/skein"};
  CHECK_THROWS_WITH(systemd_units({"m", {child}, {}}),
                    Contains("systemd cannot start '/opt/it's/skein' for a"));
  CHECK_THROWS_WITH(systemd_units({std::string(250, 'm'), {shell_child("a", "")}, {}}),
                    Contains("at most 255 characters"));
}

TEST_CASE("systemd is told in its own words, on a path and in the abstract namespace") {
  const TemporaryFolder folder;
  const bool abstract = GENERATE(false, true);
  const std::string name = abstract ? "@skein-notify-" + std::to_string(::getpid())
                                    : (folder.path() / "notify").string();
  const NotifySocket socket(name);
  notify_service_manager("READY=1");
  CHECK(socket.receive() == "READY=1");
  report_waiting("waits for\nb");
  CHECK(socket.receive() == "STATUS=waits for b\n");
  CHECK(socket.receive().empty());
}

TEST_CASE("Without systemd, or with a socket that is none, nothing is told and nothing happens") {
  ::unsetenv("NOTIFY_SOCKET");
  notify_service_manager("READY=1");
  for (const std::string& name : {std::string("/no/such/socket"), std::string("vsock:1:2"),
                                  std::string(), "/" + std::string(200, 'x')}) {
    ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
    notify_service_manager("READY=1");
  }
  ::unsetenv("NOTIFY_SOCKET");
}
