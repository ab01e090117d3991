#include <fcntl.h>
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
#include <functional>
#include <map>
#include <new>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/system/abstract_socket.hpp"
#include "frames.idl.hpp"
#include "rpc/wire/wire.hpp"
#include "same_host/doorbell.hpp"
#include "same_host/link.hpp"
#include "same_host/pass_descriptor.hpp"
#include "skein/loaned.hpp"
#include "test/connector/echo_pair.hpp"
#include "test/connector/loopback_entity.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/invariant.hpp"
#include "test/tools/log.hpp"
#include "test/tools/seed.hpp"

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

/// A side of a connection that writes what it likes into the memory that both share.
class Attacker {
 public:
  /// `out`: the ring that it writes to, 0 for requests and 1 for replies.
  Attacker(std::uint64_t seed, int out) : random_(seed), out_(out) {}

  /// What the other side is handed as a doorbell: mostly one, at times the test's memory or
  /// nothing.
  int doorbell(const FileDescriptor& otherwise) {
    if (!chance(8)) return doorbell_.get();
    return chance(2) ? otherwise.get() : -1;
  }

 protected:
  bool chance(std::uint64_t one_in) { return random_() % one_in == 0; }
  std::uint64_t random() { return random_(); }

  bool map(const FileDescriptor& descriptor) {
    void* const mapped =
        mmap(nullptr, Link::kMemory, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor.get(), 0);
    memory_ = mapped == MAP_FAILED ? nullptr : static_cast<std::byte*>(mapped);
    return memory_ != nullptr;
  }
  void unmap() { munmap(memory_, Link::kMemory); }

  static constexpr std::uint64_t kWhole = 3;   // a frame that is a message
  static constexpr std::uint64_t kLends = 11;  // that, and its end says of a loan

  void send(const Bytes& message, std::uint64_t kind = kWhole) {
    RingState& ring = state(out_);
    const std::uint64_t at = written_;
    const std::size_t frame = 8 + ((message.size() + 7) & ~std::size_t{7});
    if (at % Link::kCapacity + frame > Link::kCapacity) return;
    std::byte* const place = content(out_) + at % Link::kCapacity;
    const std::uint64_t header = kind << 32 | message.size();
    std::memcpy(place + 8, message.data(), message.size());
    std::memcpy(place, &header, sizeof header);
    written_ += frame;
    ring.written = written_;
    wake_readers(ring);
  }

  /// Of all that both sides read: positions, words, headers, content.
  void damage() {
    const int which = static_cast<int>(random_() % 2);
    RingState& ring = state(which);
    switch (random_() % 8) {
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
        pretend_asleep(ring.reader_sleeps, ring.reader_core);
        break;
      case 4:
        ring.writer_sleeps = static_cast<std::uint32_t>(random_());
        break;
      case 5:
        pretend_asleep(ring.caller_sleeps, ring.caller_core);
        break;
      case 6:  // again and again, while the other side reads
        for (int i = 0; i < 2000; ++i) scribble(which);
        break;
      default:
        scribble(which);
    }
    if (chance(2)) ring.caller_reads = static_cast<std::uint32_t>(random_() % 2);
    same_host::ring(doorbell_);
    same_host::futex_wake(ring.caller_sleeps);
    same_host::futex_wake(ring.writer_sleeps);
  }

  /// Says that it sleeps, mostly on the core where the other side is.
  void pretend_asleep(same_host::Word& sleeps, same_host::Word& core) {
    sleeps = static_cast<std::uint32_t>(chance(4) ? random_() : random_() % 3);
    core = static_cast<std::uint32_t>(chance(4) ? random_() : 1 + random_() % 2);
  }

  /// Takes what the other side sends, mostly.
  void eat() {
    RingState& ring = state(1 - out_);
    if (!chance(3)) ring.read = ring.written.load();
    ring.writer_sleeps = 0;
    same_host::futex_wake(ring.writer_sleeps);
  }

  void append_body(Bytes& message) {
    for (std::uint64_t i = random_() % 64; i > 0; --i) {
      const auto octet = static_cast<std::byte>(chance(2) ? 0 : random_());
      message.append({&octet, 1});
    }
  }
  /// Leaves one in two as it is.
  void damage(Bytes& message) {
    if (chance(2)) return;
    for (int i = 0; i < 4; ++i)
      message.data()[random_() % message.size()] = static_cast<std::byte>(random_());
  }

  /// Not one that takes as long, or as much memory, as its arguments say.
  std::uint32_t any_operation() {
    const auto& operations = LouderEcho::interface_info().operations;
    while (true) {
      const auto& operation = operations[random_() % operations.size()];
      const auto& name = operation.name;
      if (name != "wait" && name != "who" && name != "burst") return operation.hash;
    }
  }

  // So that some of it comes while the other side looks.
  static void look_alive() { sched_yield(); }

 private:
  void wake_readers(RingState& ring) {
    ring.reader_sleeps = 0;
    same_host::ring(doorbell_);
    ring.caller_sleeps = 0;
    same_host::futex_wake(ring.caller_sleeps);
  }
  RingState& state(int which) { return reinterpret_cast<RingState*>(memory_)[which]; }
  std::byte* content(int which) {
    return memory_ + (Link::kMemory - 2 * Link::kCapacity) +
           static_cast<std::size_t>(which) * Link::kCapacity;
  }
  void scribble(int which) {
    const std::uint64_t value = chance(2) ? random_() : (random_() % 16) << 32 | random_() % 256;
    std::memcpy(content(which) + random_() % 512 * 8, &value, sizeof value);
  }

  std::mt19937_64 random_;
  const int out_;
  const FileDescriptor doorbell_ = same_host::make_doorbell();
  std::byte* memory_ = nullptr;
  std::uint64_t written_ = 0;
};

std::string address_of(const Guid& provider) { return "skein-call/" + provider.hex(); }

/// A client that joins as it should, and then is hostile.
class HostileClient : Attacker {
 public:
  HostileClient(const Guid& provider, std::uint64_t seed, bool lends = false)
      : Attacker(seed, 0), provider_(provider), lends_(lends) {}

  void attack() {
    const Guid client = Guid::random();
    const FileDescriptor socket = local_socket(SOCK_SEQPACKET);
    if (connect_to(socket, address_of(provider_)) != Reached::Yes) return;
    const FileDescriptor descriptor = handed_over(socket, client);
    if (!descriptor || !map(descriptor)) return;
    send(open_request(client));
    for (std::uint64_t number = 1; number < 40; ++number) {
      if (chance(2)) send(request(client, number));
      if (lends_ && chance(2)) lend(socket, client, number);
      if (chance(3)) Attacker::damage();
      eat();
      look_alive();
    }
    unmap();
  }

 private:
  FileDescriptor handed_over(const FileDescriptor& socket, const Guid& client) {
    std::array<char, 24> hello{"skein4"};
    std::memcpy(hello.data() + 8, client.bytes.data(), client.bytes.size());
    const int handed = doorbell(socket);
    const auto packet = std::as_bytes(std::span(hello));
    if (!(handed < 0 ? same_host::pass(socket.get(), packet, {})
                     : same_host::pass(socket.get(), packet, {handed}))) {
      return {};
    }
    pollfd answered{socket.get(), POLLIN, 0};
    poll(&answered, 1, 20'000);
    std::array<std::byte, 128> answer{};
    std::array<HandedOver, 2> theirs;
    same_host::receive_passed(socket.get(), answer, theirs);
    // Closed here: a forked process has no thread to close it elsewhere.
    const FileDescriptor others_doorbell(theirs[1].release());
    return FileDescriptor(theirs[0].release());
  }

  static Bytes open_request(const Guid& client) {
    Bytes message;
    rpc::wire::begin_request(message, {client, 0}, rpc::wire::kOpen);
    rpc::wire::append_default_branch(message);
    rpc::wire::append_trailer(message, rpc::wire::RequestTrailer{10s});
    return message;
  }

  Bytes request(const Guid& client, std::uint64_t number) {
    Bytes message;
    rpc::wire::begin_request(message, {client, number}, any_operation());
    append_body(message);
    rpc::wire::append_trailer(message, rpc::wire::RequestTrailer{chance(2) ? 1s : 1ms});
    damage(message);
    return message;
  }

  /// Memory of any kind, and a call that lends what it says is there.
  void lend(const FileDescriptor& socket, const Guid& client, std::uint64_t number) {
    const std::uint32_t place = static_cast<std::uint32_t>(random() % (chance(8) ? 10 : 3));
    const std::uint32_t generation = static_cast<std::uint32_t>(1 + random() % 3);
    if (!chance(4)) {
      const FileDescriptor memory(memfd_create("hostile", MFD_CLOEXEC | MFD_ALLOW_SEALING));
      const std::size_t size = chance(8) ? random() % 8192 : sizeof(::test::Frame);
      const int seals = F_SEAL_SHRINK | F_SEAL_GROW | (chance(8) ? 0 : F_SEAL_FUTURE_WRITE);
      if (ftruncate(memory.get(), static_cast<off_t>(size)) != 0) return;
      if (!chance(8)) fcntl(memory.get(), F_ADD_SEALS, seals);
      const std::array<std::uint32_t, 2> packet{place, generation};
      if (chance(8)) {
        same_host::pass(socket.get(), std::as_bytes(std::span(packet)), {});
      } else {
        same_host::pass(socket.get(), std::as_bytes(std::span(packet)), {memory.get()});
      }
    }
    Bytes message;
    rpc::wire::begin_request(message, {client, number}, operation("study"));
    same_host::LoanNote note{place, generation, sizeof(::test::Frame), message.size()};
    rpc::wire::append_trailer(message, rpc::wire::RequestTrailer{1s});
    damage(message);
    if (chance(8)) note.size = random() % (2 * sizeof(::test::Frame));
    if (chance(8)) note.position = random() % 256;
    message.append(std::as_bytes(std::span(&note, 1)));
    send(message, kLends);
  }

  static std::uint32_t operation(const std::string& name) {
    const auto& all = ::test::Album::interface_info().operations;
    return std::ranges::find_if(all, [&](const auto& each) { return each.name == name; })->hash;
  }

  const Guid provider_;
  const bool lends_;
};

/// A provider that lets a client in, mostly as it should, and then is hostile.
class HostileProvider : Attacker {
 public:
  HostileProvider(const Guid& provider, std::uint64_t seed)
      : Attacker(seed, 1), provider_(provider) {}

  /// Of the address under which clients look for it.
  static FileDescriptor listen_as(const Guid& provider) {
    FileDescriptor socket = local_socket(SOCK_SEQPACKET);
    return listen_at(socket, address_of(provider)) ? std::move(socket) : FileDescriptor();
  }

  /// Whether a client came.
  bool attack(const FileDescriptor& listening) {
    if (!readable(listening, 100)) return false;
    const FileDescriptor socket(accept4(listening.get(), nullptr, nullptr, SOCK_CLOEXEC));
    std::array<char, 24> hello{};
    if (!socket || !readable(socket, 20'000) ||
        recv(socket.get(), hello.data(), hello.size(), 0) != ssize_t{hello.size()})
      return false;
    Guid client;
    std::memcpy(client.bytes.data(), hello.data() + 8, client.bytes.size());
    const bool sound = !chance(8);
    const FileDescriptor descriptor(memfd_create("hostile", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    const auto size = static_cast<off_t>(sound || chance(2) ? Link::kMemory : random() % 8192);
    if (ftruncate(descriptor.get(), size) != 0) return false;
    if (sound || chance(2)) fcntl(descriptor.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW);
    if (!answer(socket, descriptor) || !sound || !map(descriptor)) return true;
    send(opened(client));
    for (std::uint64_t i = 1; i < 60; ++i) {
      if (chance(2)) send(reply(client, 1 + random() % 12));
      if (chance(6)) Attacker::damage();
      eat();
      look_alive();
    }
    unmap();
    return true;
  }

 private:
  static bool readable(const FileDescriptor& socket, int time_ms) {
    pollfd polled{socket.get(), POLLIN, 0};
    return poll(&polled, 1, time_ms) > 0;
  }

  bool answer(const FileDescriptor& socket, const FileDescriptor& descriptor) {
    std::array<char, 128> packet{"skein4"};
    std::memcpy(packet.data() + 8, provider_.bytes.data(), provider_.bytes.size());
    if (chance(16)) packet[random() % packet.size()] = static_cast<char>(random());
    iovec content{packet.data(), packet.size()};
    const int bell = doorbell(descriptor);
    const std::array<int, 3> handed{descriptor.get(), bell, descriptor.get()};
    const std::size_t size = sizeof(int) * (bell < 0 ? 1 : chance(8) ? 3 : 2);
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof handed)] = {};
    msghdr message{};
    message.msg_iov = &content;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = CMSG_SPACE(size);
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(size);
    std::memcpy(CMSG_DATA(header), handed.data(), size);
    return sendmsg(socket.get(), &message, MSG_NOSIGNAL) == ssize_t{packet.size()};
  }

  static Bytes opened(const Guid& client) {
    Bytes message;
    rpc::wire::begin_reply(message, {client, 0}, rpc::wire::RemoteException::Ok, rpc::wire::kOpen);
    rpc::wire::append_default_branch(message);
    return message;
  }

  Bytes reply(const Guid& client, std::uint64_t number) {
    Bytes message;
    const auto exception = static_cast<rpc::wire::RemoteException>(chance(2) ? 0 : random() % 7);
    rpc::wire::begin_reply(message, {client, number}, exception, any_operation());
    if (chance(2)) rpc::wire::append_discriminator(message, 0);
    append_body(message);
    if (chance(2)) {
      rpc::wire::ReplyTrailer trailer;
      trailer.part = static_cast<rpc::wire::StreamPart>(random() % 4);
      trailer.position = random() % 3;
      rpc::wire::append_trailer(message, trailer);
    }
    damage(message);
    return message;
  }

  const Guid provider_;
};

/// A process that attacks until it is told to end. Forked before this one has threads.
class AttackingProcess {
 public:
  /// Attacks that provider's clients, or the provider, once that is known; whether it did.
  using Attack = std::function<bool(const Guid& provider, std::uint64_t seed)>;

  explicit AttackingProcess(const Attack& attack, std::uint64_t seed) {
    void* const memory =
        mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    REQUIRE(memory != MAP_FAILED);
    shared_ = new (memory) Shared;
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    while (!shared_->begin) sched_yield();
    while (!shared_->end) {
      if (attack(shared_->provider, seed + shared_->rounds)) ++shared_->rounds;
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

  /// Does `meanwhile` until it has attacked so often; false once it does not any more. It is slow
  /// on a busy machine, as it lets others run.
  bool comes(std::uint64_t rounds, const std::function<void()>& meanwhile) const {
    std::uint64_t reached = 0;
    const auto gets_on = [&] {
      meanwhile();
      return this->rounds() > reached;
    };
    while (reached < rounds && eventually(gets_on)) reached = this->rounds();
    return reached >= rounds;
  }

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

/// How many descriptors are open of each kind, as `socket:[]` or `anon_inode:[eventfd]`.
std::map<std::string, int> open_descriptors() {
  std::map<std::string, int> open;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    std::string kind = std::filesystem::read_symlink(entry.path(), gone).string();
    std::erase_if(kind, [](char each) { return each >= '0' && each <= '9'; });
    if (!gone) ++open[kind];
  }
  return open;
}

int mapped_memory() {
  std::ifstream maps("/proc/self/maps");
  int count = 0;
  for (std::string line; std::getline(maps, line);) count += line.find("memfd:") != line.npos;
  return count;
}

/// Reads all that it is given.
struct Album final : ::test::Album {
  std::uint64_t weigh(const std::string&, const ::test::Frame& frame, std::int32_t,
                      std::string&) override {
    return study(frame);
  }
  std::uint64_t weigh_both(const ::test::Frame& one, const ::test::Frame& other) override {
    return study(one) + study(other);
  }
  std::uint64_t weigh_line(const ::test::Line&) override { return 0; }
  std::uint64_t study(const ::test::Frame& frame) override {
    ++studied;
    return std::accumulate(frame.pixels.begin(), frame.pixels.end(), std::uint64_t{0});
  }
  std::uint64_t weigh_marked(const ::test::Marked&) override { return 0; }

  std::atomic<std::uint64_t> studied{0};
};

/// What this process holds of memory and descriptors.
class Holding {
 public:
  void check_that_no_more_is_held() const {
    CHECK(eventually([&] { return mapped_memory() == mapped_; }));
    eventually([&] { return open_descriptors() == descriptors_; });
    CHECK(open_descriptors() == descriptors_);
  }

 private:
  const int mapped_ = mapped_memory();
  const std::map<std::string, int> descriptors_ = open_descriptors();
};

/// Attacks a provider, of which `call` is another client's call, until that is `enough`.
void withstand(
    AttackingProcess& attacker, const Guid& provider, Entity& client,
    const std::function<void()>& call, const std::function<bool()>& enough = [] { return true; }) {
  call();
  const Holding before;
  attacker.begin(provider);
  REQUIRE(attacker.comes(150, call));
  REQUIRE(eventually([&] { return call(), enough(); }));
  CHECK(attacker.stop() == 0);
  CHECK(client.connector().connections().front().transport == "shared memory");
  before.check_that_no_more_is_held();
}

template <class Action>
void whatever_comes_of(Action action) {
  try {
    action();
  } catch (const Error&) {
  }
}

AttackingProcess::Attack hostile_client(bool lends) {
  return [lends](const Guid& provider, std::uint64_t seed) {
    HostileClient(provider, seed, lends).attack();
    return true;
  };
}

}  // namespace

TEST_CASE(
    "a process that writes anything into the memory it shares harms neither provider nor others") {
  AttackingProcess attacker(hostile_client(false), seed_of_this_run());
  const Log log;
  EchoPair pair(make_entity("server"), make_entity("client"),
                {.thread = GENERATE(CallThread::Own, CallThread::Caller)});
  std::uint64_t answered = 0;
  withstand(attacker, pair.id, *pair.client, [&] {
    const std::string text = std::to_string(++answered);
    INVARIANT(pair.echo->within(20s).echo(text) == text);
  });
  CHECK(log.count("has damaged the memory that it shares") > 10);
}

TEST_CASE("a process that lends memory of any kind, or none, harms neither provider nor others") {
  AttackingProcess attacker(hostile_client(true), seed_of_this_run());
  const Log log;
  const auto server = make_entity("server");
  const auto album = std::make_shared<Album>();
  const Guid provider = server->provide<::test::Album>(
      album, {.thread = GENERATE(CallThread::Own, CallThread::Caller)});
  const auto client = make_entity("client");
  auto sound = client->connect<::test::Album>();
  Loaned<::test::Frame> frame;
  frame->pixels.fill(1);
  std::uint64_t asked = 0;
  withstand(
      attacker, provider, *client,
      [&] {
        ++asked;
        INVARIANT(sound.within(20s).study(*frame) == frame->pixels.size());
      },
      [&] { return album->studied > asked; });  // some of what was lent was read
  CHECK(log.count("a loan") > 10);
  CHECK(log.count("a caller's memory cannot be read") > 10);
}

TEST_CASE("a provider that writes anything into the memory it shares harms its clients alone") {
  FileDescriptor listening;  // of the process that attacks
  AttackingProcess attacker(
      [&](const Guid& provider, std::uint64_t seed) {
        if (!listening) listening = HostileProvider::listen_as(provider);
        return HostileProvider(provider, seed).attack(listening);
      },
      seed_of_this_run());
  const Log log;
  const auto sound = make_entity("sound");
  const Guid sound_id = sound->provide<LouderEcho>(std::make_shared<EchoService>());
  // What takes its calls through shared memory is the process that attacks.
  const auto hostile = make_entity("hostile", false);
  ServiceOptions says_so;
  says_so.attributes = {{"skein:shared_memory_calls", "true"}};
  const Guid hostile_id = hostile->provide<LouderEcho>(std::make_shared<EchoService>(), says_so);
  attacker.begin(hostile_id);
  const auto bystander = make_entity("bystander");
  auto echo = bystander->connect<Echo>({.provider = sound_id});
  const Holding before;

  constexpr std::uint64_t kRounds = 100;
  std::uint64_t answered = 0;
  while (attacker.rounds() < kRounds) {
    const auto client = make_entity("client");  // none that knows its provider already
    auto sound_echo = client->connect<Echo>({.provider = sound_id});
    whatever_comes_of([&] {
      auto victim = client->connect<Echo>({.provider = hostile_id, .timeout = 300ms});
      std::vector<Call<std::string>> calls;
      for (int i = 0; i < 8; ++i) calls.push_back(victim.within(100ms).async_echo("hello"));
      auto numbers = victim.within(100ms).count_up(1000, -1);
      whatever_comes_of([&] {
        while (numbers.next()) continue;
      });
      for (auto& call : calls) whatever_comes_of([&] { call.get(); });
    });
    for (auto* each : {&echo, &sound_echo}) {
      const std::string text = std::to_string(++answered);
      INVARIANT(each->within(20s).echo(text) == text);
    }
  }
  CHECK(attacker.stop() == 0);
  CHECK(bystander->connector().connections().front().transport == "shared memory");
  CHECK(log.count("has damaged the memory that it shares") > 10);
  before.check_that_no_more_is_held();
}
