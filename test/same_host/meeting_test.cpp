#include "same_host/meeting.hpp"

#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/system/abstract_socket.hpp"
#include "same_host/doorbell.hpp"
#include "same_host/pass_descriptor.hpp"
#include "skein/error.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/lingering_connection.hpp"
#include "test/tools/log.hpp"
#include "test/tools/threads.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using skein::test::threads_named;
using namespace std::chrono_literals;

namespace {

/// Another endpoint of the participant that has this one.
Guid beside(const Guid& endpoint) {
  Guid other = endpoint;
  other.bytes.back() ^= 1;
  return other;
}

std::string address_of(const Guid& provider) { return "skein-call/" + provider.hex(); }

/// A provider that keeps its guests.
struct Host {
  explicit Host(Meeting::Rules rules = {}, const Guid& id = Guid::random())
      : Host(std::move(rules), id, beside(id)) {}
  Host(Meeting::Rules rules, const Guid& id, const Guid& endpoint)
      : provider(id), server(endpoint), meeting(std::move(rules)) {
    meeting.offer(
        provider, server, [] {},
        [this](std::shared_ptr<Link> link) {
          std::lock_guard lock(mutex);
          guests.push_back(std::move(link));
        });
  }
  ~Host() { meeting.withdraw(provider); }

  std::shared_ptr<Link> guest(std::size_t which) {
    std::lock_guard lock(mutex);
    return which < guests.size() ? guests[which] : nullptr;
  }

  const Guid provider;
  const Guid server;
  std::mutex mutex;
  std::vector<std::shared_ptr<Link>> guests;
  Meeting meeting;  // last: its thread goes first
};

Instant soon() { return std::chrono::steady_clock::now() + 20s; }

std::vector<std::byte> octets(std::size_t size) {
  return std::vector<std::byte>(size, std::byte{7});
}

std::size_t open_descriptors() {
  return static_cast<std::size_t>(std::distance(
      std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator{}));
}

/// One who connects and does not keep to what is said there.
FileDescriptor stranger(const Guid& provider) {
  FileDescriptor socket = local_socket(SOCK_SEQPACKET);
  connect_to(socket, address_of(provider));
  return socket;
}

/// What a client says first.
std::array<char, 24> hello_of(const Guid& client) {
  std::array<char, 24> hello{"skein4"};
  std::memcpy(hello.data() + 8, client.bytes.data(), client.bytes.size());
  return hello;
}

/// A process that runs `action` once it is told to. Made before this one has threads, whose locks
/// nobody would release in the new process.
class Forked {
 public:
  template <class Action>
  explicit Forked(Action action) {
    // Tests before have threads left that close what they were handed.
    REQUIRE(eventually([] { return test::threads_named("skein-closing").empty(); }));
    REQUIRE(pipe(go_) == 0);
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    alarm(60);
    char octet;
    _exit(read(go_[0], &octet, 1) == 1 ? action() : 98);
  }
  ~Forked() { end(); }
  Forked(const Forked&) = delete;
  Forked& operator=(const Forked&) = delete;

  pid_t pid() const { return pid_; }
  void start() { REQUIRE(write(go_[1], "x", 1) == 1); }
  /// Starts it; what it exits with.
  int run() {
    start();
    int status = 0;
    waitpid(std::exchange(pid_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 97;
  }
  void end() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(std::exchange(pid_, 0), nullptr, 0);
    }
    for (int& each : go_) close(std::exchange(each, -1));
  }

 private:
  int go_[2];
  pid_t pid_ = 0;
};

constexpr uid_t kAnother = 12'345;
template <class Action>
auto as_another_user(Action action) {
  return [action] { return setresuid(kAnother, kAnother, kAnother) == 0 ? action() : 99; };
}

bool hung_up(const FileDescriptor& socket) {
  char octet;
  return eventually([&] {
    const auto size = recv(socket.get(), &octet, 1, MSG_DONTWAIT);
    return size == 0 || (size < 0 && errno == ECONNRESET);
  });
}

}  // namespace

TEST_CASE("a client that joins a provider exchanges messages with it both ways") {
  Host host;
  Meeting meeting;
  const Guid client = Guid::random();
  const auto link = meeting.join(host.provider, client, [] {});
  CHECK(link->own() == client);
  CHECK(link->peer() == host.server);
  REQUIRE(eventually([&] { return host.guest(0) != nullptr; }));
  const auto guest = host.guest(0);
  CHECK(guest->peer() == client);
  for (const auto& [from, to] : {std::pair(link, guest), std::pair(guest, link)}) {
    REQUIRE(from->out().send(octets(1000), 20s) == LinkWriter::Sent::Yes);
    Bytes spare;
    const auto message = to->in().receive(spare);
    REQUIRE(message);
    CHECK(message->size() == 1000);
    to->in().release(spare);
    CHECK(from->out().await_taken(soon()));
  }
}

TEST_CASE(
    "whichever side closes a link, the other one is told, and can take what was sent before") {
  Host host;
  Meeting meeting;
  std::atomic<int> told = 0;
  auto link = meeting.join(host.provider, Guid::random(), [&] { ++told; });
  REQUIRE(eventually([&] { return host.guest(0) != nullptr; }));
  const auto guest = host.guest(0);
  const bool by_client = GENERATE(false, true);
  auto& closing = by_client ? link : guest;
  auto& other = by_client ? guest : link;
  REQUIRE(closing->out().send(octets(10), 20s) == LinkWriter::Sent::Yes);
  closing->close();
  CHECK(eventually([&] { return other->ended(); }));
  CHECK(eventually([&] { return told == 1; }));
  Bytes spare;
  CHECK(other->in().receive(spare));
  CHECK(other->out().send(octets(10), 20s) == LinkWriter::Sent::Ended);
  CHECK(eventually([&] { return host.meeting.counters().guests == 0; }));
}

TEST_CASE("a signal that interrupts the meeting's thread is nobody's end") {
  struct sigaction ignoring {};
  struct sigaction before {};
  ignoring.sa_handler = [](int) {};
  REQUIRE(sigaction(SIGUSR1, &ignoring, &before) == 0);
  Host host;
  const auto wake_ups = [&] { return host.meeting.counters().wake_ups; };
  REQUIRE(eventually([&] { return threads_named("skein-meeting").size() == 1; }));
  for (int i = 0; i < 3; ++i) {
    const auto earlier = wake_ups();
    REQUIRE(eventually([&] {
      syscall(SYS_tgkill, getpid(), threads_named("skein-meeting").at(0), SIGUSR1);
      return wake_ups() > earlier;
    }));
  }
  Meeting meeting;
  CHECK(meeting.join(host.provider, Guid::random(), [] {}));
  sigaction(SIGUSR1, &before, nullptr);
}

TEST_CASE("a link ends with the process at its other end, also one that is killed") {
  const Guid provider = Guid::random();
  Forked client([&] {
    Meeting meeting;
    std::shared_ptr<Link> link;
    eventually([&] {
      try {
        link = meeting.join(provider, Guid::random(), [] {});
      } catch (const Unavailable&) {
      }
      return link != nullptr;
    });
    return pause();
  });
  Host host({}, provider);
  client.start();
  REQUIRE(eventually([&] { return host.guest(0) != nullptr; }));
  CHECK_FALSE(host.guest(0)->ended());
  client.end();
  CHECK(eventually([&] { return host.guest(0)->ended(); }));
}

TEST_CASE("who waits for room is let go when the other side ends") {
  Host host;
  Meeting meeting;
  const auto link = meeting.join(host.provider, Guid::random(), [] {});
  REQUIRE(eventually([&] { return host.guest(0) != nullptr; }));
  std::atomic<bool> waits = false;
  auto sent = LinkWriter::Sent::Yes;
  std::thread writer([&] {
    waits = true;
    sent = link->out().send(octets(4 * Link::kCapacity), 1h);
  });
  REQUIRE(eventually([&] { return waits.load(); }));
  host.guest(0)->close();
  writer.join();
  CHECK(sent == LinkWriter::Sent::Ended);
}

TEST_CASE("nobody, and another user, are refused with the reason") {
  Meeting meeting;
  const auto refused = [&](Meeting& by, const Guid& provider, const std::string& why) {
    CHECK_THROWS_AS(by.join(provider, Guid::random(), [] {}), Unavailable);
    CHECK_THROWS_WITH(by.join(provider, Guid::random(), [] {}), Catch::Contains(why));
  };
  refused(meeting, Guid::random(), "nobody offers one");
  Host host;
  Meeting::Rules of_others;
  of_others.users = {geteuid() + 1};
  Meeting wary(of_others);
  refused(wary, host.provider, "another user offers it");
  Host closed(of_others);
  refused(meeting, closed.provider, "the provider turned it away");
  CHECK(closed.meeting.counters().guests == 0);
  CHECK(closed.meeting.counters().refused >= 2);
}

TEST_CASE("a provider of another version is called one") {
  const Guid provider = Guid::random();
  const FileDescriptor listening = local_socket(SOCK_SEQPACKET);
  REQUIRE(listen_at(listening, address_of(provider)));
  std::thread answering([&] {
    const auto await = [](int socket) {
      pollfd readable{socket, POLLIN, 0};
      return poll(&readable, 1, 20000) == 1;
    };
    if (!await(listening.get())) return;
    const FileDescriptor client = accept_at(listening.get());
    char hello[64];
    if (!await(client.get()) || recv(client.get(), hello, sizeof hello, 0) < 0) return;
    const std::array<char, 128> answer{"skein9"};
    send(client.get(), answer.data(), answer.size(), MSG_NOSIGNAL);
  });
  Meeting meeting;
  CHECK_THROWS_WITH(meeting.join(provider, Guid::random(), [] {}),
                    Catch::Contains("the two sides are of different versions"));
  answering.join();
}

TEST_CASE("there is room for so many connections, and the next one is told so") {
  Meeting::Rules rules;
  rules.guests = 2;
  Host host(rules);
  Meeting meeting;
  const auto join = [&] { return meeting.join(host.provider, Guid::random(), [] {}); };
  auto one = join();
  const auto other = join();
  CHECK_THROWS_WITH(join(), Catch::Contains("it has 2 connections of this kind already"));
  one->close();
  CHECK(eventually([&] { return host.meeting.counters().guests == 1; }));
  CHECK_NOTHROW(join());
}

TEST_CASE("a process has its share of the connections, and the log tells once who wants more") {
  const Guid provider = Guid::random();
  Forked another([&] {
    const FileDescriptor socket = stranger(provider);
    const auto hello = hello_of(Guid::random());
    char answer[128] = {};
    const FileDescriptor doorbell = make_doorbell();
    pass(socket.get(), std::as_bytes(std::span(hello)), {doorbell.get()});
    pollfd answered{socket.get(), POLLIN, 0};
    poll(&answered, 1, 20'000);
    return recv(socket.get(), answer, sizeof answer, 0) == sizeof answer && answer[24] == 0 ? 0 : 1;
  });
  const skein::test::Log log;
  Meeting::Rules rules;
  rules.guests_of_process = 2;
  Host host(rules, provider);
  Meeting meeting;
  const auto join = [&] { return meeting.join(provider, Guid::random(), [] {}); };
  auto one = join();
  const auto other = join();
  for (int i = 0; i < 3; ++i) {
    CHECK_THROWS_WITH(
        join(), Catch::Contains("has its share of connections of this kind already (at most 2)"));
  }
  CHECK(eventually([&] { return log.count("wants more than its share of 2 connections") == 1; }));
  CHECK(another.run() == 0);  // it has a share of its own
  one->close();
  CHECK(eventually([&] {
    try {
      return join() != nullptr;
    } catch (const Unavailable&) {
      return false;
    }
  }));
}

TEST_CASE("another user is turned away whichever side he is on, and told of in the log once") {
  if (geteuid() != 0) {
    WARN("not shown: only root can become another user");
    return;
  }
  const Guid provider = Guid::random();
  const Guid claimed = Guid::random();
  const auto turned_away = as_another_user([&] {
    const FileDescriptor socket = stranger(provider);
    pollfd answered{socket.get(), POLLIN, 0};
    char octet;
    poll(&answered, 1, 20'000);
    return recv(socket.get(), &octet, 1, MSG_DONTWAIT) <= 0 ? 0 : 1;
  });
  Forked first(turned_away);
  Forked second(turned_away);
  int ready[2];
  REQUIRE(pipe(ready) == 0);
  Forked offering(as_another_user([&] {
    const FileDescriptor listening = local_socket(SOCK_SEQPACKET);
    if (!listen_at(listening, address_of(claimed)) || write(ready[1], "x", 1) != 1) return 1;
    return pause();
  }));
  const skein::test::Log log;
  Host host({}, provider);
  CHECK(first.run() == 0);
  CHECK(second.run() == 0);
  CHECK(host.meeting.counters().guests == 0);
  CHECK(eventually([&] { return log.count("of user 12345 is turned away") == 1; }));

  Meeting meeting;
  offering.start();
  close(ready[1]);
  char octet;
  CHECK(read(ready[0], &octet, 1) == 1);
  close(ready[0]);
  CHECK_THROWS_WITH(meeting.join(claimed, Guid::random(), [] {}),
                    Catch::Contains("another user offers it"));
}

TEST_CASE("what another user hands over is closed by a thread that nobody waits for") {
  if (geteuid() != 0) {
    WARN("not shown: only root can become another user");
    return;
  }
  const Guid provider = Guid::random();
  int ready[2];
  REQUIRE(pipe(ready) == 0);
  Forked another(as_another_user([&] {
    test::LingeringConnection lingering;
    const bool done = lingering.hand_over_to_refuser([&] { return stranger(provider); });
    return write(ready[1], done ? "y" : "n", 1) == 1 ? pause() : 1;
  }));
  Host host({}, provider);
  another.start();
  char done = 0;
  REQUIRE(read(ready[0], &done, 1) == 1);
  CHECK(done == 'y');
  for (const int each : ready) close(each);
  Meeting meeting;
  CHECK_NOTHROW(meeting.join(provider, Guid::random(), [] {}));
}

TEST_CASE("what a client hands over is closed by a thread that nobody waits for") {
  Host host;
  test::LingeringConnection with_hello;
  test::LingeringConnection unread;
  const auto hello = hello_of(Guid::random());
  {
    const FileDescriptor socket = stranger(host.provider);
    REQUIRE(with_hello.hand_over(socket.get(), std::string(hello.data(), hello.size())));
    REQUIRE(eventually([&] { return host.meeting.counters().refused == 1; }));  // no doorbell
  }
  {
    const FileDescriptor socket = stranger(host.provider);
    const FileDescriptor doorbell = make_doorbell();
    REQUIRE(pass(socket.get(), std::as_bytes(std::span(hello)), {doorbell.get()}));
    REQUIRE(eventually([&] { return host.guest(0) != nullptr; }));
    REQUIRE(unread.hand_over(socket.get()));
  }
  CHECK(eventually([&] { return host.meeting.counters().guests == 0; }));
  CHECK(test::returns_at_once([&] {
    std::lock_guard lock(host.mutex);
    host.guests.clear();
  }));
  Meeting meeting;
  CHECK_NOTHROW(meeting.join(host.provider, Guid::random(), [] {}));
  with_hello.release();
  unread.release();
}

TEST_CASE(
    "a link ends with the process at its other end, though a child has copies of its socket") {
  int keeps[2];
  REQUIRE(pipe(keeps) == 0);
  const auto leave_a_child = [&] {
    close(keeps[1]);
    char octet;
    if (fork() == 0) _exit(static_cast<int>(read(keeps[0], &octet, 1)));
    return pause();
  };
  const Guid here = Guid::random();
  const Guid there = Guid::random();
  Forked client([&] {
    Meeting meeting;
    const auto link = meeting.join(here, Guid::random(), [] {});
    return leave_a_child();
  });
  Forked provider([&] {
    Host host({}, there);
    eventually([&] { return host.guest(0) != nullptr; });
    return leave_a_child();
  });
  const auto has_child = [](pid_t pid) {
    const std::string number = std::to_string(pid);
    std::ifstream file("/proc/" + number + "/task/" + number + "/children");
    return static_cast<bool>(file >> pid);
  };
  std::shared_ptr<Link> link;
  SECTION("the client's") {
    Host host({}, here);
    client.start();
    REQUIRE(eventually([&] { return has_child(client.pid()); }));
    link = host.guest(0);
    REQUIRE(link);
    CHECK_FALSE(link->ended());
    client.end();
    CHECK(eventually([&] { return link->ended(); }));
    CHECK(eventually([&] { return host.meeting.counters().guests == 0; }));
  }
  SECTION("the provider's") {
    provider.start();
    Meeting meeting;
    REQUIRE(eventually([&] {
      try {
        link = meeting.join(there, Guid::random(), [] {});
      } catch (const Unavailable&) {
      }
      return link != nullptr;
    }));
    REQUIRE(eventually([&] { return has_child(provider.pid()); }));
    CHECK_FALSE(link->ended());
    provider.end();
    CHECK(eventually([&] { return link->ended(); }));
  }
  for (const int each : keeps) close(each);
}

TEST_CASE("a user that is not mapped is no process's own, though the kernel shows one number") {
  const Guid provider = Guid::random();
  int ready[2];
  REQUIRE(pipe(ready) == 0);
  Forked inside([&] {
    const bool made = unshare(CLONE_NEWUSER) == 0;
    const Host host({}, provider);
    if (write(ready[1], made ? "y" : "n", 1) != 1) return 1;
    return pause();
  });
  inside.start();
  char made = 0;
  REQUIRE(read(ready[0], &made, 1) == 1);
  for (const int each : ready) close(each);
  if (made == 'n') {
    WARN("not shown: this process may not make a user namespace");
    return;
  }
  Meeting meeting;
  CHECK_THROWS_WITH(meeting.join(provider, Guid::random(), [] {}),
                    Catch::Contains("the provider turned it away"));
}

TEST_CASE("who answers under a provider's name as another participant is refused") {
  const Guid provider = Guid::random();
  Host host({}, provider, Guid::random());
  Meeting meeting;
  CHECK_THROWS_WITH(meeting.join(provider, Guid::random(), [] {}),
                    Catch::Contains("another participant answers under the provider's name"));
  CHECK(eventually([&] { return host.meeting.counters().guests == 0; }));
}

TEST_CASE("many clients that come at once are all let in") {
  Host host;
  Meeting meeting;
  std::atomic<int> joined = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 40; ++i) {
    clients.emplace_back([&] {
      const auto link = meeting.join(host.provider, Guid::random(), [] {});
      ++joined;
    });
  }
  for (auto& client : clients) client.join();
  CHECK(joined == 40);
  CHECK(host.meeting.counters().refused == 0);
}

TEST_CASE("a client's identity is let in once") {
  Host host;
  Meeting meeting;
  const Guid client = Guid::random();
  const auto link = meeting.join(host.provider, client, [] {});
  CHECK_THROWS_WITH(meeting.join(host.provider, client, [] {}),
                    Catch::Contains("that client is here already"));
}

TEST_CASE("a stranger who says nothing is put out after a while, and few may wait so") {
  Meeting::Rules rules;
  rules.newcomers = 4;
  rules.patience = 200ms;
  Host host(rules);
  std::vector<FileDescriptor> silent;
  for (int i = 0; i < 20; ++i) silent.push_back(stranger(host.provider));
  CHECK(eventually([&] { return host.meeting.counters().newcomers > 0; }));
  CHECK(host.meeting.counters().newcomers <= 4);
  CHECK(hung_up(silent.front()));
  CHECK(eventually([&] { return host.meeting.counters().refused >= 20; }));
  silent.clear();
  Meeting meeting;
  CHECK_NOTHROW(meeting.join(host.provider, Guid::random(), [] {}));
}

TEST_CASE("a stranger who says what nobody says is put out") {
  Host host;
  const std::string said = GENERATE(as<std::string>(), "x", std::string(23, 'a'),
                                    std::string(24, 'a'), std::string(4000, 'b'));
  const auto socket = stranger(host.provider);
  REQUIRE(send(socket.get(), said.data(), said.size(), MSG_NOSIGNAL) ==
          static_cast<ssize_t>(said.size()));
  char answer[256];
  if (eventually([&] { return recv(socket.get(), answer, sizeof answer, MSG_DONTWAIT) > 24; },
                 50ms)) {
    CHECK(std::string(answer + 24) == "the two sides are of different versions");
  }
  CHECK(hung_up(socket));
  CHECK(host.meeting.counters().guests == 0);
  Meeting meeting;
  CHECK_NOTHROW(meeting.join(host.provider, Guid::random(), [] {}));
}

// What a loaded machine makes slower only makes it wake up less often.
TEST_CASE("a stranger who comes again and again costs some wake-ups a second, whatever it does") {
  Meeting::Rules rules;
  rules.users = {};
  const skein::test::Log log;
  Host host(rules);
  const auto begin = std::chrono::steady_clock::now();
  const auto before = host.meeting.counters();
  std::size_t attempts = 0;
  while (host.meeting.counters().refused < before.refused + 100) {
    stranger(host.provider);
    ++attempts;
  }
  const auto pauses = (std::chrono::steady_clock::now() - begin) / 10ms + 1;
  CHECK(attempts >= 100);
  CHECK(host.meeting.counters().wake_ups - before.wake_ups <=
        static_cast<std::uint64_t>(3 * pauses + 3));
  CHECK(log.count("is turned away") == 1);
}

TEST_CASE("a provider that hands over what can be taken away again is refused") {
  const Guid provider = Guid::random();
  FileDescriptor listening = local_socket(SOCK_SEQPACKET);
  REQUIRE(listen_at(listening, address_of(provider)));
  std::thread liar([&] {
    FileDescriptor accepted;
    eventually([&] {
      accepted = FileDescriptor(accept(listening.get(), nullptr, nullptr));
      return static_cast<bool>(accepted);
    });
    const FileDescriptor memory(memfd_create("test", MFD_CLOEXEC));
    const int number = memory.get();
    char packet[128];
    eventually([&] { return recv(accepted.get(), packet, sizeof packet, MSG_DONTWAIT) > 0; });
    std::memset(packet, 0, sizeof packet);
    std::strcpy(packet, "skein4");
    std::memcpy(packet + 8, provider.bytes.data(), provider.bytes.size());
    iovec content{packet, sizeof packet};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof number)] = {};
    msghdr message{};
    message.msg_iov = &content;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof number);
    std::memcpy(CMSG_DATA(header), &number, sizeof number);
    sendmsg(accepted.get(), &message, MSG_NOSIGNAL);
  });
  Meeting meeting;
  CHECK_THROWS_WITH(meeting.join(provider, Guid::random(), [] {}),
                    Catch::Contains("is not sealed"));
  liar.join();
}

TEST_CASE("nothing is left of links that have ended") {
  Host host;
  Meeting meeting;
  const std::size_t before = open_descriptors();
  for (std::size_t i = 0; i < 30; ++i) {
    const auto link = meeting.join(host.provider, Guid::random(), [] {});
    REQUIRE(eventually([&] { return host.guest(0) != nullptr; }));
    std::lock_guard lock(host.mutex);
    host.guests.clear();
  }
  CHECK(eventually([&] { return open_descriptors() <= before; }));
  CHECK(eventually([&] { return host.meeting.counters().guests == 0; }));
}
