#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <future>
#include <iterator>
#include <string>
#include <vector>

#include "core/system/abstract_socket.hpp"
#include "mission/process/request_server.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "mission/supervise/recent_lines.hpp"
#include "shell_mission.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"
#include "skein/guid.hpp"
#include "skein/mission_status.idl.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/lingering_connection.hpp"

using namespace skein;
using namespace skein::launch;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

/// A mission that its launcher runs in another thread, until this object goes.
class RunningMission {
 public:
  explicit RunningMission(std::vector<ChildPlan> children) : recorded_(std::move(children)) {
    mission_.name = "requests of process " + std::to_string(::getpid());
    claim_.emplace(mission_, "");
    auto options = recorded_.options();
    options.requests = &claim_->requests();
    supervisor_.emplace(recorded_.plan, options);
    result_ = std::async(std::launch::async, [&] { return supervisor_->run(); });
  }
  ~RunningMission() { supervisor_->request_stop(); }
  RunningMission(const RunningMission&) = delete;
  RunningMission& operator=(const RunningMission&) = delete;

  std::string ask(const std::string& request) const { return ask_launcher(mission_, "", request); }
  ProcessStatus status(std::size_t process) const {
    return idl::from_json<MissionStatus>(ask("status")).processes.at(process);
  }
  bool becomes(std::size_t process, const std::string& state) const {
    return test::eventually([&] { return status(process).state == state; });
  }
  LaunchResult result() { return result_.get(); }
  const profile::MissionProfile& mission() const { return mission_; }
  const std::string& socket() const { return claim_->name(); }

 private:
  profile::MissionProfile mission_;
  RecordedMission recorded_;
  std::optional<MissionClaim> claim_;
  std::optional<Supervisor> supervisor_;
  std::future<LaunchResult> result_;
};

/// Another user's process, which did something, and lives as long as this object.
class Stranger {
 public:
  /// `act` returns what it could not do; null if it could do all.
  template <class Act>
  explicit Stranger(const Act& act) {
    int done[2];
    int end[2];
    REQUIRE((::pipe2(done, O_CLOEXEC) == 0 && ::pipe2(end, O_CLOEXEC) == 0));
    process_ = ::fork();
    if (process_ == 0) {
      constexpr uid_t kAnother = 12'345;
      ::close(end[1]);
      const char* const failed = ::setuid(kAnother) == 0 ? act() : "become another user";
      std::string word = "done";
      if (failed) word = std::string(failed) + ": " + std::strerror(errno);
      const bool told = ::write(done[1], word.data(), word.size()) > 0;
      ::_exit(told && ::read(end[0], word.data(), 1) >= 0 ? 0 : 1);
    }
    ::close(end[0]);
    ::close(done[1]);
    end_ = FileDescriptor(end[1]);
    const FileDescriptor is_done(done[0]);
    std::array<char, 256> word{};
    REQUIRE(::read(is_done.get(), word.data(), word.size() - 1) > 0);
    REQUIRE(std::string(word.data()) == "done");
  }
  ~Stranger() {
    end_.reset();
    ::waitpid(process_, nullptr, 0);
  }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;

 private:
  pid_t process_ = -1;
  FileDescriptor end_;
};

bool is_stopped(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return text.find(") T ") != std::string::npos;
}

ChildPlan failing_child() {
  auto child = shell_child("a", "exit 3");
  child.rules.on_loss = profile::LossPolicy::Degrade;
  child.rules.restart.policy = profile::RestartPolicy::OnFailure;
  child.rules.restart.max_restarts = 2;
  return child;
}

}  // namespace

TEST_CASE("A launcher tells what it knows of each process") {
  RunningMission mission(
      {shell_child("a", kWait), failing_child(), shell_child("c", "kill -STOP $$")});
  REQUIRE(mission.becomes(0, "ready"));
  REQUIRE(mission.becomes(1, "lost"));
  const auto status = idl::from_json<MissionStatus>(mission.ask("status"));
  CHECK(status.mission == "m");
  CHECK(status.launcher == static_cast<std::uint32_t>(::getpid()));
  CHECK(status.degraded);
  CHECK(status.ending.empty());
  REQUIRE(status.processes.size() == 3);
  CHECK(status.processes[0].name == "a");
  CHECK(exists(static_cast<pid_t>(status.processes[0].pid)));
  CHECK(status.processes[0].uptime > 0);
  CHECK(status.processes[1].pid == 0);
  CHECK(status.processes[1].restarts == 2);
  CHECK(status.processes[1].last_exit == "with exit code 3");
  CHECK(status.processes[1].reason == "a ended with exit code 3, given up after 2 restarts");
  CHECK(status.processes[2].state == "starting");
}

TEST_CASE("A process that was given up is started anew on request, with all of its restarts") {
  RunningMission mission({shell_child("b", kWait), failing_child()});
  REQUIRE(mission.becomes(1, "lost"));
  CHECK(mission.ask("restart a") == "a is started anew");
  REQUIRE(mission.becomes(1, "lost"));
  CHECK(mission.status(1).restarts == 2);
}

TEST_CASE("A running process is replaced on request, whatever its rules of restart are") {
  RunningMission mission({shell_child("a", kWait)});
  REQUIRE(mission.becomes(0, "ready"));
  const auto before = mission.status(0).pid;
  CHECK(mission.ask("restart a") == "a is started anew");
  CHECK(test::eventually([&] {
    const auto now = mission.status(0);
    return now.state == "ready" && now.pid != before;
  }));
  CHECK_THAT(mission.status(0).last_exit, Contains("by signal"));
}

TEST_CASE(
    "A launcher of whom only the process is known is asked, and ends its mission on request") {
  RunningMission mission({shell_child("a", kWait)});
  REQUIRE(mission.becomes(0, "ready"));
  CHECK(ask_launcher(::getpid(), "stop") == "the mission is being ended");
  CHECK(mission.result().reason == "it was asked to stop");
  CHECK_THROWS_WITH(ask_launcher(1, "stop"), Contains("process 1 is no launcher of this user"));
}

TEST_CASE(
    "A request whose client has gone, as after a time without an answer, is not carried out") {
  profile::MissionProfile mission;
  mission.name = "asked in vain of process " + std::to_string(::getpid());
  MissionClaim claim(mission, "");
  std::vector<std::string> asked;
  const auto serve = [&] {
    claim.requests().serve({}, [&](std::string_view request) {
      asked.emplace_back(request);
      return std::string("ok");
    });
  };
  FileDescriptor patient(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  {
    const FileDescriptor client(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    using Asked = std::pair<const FileDescriptor&, const char*>;
    for (const auto& [socket, request] : {Asked(client, "stop\n"), Asked(patient, "x\n")}) {
      REQUIRE(connect_to(socket, claim.name()) == Reached::Yes);
      REQUIRE(::send(socket.get(), request, std::strlen(request), MSG_NOSIGNAL) > 0);
    }
  }
  CHECK(test::eventually([&] { return serve(), !asked.empty(); }));
  serve();
  CHECK(asked == std::vector<std::string>{"x"});
}

TEST_CASE("A launcher tells what its processes have printed, and what became of them") {
  RunningMission mission({shell_child("a", "echo hello; " + kWait)});
  REQUIRE(mission.becomes(0, "ready"));
  const auto has = [&](const std::string& text, bool printed) {
    const auto told = idl::from_json<MissionLines>(mission.ask("lines"));
    return std::ranges::any_of(told.lines, [&](const MissionLine& line) {
      return line.process == "a" && line.printed == printed && line.time > 0 &&
             line.text.find(text) != std::string::npos;
    });
  };
  CHECK(test::eventually([&] { return has("hello", true); }));
  CHECK(has("ready after", false));
}

TEST_CASE("Of a mission's lines the latest are kept, and of a long one the beginning") {
  RecentLines recent;
  for (std::size_t i = 0; i < RecentLines::kKept + 7; ++i)
    recent.add(i, "a", "uav-1", true, std::string(i % 2 == 0 ? 1 : 100'000, 'x') + "\x1b");
  const auto told = idl::from_json<MissionLines>(recent.json());
  REQUIRE(told.lines.size() == RecentLines::kKept);
  CHECK(told.lines.front().number == 8);
  CHECK(told.lines.back().system == "uav-1");
  CHECK(recent.json().size() < 300'000);
}

TEST_CASE("What a mission must bear is done to its processes on request") {
  // A shell that is just starting another program is not seen to be stopped: it waits in vfork().
  auto child = shell_child("a", "ready; exec sleep 1000");
  child.rules.restart.policy = profile::RestartPolicy::OnFailure;
  RunningMission mission({child});
  REQUIRE(mission.becomes(0, "ready"));
  const auto before = mission.status(0).pid;
  CHECK(mission.ask("hang a") == "a hangs from now on; restart it to go on");
  CHECK(test::eventually([&] { return is_stopped(static_cast<pid_t>(before)); }));
  CHECK(mission.ask("kill a") == "a is killed");
  CHECK(test::eventually([&] {
    const auto now = mission.status(0);
    return now.state == "ready" && now.pid != before;
  }));
  CHECK(mission.status(0).last_exit == "by signal 9 (Killed)");
}

TEST_CASE("What a launcher cannot do it refuses with the reason") {
  auto late = shell_child("late", kWait);
  late.layer = 1;
  late.after = {{"M/I", {"navigator"}}};
  RunningMission mission({shell_child("navigator", "kill -STOP $$"), late});
  REQUIRE(mission.becomes(0, "starting"));
  CHECK_THROWS_WITH(mission.ask("restart navigatro"),
                    Contains("the mission has no process 'navigatro' here (did you mean "
                             "'navigator'?); it has navigator, late"));
  CHECK_THROWS_WITH(mission.ask("restart late"), Contains("late was not started yet"));
  CHECK_THROWS_WITH(mission.ask("dance"), Contains("does not know this request"));
}

TEST_CASE("Clients that say nothing, too much, or go away do not keep others from being answered") {
  RunningMission mission({shell_child("a", kWait)});
  const auto connect = [&] {
    FileDescriptor client(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    REQUIRE(connect_to(client, mission.socket()) == Reached::Yes);
    return client;
  };
  std::vector<FileDescriptor> silent;
  for (int i = 0; i < 20; ++i) silent.push_back(connect());
  connect().reset();
  const auto talkative = connect();
  const std::string much(100'000, 'x');
  ::send(talkative.get(), much.data(), much.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  CHECK_THAT(mission.ask("status"), Contains("\"a\""));
  char answer = 0;
  CHECK(::read(talkative.get(), &answer, 1) <= 0);  // it was sent away
}

TEST_CASE(
    "What another user hands over to a launcher is closed by a thread that nobody waits for") {
  if (::getuid() != 0) {
    WARN("not tested: only root can be another user");
    return;
  }
  RunningMission mission({shell_child("a", kWait)});
  Stranger stranger([&] {
    static test::LingeringConnection lingering;
    const bool refused = lingering.hand_over_to_refuser([&] {
      FileDescriptor client(::socket(AF_UNIX, SOCK_STREAM, 0));
      connect_to(client, mission.socket());
      return client;
    });
    return refused ? nullptr : "hand over a connection and be refused";
  });
  CHECK_THAT(mission.ask("status"), Contains("\"a\""));
}

TEST_CASE("Other users' clients wake a launcher only after a pause") {
  if (::getuid() != 0) {
    WARN("not tested: only root can be another user");
    return;
  }
  profile::MissionProfile mission;
  mission.name = "knocked at in process " + std::to_string(::getpid());
  MissionClaim claim(mission, "");
  const auto knock = [&] {
    static FileDescriptor client;
    client = local_socket();
    return connect_to(client, claim.name()) == Reached::Yes ? nullptr : "connect";
  };
  const auto wakes = [&] {
    pollfd look{claim.requests().descriptor(), POLLIN, 0};
    return ::poll(&look, 1, 0) == 1;
  };
  const auto serve = [&](Time now) { return claim.requests().serve(now, {}); };
  const Time begin{};
  const Stranger first(knock);
  CHECK(wakes());
  const auto paused_until = serve(begin);
  REQUIRE(paused_until == begin + kAfterRefusal);
  const Stranger second(knock);
  CHECK_FALSE(wakes());
  CHECK_FALSE(serve(*paused_until));
  CHECK(wakes());
  CHECK(serve(*paused_until) == *paused_until + kAfterRefusal);
}

TEST_CASE("Other users' full sockets with launchers' names keep nobody waiting") {
  if (::getuid() != 0) {
    WARN("not tested: only root can be another user");
    return;
  }
  RunningMission mission({shell_child("a", kWait)});
  Stranger stranger([]() -> const char* {
    static std::vector<FileDescriptor> sockets;
    for (int i = 0; i < 5; ++i) {
      const std::string name = "skein-launch-0-7-" + std::to_string(i);
      sockets.push_back(local_socket());
      if (!listen_at(sockets.back(), name, 0)) return "listen";
      do {
        sockets.push_back(local_socket());
      } while (connect_to(sockets.back(), name) == Reached::Yes);
    }
    return nullptr;
  });
  const auto begin = std::chrono::steady_clock::now();
  const auto answers = ask_launchers("status");
  CHECK(std::chrono::steady_clock::now() - begin < 10s);
  CHECK(std::ranges::count(answers, "", &LauncherAnswer::failure) > 0);
}

TEST_CASE("Requests that came before their clients were let in are answered at once") {
  RequestServer server;
  const std::string name = "skein-test/" + Guid::random().hex();
  ListeningSocket socket(local_socket());
  REQUIRE(server.open(socket, name));
  std::vector<Contact> clients;
  for (std::size_t i = 0; i < RequestServer::kMostClients; ++i) {
    clients.push_back(reach(name, [](uid_t) { return true; }));
    REQUIRE(::send(clients.back().socket.get(), "what\n", 5, MSG_NOSIGNAL) == 5);
  }
  server.serve({}, [](std::string_view request) { return std::string(request) + "!"; });
  for (const Contact& client : clients) {
    std::array<char, 16> text{};
    CHECK(::recv(client.socket.get(), text.data(), text.size(), MSG_DONTWAIT) == 5);
    CHECK(std::string(text.data()) == "what!");
  }
}

TEST_CASE("A launcher that has no room for further clients is known all the same") {
  profile::MissionProfile mission;
  mission.name = "asked too much of process " + std::to_string(::getpid());
  const MissionClaim claim(mission, "");
  std::vector<FileDescriptor> waiting;
  do {
    waiting.emplace_back(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  } while (connect_to(waiting.back(), claim.name()) == Reached::Yes);
  REQUIRE(errno == EAGAIN);
  CHECK_THROWS_WITH(MissionClaim(mission, ""),
                    Contains("by process " + std::to_string(::getpid())));
}

TEST_CASE("Another user's process that takes a launcher's name keeps no mission from flying") {
  if (::getuid() != 0) {
    WARN("not tested: only root can be another user");
    return;
  }
  profile::MissionProfile mission;
  mission.name = "wanted by process " + std::to_string(::getpid());
  const std::string name = MissionClaim(mission, "").name();
  const bool listens = GENERATE(false, true);
  CAPTURE(listens);
  const Stranger stranger([&] {
    static const FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
    sockaddr_un address;
    const socklen_t size = fill_address(address, name);
    const bool taken = ::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                       (!listens || ::listen(socket.get(), 0) == 0);
    return taken ? nullptr : "take the name";
  });
  {
    const MissionClaim claim(mission, "");
    CHECK_FALSE(claim.name().empty());
    CHECK(claim.name() != name);
    CHECK_THROWS_WITH(MissionClaim(mission, ""),
                      Contains("by process " + std::to_string(::getpid())));
  }
}

TEST_CASE("Without a launcher there is nobody to ask, and what to do is said") {
  profile::MissionProfile mission;
  mission.name = "nobody flies this";
  CHECK_THROWS_WITH(ask_launcher(mission, "", "status"),
                    Contains("the mission 'nobody flies this' is not flown here on domain 0; start "
                             "it by skein launch"));
}
