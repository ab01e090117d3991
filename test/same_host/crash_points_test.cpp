// Either side of a call is killed at some instruction of it: one call is followed step by step,
// others run to a breakpoint. The other side, in this process, has whole messages or none, is told,
// keeps nothing, and calls others.
#include <sys/ptrace.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "same_host/call_ports.hpp"
#include "skein/error.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/invariant.hpp"
#include "test/tools/prepare.hpp"
#include "test/tools/seed.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

/// The thread that makes it is followed from there to its next one.
constexpr int kMark = SIGUSR1;

calls::Address at(const Guid& provider) { return {"test/Desk", provider}; }

std::vector<std::byte> message(const std::string& text) {
  std::vector<std::byte> content{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  for (const char letter : text) content.push_back(static_cast<std::byte>(letter));
  return content;
}

std::string text_of(std::span<const std::byte> cdr) {
  return {reinterpret_cast<const char*>(cdr.data()) + 4, cdr.size() - 4};
}

const std::string kQuestion(300, 'q');
const std::string kAnswer(300, 'a');

/// Answers what its clients ask. `on_request` is called before each answer.
class Provider {
 public:
  Provider(const Guid& id, std::function<void()> on_request)
      : on_request_(std::move(on_request)), ports_(meeting_, {id.participant()}) {
    receiver_ = ports_.receive_requests(at(id), false,
                                        {[this](const calls::Message& request) { answer(request); },
                                         [this](const Guid& client, bool found) {
                                           if (!found) forget(client);
                                         }});
  }

  std::size_t clients() const {
    std::lock_guard lock(mutex_);
    return senders_.size();
  }
  bool heard_nonsense() const { return nonsense_; }

 private:
  void answer(const calls::Message& request) {
    on_request_();
    if (text_of(request.bytes) != kQuestion) nonsense_ = true;
    std::lock_guard lock(mutex_);
    auto& sender = senders_[request.sender];
    if (!sender) sender = ports_.send_replies({}, request.sender);
    sender->send(message(kAnswer));
  }
  void forget(const Guid& client) {
    std::unique_ptr<calls::Sender> gone;
    std::lock_guard lock(mutex_);
    gone = std::move(senders_[client]);
    senders_.erase(client);
  }

  const std::function<void()> on_request_;
  std::atomic<bool> nonsense_{false};
  mutable std::mutex mutex_;
  Meeting meeting_;
  ProviderPort ports_;
  std::map<Guid, std::unique_ptr<calls::Sender>> senders_;
  std::unique_ptr<calls::Receiver> receiver_;
};

enum class Outcome { Answered, Ended, Nonsense };

/// Calls a provider, and takes the answers on the calling thread.
class Client {
 public:
  explicit Client(const Guid& provider) : ports_(meeting_, {Guid::random().participant()}) {
    sender_ = ports_.send_requests(at(provider), [this](const Guid&, bool found) {
      if (!found) ended_ = true;
    });
    receiver_ = ports_.receive_replies(
        at(provider), sender_->identity(), {[this](const calls::Message& reply) {
          (text_of(reply.bytes) == kAnswer ? answers_ : nonsense_)++;
          delivery_->wake();  // The answer to the first call may be taken by another thread.
        }});
    delivery_ = receiver_->caller_delivery();
  }

  Outcome call() {
    const int before = answers_ + nonsense_;
    delivery_->lend();
    try {
      sender_->send(message(kQuestion));
    } catch (const Error&) {
      return Outcome::Ended;
    }
    delivery_->deliver_until([&] { return answers_ + nonsense_ > before; });
    if (nonsense_ > 0) return Outcome::Nonsense;
    return answers_ > before ? Outcome::Answered : Outcome::Ended;
  }
  bool told() {
    return eventually([&] { return ended_.load(); });
  }

 private:
  Meeting meeting_;
  ClientPort ports_;
  std::atomic<int> answers_{0};
  std::atomic<int> nonsense_{0};
  std::atomic<bool> ended_{false};
  std::unique_ptr<calls::Sender> sender_;
  std::shared_ptr<calls::CallerDelivery> delivery_;
  std::unique_ptr<calls::Receiver> receiver_;
};

std::unique_ptr<Client> connect(const Guid& provider) {
  std::unique_ptr<Client> client;
  const bool connected = eventually([&] {
    try {
      client = std::make_unique<Client>(provider);
      return true;
    } catch (const Unavailable&) {
      return false;
    }
  });
  return connected ? std::move(client) : nullptr;
}

/// What this process has open, and shares.
struct Kept {
  std::size_t descriptors = 0;
  std::size_t memories = 0;
  bool operator==(const Kept&) const = default;
};

Kept kept() {
  Kept now;
  for ([[maybe_unused]] const auto& each : std::filesystem::directory_iterator("/proc/self/fd")) {
    ++now.descriptors;
  }
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (line.find("memfd:skein") != std::string::npos) ++now.memories;
  }
  return now;
}

/// Whether no more is kept than ever before: a thread that has let a client in, or go, may give
/// back what it took for that a moment after the client was answered.
class LeastKept {
 public:
  bool reached() {
    const Kept now = kept();
    least_.descriptors = std::min(least_.descriptors, now.descriptors);
    least_.memories = std::min(least_.memories, now.memories);
    return now == least_;
  }

 private:
  Kept least_ = kept();
};

using Address = unsigned long;

/// A process of which one thread is followed from its mark on. All members on one thread, which the
/// kernel takes for its tracer.
class Victim {
 public:
  explicit Victim(const std::function<void()>& body) : pid_(fork()) {
    if (pid_ < 0) throw std::runtime_error("fork failed");
    if (pid_ == 0) {
      ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
      raise(SIGSTOP);
      body();
      _exit(0);
    }
    int status = 0;
    waitpid(pid_, &status, __WALL);
    ptrace(PTRACE_SETOPTIONS, pid_, nullptr, PTRACE_O_TRACECLONE | PTRACE_O_EXITKILL);
    ptrace(PTRACE_CONT, pid_, nullptr, nullptr);
  }
  ~Victim() { kill(); }
  Victim(const Victim&) = delete;
  Victim& operator=(const Victim&) = delete;

  /// Lets all threads run until one of them makes a mark; false where the process ends first.
  bool run_to_mark() {
    while (!ended_) {
      const auto stop = next_stop(-1);
      if (!stop) continue;
      if (stop->signal == kMark) {
        marked_ = stop->thread;
        return true;
      }
      go_on(*stop);
    }
    return false;
  }

  /// Lets the thread that stands at its mark run, too.
  void resume() { ptrace(PTRACE_CONT, marked_, nullptr, nullptr); }

  /// Where that thread is before each instruction until the next mark, while the others run.
  std::vector<Address> trace() {
    std::vector<Address> places;
    while (!ended_) {
      places.push_back(place(marked_));
      const auto stop = step(marked_);
      if (!stop || stop->signal == kMark) break;
    }
    return places;
  }

  /// Lets that thread run until it is where the other one of the trace was at `point`; false where
  /// it takes another way, and comes to its next mark.
  bool run_to(const std::vector<Address>& places, std::size_t point) {
    const Address wanted = places.at(point);
    auto times = std::count(places.begin(), places.begin() + static_cast<int>(point) + 1, wanted);
    while (true) {
      if (place(marked_) == wanted && --times == 0) return true;
      const auto stepped = step(marked_);
      if (!stepped || stepped->signal == kMark) return false;
      if (place(marked_) != wanted && !run_to_break(wanted)) return false;
    }
  }

  void kill() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    while (!ended_) next_stop(-1);
    pid_ = 0;
  }

 private:
  struct Stop {
    pid_t thread;
    int signal;
  };

  std::optional<Stop> step(pid_t thread) {
    ptrace(PTRACE_SINGLESTEP, thread, nullptr, nullptr);
    return next_stop(thread);
  }

  // Every thread stops there: others are helped over it.
  bool run_to_break(Address wanted) {
    const long text = ptrace(PTRACE_PEEKTEXT, marked_, wanted, nullptr);
    const auto arm = [&](pid_t by) { ptrace(PTRACE_POKETEXT, by, wanted, (text & ~0xFFL) | 0xCC); };
    const auto disarm = [&](pid_t by) { ptrace(PTRACE_POKETEXT, by, wanted, text); };
    arm(marked_);
    resume();
    while (!ended_) {
      const auto stop = next_stop(-1);
      if (!stop) continue;
      if (stop->signal == kMark) {
        disarm(stop->thread);
        return false;
      }
      if (stop->signal != SIGTRAP || place(stop->thread) != wanted + 1) {
        go_on(*stop);
        continue;
      }
      disarm(stop->thread);
      set_place(stop->thread, wanted);
      if (stop->thread == marked_) return true;
      step(stop->thread);
      arm(stop->thread);
      ptrace(PTRACE_CONT, stop->thread, nullptr, nullptr);
    }
    return false;
  }

  static Address place(pid_t thread) {
    user_regs_struct registers{};
    ptrace(PTRACE_GETREGS, thread, nullptr, &registers);
    return registers.rip;
  }
  static void set_place(pid_t thread, Address place) {
    user_regs_struct registers{};
    ptrace(PTRACE_GETREGS, thread, nullptr, &registers);
    registers.rip = place;
    ptrace(PTRACE_SETREGS, thread, nullptr, &registers);
  }

  // Nothing where a thread has ended, which may be the last.
  std::optional<Stop> next_stop(pid_t of) {
    int status = 0;
    const pid_t thread = waitpid(of, &status, __WALL);
    if (thread < 0 || (thread == pid_ && !WIFSTOPPED(status))) ended_ = true;
    if (thread < 0 || !WIFSTOPPED(status)) return std::nullopt;
    return Stop{thread, WSTOPSIG(status)};
  }

  // A new thread begins with SIGSTOP, and SIGTRAP tells of it: neither is for the process.
  static void go_on(const Stop& stop) {
    const bool ours = stop.signal == SIGSTOP || stop.signal == SIGTRAP;
    ptrace(PTRACE_CONT, stop.thread, nullptr, ours ? 0 : stop.signal);
  }

  pid_t pid_;
  pid_t marked_ = 0;
  bool ended_ = false;
};

void mark() { raise(kMark); }

std::size_t kills() {
  const char* given = std::getenv("SKEIN_CRASH_POINTS");
  return given ? std::stoul(given) : 150;
}

/// Marks its second call: what is done once only, such as finding symbols, is done.
std::unique_ptr<Victim> start_client(const Guid& provider) {
  return std::make_unique<Victim>([&] {
    Client client(provider);
    client.call();
    mark();
    client.call();
    mark();
  });
}

/// A provider that marks its answers, and who calls it. It is followed from the second one on: to
/// its end, and while the third request is taken.
class CalledVictim {
 public:
  CalledVictim()
      : victim_([this] {
          Provider provider(id_, mark);
          pause();
        }) {
    caller_ = std::thread([this] { call(); });
    began_ = victim_.run_to_mark() && (victim_.resume(), victim_.run_to_mark());
  }
  ~CalledVictim() { end(); }

  bool began() const { return began_; }
  Victim& operator*() { return victim_; }
  /// Kills it, and waits for its caller.
  void end() {
    victim_.kill();
    if (caller_.joinable()) caller_.join();
  }
  Outcome outcome() const { return outcome_; }
  bool told() const { return told_; }

 private:
  void call() {
    const auto client = connect(id_);
    if (!client) return;
    while ((outcome_ = client->call()) == Outcome::Answered) {
    }
    told_ = client->told();
  }

  const Guid id_ = Guid::random();
  Victim victim_;
  std::thread caller_;
  bool began_ = false;
  // The caller's, until end().
  Outcome outcome_ = Outcome::Nonsense;
  bool told_ = false;
};

bool may_trace() {
  const pid_t child = fork();
  if (child == 0) _exit(ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0 ? 0 : 1);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

int test::prepare() { return may_trace() ? 0 : 77; }

TEST_CASE("a client may be killed at any instruction of a call") {
  const Guid id = Guid::random();
  Provider provider(id, [] {});
  const auto steady = connect(id);
  REQUIRE(steady);
  REQUIRE(steady->call() == Outcome::Answered);
  LeastKept least;
  const auto is_alone = [&] { return provider.clients() == 1 && least.reached(); };
  std::vector<Address> whole;
  {
    const auto traced = start_client(id);
    REQUIRE(traced->run_to_mark());
    whole = traced->trace();
  }
  REQUIRE(whole.size() > 500);
  REQUIRE(eventually(is_alone));
  std::mt19937_64 random(test::seed_of_this_run());
  std::size_t inside = 0;
  for (std::size_t i = 0; i < kills(); ++i) {
    const std::size_t point = random() % whole.size();
    CAPTURE(point, whole.size());
    const auto victim = start_client(id);
    REQUIRE(victim->run_to_mark());
    if (victim->run_to(whole, point)) ++inside;
    victim->kill();
    INVARIANT(eventually(is_alone));
    INVARIANT(!provider.heard_nonsense());
    INVARIANT(steady->call() == Outcome::Answered);
  }
  CHECK(inside > kills() / 2);
}

TEST_CASE("a provider may be killed at any instruction of a call") {
  std::vector<Address> whole;
  {
    CalledVictim traced;
    REQUIRE(traced.began());
    whole = (*traced).trace();
  }
  REQUIRE(whole.size() > 500);
  LeastKept least;
  std::mt19937_64 random(test::seed_of_this_run());
  std::size_t inside = 0;
  for (std::size_t i = 0; i < kills(); ++i) {
    const std::size_t point = random() % whole.size();
    CAPTURE(point, whole.size());
    CalledVictim victim;
    REQUIRE(victim.began());
    if ((*victim).run_to(whole, point)) ++inside;
    victim.end();
    INVARIANT(victim.outcome() == Outcome::Ended);
    INVARIANT(victim.told());
    INVARIANT(eventually([&] { return least.reached(); }));
  }
  CHECK(inside > kills() / 2);
}
