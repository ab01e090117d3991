#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <random>

#include "../tools/eventually.hpp"
#include "../tools/invariant.hpp"
#include "../tools/log.hpp"
#include "../tools/seed.hpp"
#include "core/abstract_socket.hpp"
#include "echo_service.hpp"
#include "rpc/wire.hpp"
#include "same_host/link.hpp"
#include "skein/entity.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using same_host::Link;
using same_host::RingState;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

/// What the test and the process that attacks it tell each other.
struct Shared {
  std::atomic<bool> begin{false};
  std::atomic<bool> end{false};
  std::atomic<std::uint64_t> rounds{0};
  Guid provider;
};

std::unique_ptr<Entity> make_entity(const std::string& name) {
  EntityOptions options;
  options.name = name;
  options.vendor = dds::load_vendor("loopback");
  options.domain = 19;
  options.shared_memory_calls = true;
  return std::make_unique<Entity>(std::move(options));
}

/// A client that joins as it should, and then writes what it likes into the memory it was given.
class Attacker {
 public:
  Attacker(const Guid& provider, std::uint64_t seed) : provider_(provider), random_(seed) {}

  void attack() {
    const Guid client = Guid::random();
    const FileDescriptor socket = local_socket(SOCK_SEQPACKET);
    if (connect_to(socket, "skein-call/" + provider_.hex()) != Reached::Yes) return;
    const FileDescriptor descriptor = handed_over(socket, client);
    if (!descriptor) return;
    void* const mapped =
        mmap(nullptr, Link::kMemory, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor.get(), 0);
    if (mapped == MAP_FAILED) return;
    memory_ = static_cast<std::byte*>(mapped);
    send(open_request(client));
    for (std::uint64_t number = 1; number < 40; ++number) {
      if (chance(2)) send(request(client, number));
      if (chance(3)) damage();
      eat_replies();
      look_alive();
    }
    munmap(mapped, Link::kMemory);
  }

 private:
  bool chance(std::uint64_t one_in) { return random_() % one_in == 0; }

  static FileDescriptor handed_over(const FileDescriptor& socket, const Guid& client) {
    std::array<char, 24> hello{"skein1"};
    std::memcpy(hello.data() + 8, client.bytes.data(), client.bytes.size());
    if (::send(socket.get(), hello.data(), hello.size(), MSG_NOSIGNAL) < 0) return {};
    pollfd answered{socket.get(), POLLIN, 0};
    poll(&answered, 1, 20'000);
    char packet[128];
    iovec content{packet, sizeof packet};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    msghdr message{};
    message.msg_iov = &content;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    if (recvmsg(socket.get(), &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC) < 0) return {};
    const cmsghdr* const header = CMSG_FIRSTHDR(&message);
    if (header == nullptr) return {};
    int number = -1;
    std::memcpy(&number, CMSG_DATA(header), sizeof number);
    return FileDescriptor(number);
  }

  static Bytes open_request(const Guid& client) {
    Bytes message;
    rpc::wire::begin_request(message, {client, 0}, rpc::wire::kOpen);
    rpc::wire::append_default_branch(message);
    rpc::wire::append_trailer(message, rpc::wire::RequestTrailer{10s});
    return message;
  }

  /// Not one that takes as long as its arguments say.
  std::uint32_t any_operation() {
    const auto& operations = LouderEcho::interface_info().operations;
    while (true) {
      const auto& operation = operations[random_() % operations.size()];
      if (operation.name != "wait" && operation.name != "who") return operation.hash;
    }
  }

  // One in two is as it should be, but for its arguments.
  Bytes request(const Guid& client, std::uint64_t number) {
    Bytes message;
    rpc::wire::begin_request(message, {client, number}, any_operation());
    for (std::uint64_t i = random_() % 64; i > 0; --i) {
      const auto octet = static_cast<std::byte>(chance(2) ? 0 : random_());
      message.append({&octet, 1});
    }
    rpc::wire::append_trailer(message, rpc::wire::RequestTrailer{chance(2) ? 1s : 1ms});
    if (chance(2)) {
      for (int i = 0; i < 4; ++i)
        message.data()[random_() % message.size()] = static_cast<std::byte>(random_());
    }
    return message;
  }

  RingState& state(int which) { return reinterpret_cast<RingState*>(memory_)[which]; }
  std::byte* content(int which) {
    return memory_ + (Link::kMemory - 2 * Link::kCapacity) +
           static_cast<std::size_t>(which) * Link::kCapacity;
  }

  void send(const Bytes& message) {
    RingState& ring = state(0);
    const std::uint64_t at = written_;
    const std::size_t frame = 8 + ((message.size() + 7) & ~std::size_t{7});
    if (at % Link::kCapacity + frame > Link::kCapacity) return;
    std::byte* const place = content(0) + at % Link::kCapacity;
    const std::uint64_t header = std::uint64_t{3} << 32 | message.size();
    std::memcpy(place + 8, message.data(), message.size());
    std::memcpy(place, &header, sizeof header);
    written_ += frame;
    ring.written = written_;
    ring.reader_sleeps = 0;
    same_host::futex_wake(ring.reader_sleeps);
  }

  /// Of all that both sides read: positions, words, headers, content.
  void damage() {
    const int which = static_cast<int>(random_() % 2);
    RingState& ring = state(which);
    switch (random_() % 7) {
      case 0:
        ring.written += random_() % 8 * 8;
        break;
      case 1:
        ring.written = random_();
        break;
      case 2:
        ring.read = chance(2) ? random_() : ring.read + 8 * (random_() % 64);
        break;
      case 3:
        ring.reader_sleeps = static_cast<std::uint32_t>(random_() % 3);
        break;
      case 4:
        ring.writer_sleeps = static_cast<std::uint32_t>(random_());
        break;
      case 5:  // again and again, while the other side reads
        for (int i = 0; i < 2000; ++i) scribble(which);
        break;
      default:
        scribble(which);
    }
    same_host::futex_wake(ring.reader_sleeps);
    same_host::futex_wake(ring.writer_sleeps);
  }

  void scribble(int which) {
    const std::uint64_t value = chance(2) ? random_() : (random_() % 6) << 32 | random_() % 256;
    std::memcpy(content(which) + random_() % 512 * 8, &value, sizeof value);
  }

  void eat_replies() {
    RingState& ring = state(1);
    if (!chance(3)) ring.read = ring.written.load();
    ring.writer_sleeps = 0;
    same_host::futex_wake(ring.writer_sleeps);
  }

  // So that some of it comes while the other side looks.
  static void look_alive() { sched_yield(); }

  const Guid provider_;
  std::mt19937_64 random_;
  std::byte* memory_ = nullptr;
  std::uint64_t written_ = 0;
};

/// A process that attacks until it is told to end. Forked before this one has threads.
class AttackingProcess {
 public:
  explicit AttackingProcess(std::uint64_t seed) {
    void* const memory =
        mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    REQUIRE(memory != MAP_FAILED);
    shared_ = new (memory) Shared;
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    while (!shared_->begin) sched_yield();
    for (std::uint64_t round = 0; !shared_->end; ++round) {
      Attacker attacker(shared_->provider, seed + round);
      attacker.attack();
      ++shared_->rounds;
    }
    _exit(0);
  }
  ~AttackingProcess() {
    stop();
    munmap(shared_, sizeof(Shared));
  }
  AttackingProcess(const AttackingProcess&) = delete;
  AttackingProcess& operator=(const AttackingProcess&) = delete;

  void begin(const Guid& provider) {
    shared_->provider = provider;
    shared_->begin = true;
  }
  std::uint64_t rounds() const { return shared_->rounds; }

  /// How it ended.
  int stop() {
    int status = -1;
    shared_->begin = true;
    shared_->end = true;
    if (pid_ > 0) waitpid(pid_, &status, 0);
    pid_ = 0;
    return status;
  }

 private:
  Shared* shared_ = nullptr;
  pid_t pid_ = 0;
};

std::ptrdiff_t open_descriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                       std::filesystem::directory_iterator{});
}

int mapped_rings() {
  std::ifstream maps("/proc/self/maps");
  int count = 0;
  for (std::string line; std::getline(maps, line);) count += line.find("memfd:skein") != line.npos;
  return count;
}

}  // namespace

TEST_CASE(
    "a process that writes anything into the memory it shares harms neither provider nor others") {
  const std::uint64_t seed = seed_of_this_run();
  AttackingProcess attacker(seed);
  const Log log;
  const auto server = make_entity("server");
  ServiceOptions service;
  if (GENERATE(false, true)) service.thread = CallThread::Caller;
  const Guid provider = server->provide<LouderEcho>(std::make_shared<EchoService>(), service);
  const auto client = make_entity("client");
  auto echo = client->connect<Echo>();
  REQUIRE(echo.echo("first") == "first");
  REQUIRE(mapped_rings() == 2);  // one at each end, both in this process
  const auto descriptors = open_descriptors();

  attacker.begin(provider);
  constexpr std::uint64_t kRounds = 150;
  std::uint64_t answered = 0;
  REQUIRE(eventually([&] {
    const std::string text = std::to_string(++answered);
    INVARIANT(echo.within(20s).echo(text) == text);
    return attacker.rounds() >= kRounds;
  }));
  CHECK(attacker.stop() == 0);
  CHECK(client->connector().connections().front().transport == "shared memory");
  CHECK(log.count("has damaged the memory that it shares") > 10);
  CHECK(eventually([&] { return mapped_rings() == 2; }));
  CHECK(eventually([&] { return open_descriptors() == descriptors; }));
}
