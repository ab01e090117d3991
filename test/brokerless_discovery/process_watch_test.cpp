#include "brokerless_discovery/process_watch.hpp"

#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <vector>

#include "brokerless_discovery/kill_process.hpp"
#include "core/system/abstract_socket.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/lingering_connection.hpp"
#include "test/tools/log.hpp"

using namespace skein::brokerless_discovery;
using skein::connect_to;
using skein::FileDescriptor;
using skein::listen_at;
using skein::local_socket;
using skein::Reached;
using skein::test::eventually;
using skein::test::LingeringConnection;

namespace {

const skein::Guid kParticipant = *skein::Guid::from_hex("0102030405060708090a0b0c00000000");
const void* const kWatcher = &kParticipant;

/// A process that can be watched, and waits to be killed.
struct Child {
  pid_t pid;
  std::string address;
  FileDescriptor told;  // one byte for each end that it hears of

  /// It watches nothing, or what listens at `target`, after it did what `prepare` says; without an
  /// address if it has ended there.
  explicit Child(
      const std::string& target = {}, const std::function<void()>& prepare = [] {}) {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    pid = fork();
    if (pid == 0) {
      prepare();
      ProcessWatch own;
      const auto tell = [&](std::string_view text) {
        [[maybe_unused]] const ssize_t written = write(ends[1], text.data(), text.size());
      };
      const std::string own_address = own.open(kParticipant);
      if (!target.empty()) own.watch(target, kWatcher, [&] { tell("!"); });
      tell(own_address);  // when it watches: who knows the address may fill its descriptors
      while (true) pause();
    }
    close(ends[1]);
    told = FileDescriptor(ends[0]);
    char text[128];
    const ssize_t count = read(ends[0], text, sizeof text);
    REQUIRE(count >= 0);
    address.assign(text, static_cast<std::size_t>(count));
  }

  bool heard_of_an_end() const {
    pollfd look{told.get(), POLLIN, 0};
    return poll(&look, 1, 0) == 1;
  }

  std::size_t descriptors() const {
    const std::filesystem::directory_iterator all("/proc/" + std::to_string(pid) + "/fd");
    return static_cast<std::size_t>(
        std::distance(std::filesystem::begin(all), std::filesystem::end(all)));
  }

  /// Whether none of its threads runs or wants to.
  bool asleep() const {
    const std::filesystem::directory_iterator tasks("/proc/" + std::to_string(pid) + "/task");
    return std::all_of(std::filesystem::begin(tasks), std::filesystem::end(tasks),
                       [](const auto& task) {
                         std::ifstream file(task.path() / "stat");
                         const std::string text{std::istreambuf_iterator<char>(file), {}};
                         return text.substr(text.rfind(')') + 2, 1) == "S";
                       });
  }

  ~Child() { end(); }

  void end() {
    if (pid == 0) return;
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
    pid = 0;
  }
};

std::vector<FileDescriptor> connections_to(const std::string& address, std::size_t count) {
  std::vector<FileDescriptor> connections;
  for (std::size_t i = 0; i < count; ++i) {
    connections.push_back(local_socket());
    if (connect_to(connections.back(), address) != Reached::Yes) break;
  }
  return connections;
}

/// Listens at an address as a process does, but accepts nobody by itself.
struct Doorman {
  std::string address = "skein/" + skein::Guid::random().hex();
  FileDescriptor socket = local_socket();

  Doorman() { REQUIRE(listen_at(socket, address)); }
  FileDescriptor let_in() const {
    FileDescriptor guest;
    REQUIRE(eventually([&] {
      guest = FileDescriptor(accept(socket.get(), nullptr, nullptr));
      return static_cast<bool>(guest);
    }));
    return guest;
  }
};

void end_process(pid_t pid) {
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
}

/// A process that listens at an address, greets the first watcher, if it is to, and ends by itself
/// or stays. A child of it has copies of its sockets.
struct Listener {
  enum class Then { End, Stay };
  pid_t pid;
  FileDescriptor keeps;  // the child ends with it

  explicit Listener(const std::string& address, Then then = Then::End) {
    int alive[2];
    int ready[2];
    REQUIRE((pipe(alive) == 0 && pipe(ready) == 0));
    pid = fork();
    if (pid == 0) {
      close(alive[1]);
      const FileDescriptor listening(socket(AF_UNIX, SOCK_STREAM, 0));
      if (!listen_at(listening, address) || write(ready[1], "!", 1) != 1) _exit(1);
      FileDescriptor guest;
      if (then == Then::Stay) {
        guest = FileDescriptor(accept(listening.get(), nullptr, nullptr));
        if (write(guest.get(), "!", 1) != 1) _exit(1);
      }
      char octet;
      if (fork() == 0) _exit(read(alive[0], &octet, 1) == 0 ? 0 : 1);
      if (then == Then::End) _exit(0);
      while (true) pause();
    }
    close(alive[0]);
    close(ready[1]);
    keeps = FileDescriptor(alive[1]);
    const FileDescriptor is_ready(ready[0]);
    char octet;
    REQUIRE(read(is_ready.get(), &octet, 1) == 1);
  }
};

/// Whether the process has a child.
bool has_child(pid_t pid) {
  const std::string number = std::to_string(pid);
  std::ifstream file("/proc/" + number + "/task/" + number + "/children");
  return static_cast<bool>(file >> pid);
}

constexpr uid_t kAnother = 12'345;

}  // namespace

TEST_CASE("the kernel tells of the end of a watched process, once") {
  Child child;
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  watch.watch(child.address, kWatcher, [&] { ++ended; });
  watch.watch(child.address, kWatcher, [&] { ++ended; });
  CHECK(ended == 0);
  child.end();
  CHECK(eventually([&] { return ended == 1; }));
}

TEST_CASE("a process whose child has copies of its sockets has ended all the same") {
  const std::string address = "skein/" + skein::Guid::random().hex();
  const Listener listener(address, Listener::Then::Stay);
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  watch.watch(address, kWatcher, [&] { ++ended; });
  REQUIRE(eventually([&] { return has_child(listener.pid); }));
  CHECK(ended == 0);
  end_process(listener.pid);
  CHECK(eventually([&] { return ended == 1; }));
  CHECK(watch.counters().watched == 0);
}

TEST_CASE("a stopped process has not ended") {
  Child child;
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  kill(child.pid, SIGSTOP);
  watch.watch(child.address, kWatcher, [&] { ++ended; });
  kill(child.pid, SIGCONT);
  CHECK(ended == 0);
  child.end();
  CHECK(eventually([&] { return ended == 1; }));
}

TEST_CASE("a process that ended before it was watched is told at once") {
  Child child;
  child.end();
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  watch.watch(child.address, kWatcher, [&] { ++ended; });
  CHECK(ended == 1);
}

TEST_CASE("a process is killed by its address, running or stopped, and once it is gone nobody is") {
  Child child;
  if (GENERATE(false, true)) kill(child.pid, SIGSTOP);
  CHECK(kill_process(child.address));
  int status = 0;
  REQUIRE(waitpid(child.pid, &status, 0) == child.pid);
  child.pid = 0;
  CHECK(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGKILL);
  CHECK_FALSE(kill_process(child.address));
}

TEST_CASE("where only a stopped process is to be killed, one that runs is left alone") {
  Child child;
  CHECK_FALSE(kill_stopped_process(child.address));
  kill(child.pid, SIGSTOP);
  REQUIRE(eventually([&] { return kill_stopped_process(child.address); }));
  int status = 0;
  REQUIRE(waitpid(child.pid, &status, 0) == child.pid);
  child.pid = 0;
  CHECK(WTERMSIG(status) == SIGKILL);
}

TEST_CASE("a process does not kill itself") {
  ProcessWatch own;
  CHECK_FALSE(kill_process(own.open(kParticipant)));
}

TEST_CASE("a process that has the number of one that ended is not killed in its place") {
  if (geteuid() != 0) {
    WARN("skipped: only root can choose a process's number");
    return;
  }
  const std::string address = "skein/" + skein::Guid::random().hex();
  const Listener ended(address);
  REQUIRE(waitpid(ended.pid, nullptr, 0) == ended.pid);
  REQUIRE(connections_to(address, 1).size() == 1);  // in a child of it the socket lives on
  pid_t bystander = 0;
  for (int i = 0; i < 100 && bystander != ended.pid; ++i) {
    if (bystander != 0) end_process(bystander);
    std::ofstream("/proc/sys/kernel/ns_last_pid") << ended.pid - 1;
    bystander = fork();
    if (bystander == 0) {
      while (true) pause();
    }
  }
  if (bystander != ended.pid) WARN("not shown: the number was not given again");
  CHECK_FALSE(kill_process(address));
  CHECK(kill(bystander, 0) == 0);
  CHECK(waitpid(bystander, nullptr, WNOHANG) == 0);
  end_process(bystander);
}

TEST_CASE("another user's process is not killed, even by root") {
  if (geteuid() != 0) {
    WARN("skipped: only root can become another user");
    return;
  }
  const Child foreign({}, [] { REQUIRE(setuid(kAnother) == 0); });
  CHECK_FALSE(kill_process(foreign.address));
  CHECK(waitpid(foreign.pid, nullptr, WNOHANG) == 0);
}

TEST_CASE("hosts that do not say which they are count as different ones, and the log says so") {
  const auto host_of_another = [] {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const pid_t pid = fork();
    if (pid == 0) {
      // As under systemd's ProcSubset=pid.
      const bool hidden = unshare(CLONE_NEWNS) == 0 &&
                          mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                          mount("none", "/proc/sys", "tmpfs", 0, nullptr) == 0;
      const skein::test::Log log;
      const std::string host = ProcessWatch::host();
      const bool same =
          ProcessWatch::host() == host && log.count("cannot be told from others") == 1;
      const std::string text = !hidden ? "refused" : same ? host : "changed";
      [[maybe_unused]] const auto size = write(ends[1], text.data(), text.size());
      _exit(0);
    }
    close(ends[1]);
    char text[256];
    const auto size = read(ends[0], text, sizeof text);
    close(ends[0]);
    waitpid(pid, nullptr, 0);
    return std::string(text, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  };
  const std::string one = host_of_another();
  if (one == "refused") {
    WARN("skipped: this process may not hide /proc/sys");
    return;
  }
  CHECK(one.size() > 32);
  CHECK(host_of_another() != one);
}

TEST_CASE("processes of one network namespace are on one host") {
  CHECK_FALSE(ProcessWatch::host().empty());
  CHECK(ProcessWatch::host() == ProcessWatch::host());
}

TEST_CASE("an address is of the participant for which it was opened, and of no other", "[R27]") {
  ProcessWatch watch;
  const std::string address = watch.open(kParticipant);
  CHECK(ProcessWatch::is_address_of(kParticipant, address));
  CHECK_FALSE(ProcessWatch::is_address_of(skein::Guid::random(), address));
  CHECK(watch.open(kParticipant) != address);
  for (const std::string& other :
       {std::string(), std::string("skein/"), address + "0", "/" + address,
        "skein/" + std::string(32, 'g'), "other/" + skein::Guid::random().hex()}) {
    CAPTURE(other);
    CHECK_FALSE(ProcessWatch::is_address(other));
    CHECK_FALSE(kill_process(other));
    int ended = 0;
    watch.watch(other, kWatcher, [&] { ++ended; });
    CHECK(ended == 0);
  }
}

TEST_CASE("each watcher of an address hears of the end, and who has left does not", "[R27]") {
  Child child;
  ProcessWatch watch;
  std::atomic<int> one = 0;
  std::atomic<int> two = 0;
  std::atomic<int> three = 0;
  watch.watch(child.address, &one, [&] { ++one; });
  watch.watch(child.address, &two, [&] { ++two; });
  watch.watch(child.address, &three, [&] { ++three; });
  CHECK(watch.counters().watched == 1);
  watch.unwatch(child.address, &two);
  child.end();
  CHECK(eventually([&] { return one == 1 && three == 1; }));
  CHECK(two == 0);
  CHECK(watch.counters().watched == 0);
}

TEST_CASE("what nobody watches any more holds no descriptor", "[R27]") {
  Child child;
  ProcessWatch watch;
  const int other = 0;
  watch.watch(child.address, kWatcher, [] {});
  watch.watch(child.address, &other, [] {});
  watch.unwatch(child.address, kWatcher);
  CHECK(watch.counters().watched == 1);
  watch.unwatch(&other);
  CHECK(watch.counters().watched == 0);
}

TEST_CASE("who is turned away does not take it for the process's end", "[R27]") {
  const Doorman door;
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  watch.watch(door.address, kWatcher, [&] { ++ended; });
  { const FileDescriptor turned_away = door.let_in(); }
  { const FileDescriptor turned_away_again = door.let_in(); }
  CHECK(eventually([&] { return watch.counters().watched == 0; }));
  CHECK(ended == 0);
}

TEST_CASE("who was let in by a process that ends before it greets hears of the end", "[R27]") {
  auto door = std::make_unique<Doorman>();
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  watch.watch(door->address, kWatcher, [&] { ++ended; });
  // The kernel closes an ending process's connections and listener in any order.
  { const FileDescriptor closed_first = door->let_in(); }
  pollfd look{door->socket.get(), POLLIN, 0};
  REQUIRE(eventually([&] { return poll(&look, 1, 0) == 1; }));
  CHECK(ended == 0);
  door.reset();
  CHECK(eventually([&] { return ended == 1; }));
}

TEST_CASE("who was not let in yet hears of the process's end, too", "[R27]") {
  auto door = std::make_unique<Doorman>();
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  watch.watch(door->address, kWatcher, [&] { ++ended; });
  CHECK(ended == 0);
  door.reset();
  CHECK(eventually([&] { return ended == 1; }));
}

TEST_CASE("one process has so many connections to another, which has room for others beside it",
          "[R27]") {
  ProcessWatch own;
  const std::string address = own.open(kParticipant);
  const Child other(address);  // first: a child has copies of its parent's descriptors
  CHECK(eventually([&] { return own.counters().watchers == 1; }));

  constexpr std::size_t kMore = 10;
  auto many = connections_to(address, ProcessWatch::kMaxWatchersOfOne + kMore);
  CHECK(eventually([&] { return own.counters().refused == kMore; }));
  CHECK(own.counters().watchers == ProcessWatch::kMaxWatchersOfOne + 1);

  many.clear();
  CHECK(eventually([&] { return own.counters().watchers == 1; }));
  const auto again = connections_to(address, 1);
  CHECK(eventually([&] { return own.counters().watchers == 2; }));
}

TEST_CASE("a process watches so many others", "[R27]") {
  const std::vector<Doorman> doors(ProcessWatch::kMaxWatched + 1);
  ProcessWatch watch;
  for (const Doorman& door : doors) watch.watch(door.address, kWatcher, [] {});
  CHECK(watch.counters().watched == ProcessWatch::kMaxWatched);
}

TEST_CASE("a process without a free descriptor waits for one in peace, and hears of others' ends",
          "[R27]") {
  constexpr rlim_t kDescriptors = 64;
  Child watched;
  const bool greets = GENERATE(true, false);
  CAPTURE(greets);
  if (!greets) kill(watched.pid, SIGSTOP);
  Child full(watched.address, [] {
    const rlimit limit{kDescriptors, kDescriptors};
    REQUIRE(setrlimit(RLIMIT_NOFILE, &limit) == 0);
  });
  auto crowd = connections_to(full.address, kDescriptors + 36);
  REQUIRE(eventually([&] { return full.descriptors() >= kDescriptors; }));

  CHECK(eventually([&] { return full.asleep(); }));

  CHECK_FALSE(full.heard_of_an_end());
  watched.end();
  CHECK(eventually([&] { return full.heard_of_an_end(); }));

  ProcessWatch late;
  std::atomic<int> ended = 0;
  late.watch(full.address, kWatcher, [&] { ++ended; });
  SECTION("while it is full") {}
  SECTION("once it is not") {
    crowd.clear();
    CHECK(eventually([&] { return full.descriptors() < kDescriptors / 2; }));
  }
  CHECK(ended == 0);
  full.end();
  CHECK(eventually([&] { return ended == 1; }));
}

TEST_CASE("another user's process is turned away, and does not take it for an end", "[R27]") {
  if (geteuid() != 0) {
    WARN("skipped: only root can become another user");
    return;
  }
  ProcessWatch own;
  const std::string address = own.open(kParticipant);
  Child foreign(address, [] { REQUIRE(setuid(65534) == 0); });
  // Its own side of the connection does not trust root either; this is what a rogue would do.
  std::atomic<int> ended = 0;
  own.watch(foreign.address, kWatcher, [&] { ++ended; });
  CHECK(own.counters().watched == 0);
  CHECK(own.counters().watchers == 0);
  foreign.end();
  CHECK(ended == 0);
}

TEST_CASE("another user's crowd takes no descriptor, and no room from others", "[R27]") {
  if (geteuid() != 0) {
    WARN("skipped: only root can become another user");
    return;
  }
  ProcessWatch own;
  const std::string address = own.open(kParticipant);
  constexpr std::size_t kCrowd = 40;
  Child crowd({}, [&] {
    REQUIRE(setuid(65534) == 0);
    static std::vector<FileDescriptor> connections = connections_to(address, kCrowd);
  });
  CHECK(eventually([&] { return own.counters().refused == kCrowd; }));
  CHECK(own.counters().watchers == 0);
  const Child good(address);
  CHECK(eventually([&] { return own.counters().watchers == 1; }));
}

TEST_CASE("what another user hands over is closed by a thread that nobody waits for", "[R27]") {
  if (geteuid() != 0) {
    WARN("skipped: only root can become another user");
    return;
  }
  ProcessWatch own;
  const std::string address = own.open(kParticipant);
  const Child stranger({}, [&] {
    REQUIRE(setuid(kAnother) == 0);
    static LingeringConnection lingering;
    const auto connect = [&] { return std::move(connections_to(address, 1).front()); };
    REQUIRE(lingering.hand_over_to_refuser(connect));
  });
  Child good;
  std::atomic<int> ended = 0;
  CHECK(skein::test::returns_at_once([&] { own.watch(good.address, kWatcher, [&] { ++ended; }); }));
  good.end();
  CHECK(eventually([&] { return ended == 1; }));
}

TEST_CASE("who is not mapped into a process's user namespace may not watch it", "[R27]") {
  // The kernel shows both users by one number there.
  const Child inside({}, [] {
    if (unshare(CLONE_NEWUSER) != 0) _exit(1);
  });
  if (inside.address.empty()) {
    WARN("skipped: this process may not make a user namespace");
    return;
  }
  const auto connections = connections_to(inside.address, 1);
  char octet;
  ssize_t size = -1;
  CHECK(eventually([&] {
    size = recv(connections.front().get(), &octet, 1, MSG_DONTWAIT);
    return size >= 0;
  }));
  CHECK(size == 0);
}
