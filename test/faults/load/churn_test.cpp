// Participants, readers and writers come and go on several threads, while data flows and other
// processes are stopped beyond their leases and killed. Whoever stays must live, end, and still
// find newcomers.
#include "churn.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "test/connector/pairing.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/seed.hpp"

using namespace skein::test;
using namespace skein::dds;
using namespace std::chrono_literals;

namespace {

constexpr std::array kLeases{60ms, 100ms, 250ms, 1000ms};

const char* soak_seconds() { return std::getenv("SKEIN_SOAK_SECONDS"); }

std::chrono::milliseconds length_of_a_round() {
  return std::chrono::milliseconds(1000 * (soak_seconds() ? std::stoul(soak_seconds()) : 24) /
                                   kLeases.size());
}

/// Ends a churn that hangs by SIGABRT, so that a core shows where.
void abort_in(std::chrono::milliseconds time) {
  std::signal(SIGALRM, [](int) { std::abort(); });
  alarm(static_cast<unsigned>(std::chrono::ceil<std::chrono::seconds>(time).count()));
}

/// Sets a flag when it goes, before the threads declared ahead of it are joined.
struct Ending {
  std::atomic<bool>& over;
  ~Ending() { over = true; }
};

class Round {
 public:
  explicit Round(std::chrono::milliseconds lease)
      : lease_(lease),
        one_(churn_participant(*Pairing::get().server, lease)),
        other_(churn_participant(*Pairing::get().client, lease)) {}

  void run(std::chrono::milliseconds length) {
    std::vector<std::jthread> threads;
    const Ending ending{over_};
    for (int i = 0; i < 2; ++i) {
      threads.emplace_back([this, seed = next_seed_++] { churn_readers(seed); });
      threads.emplace_back([this, seed = next_seed_++] { churn_writers(seed); });
      threads.emplace_back([this, seed = next_seed_++] { churn_participants(seed); });
    }
    disturb(length);
  }

  /// Data from a new writer reaches a new reader, in both directions.
  void check_healed() {
    check_flows(*one_, *other_);
    check_flows(*other_, *one_);
    std::printf(
        "lease %lld ms: %llu readers, %llu writers, %llu participants, %llu samples, "
        "%llu stops, %llu kills\n",
        static_cast<long long>(lease_.count()), readers_.load(), writers_.load(),
        participants_.load(), static_cast<unsigned long long>(received_), stops_, kills_);
    std::fflush(stdout);
    CHECK(readers_ > 0);
    CHECK(writers_ > 0);
    CHECK(participants_ > 0);
    CHECK(received_ > 0);
  }

 private:
  void churn_readers(unsigned seed) {
    std::mt19937 random(seed);
    for (; !over_; ++readers_) {
      const auto reader = churn_reader(*one_, ChurnTopic::any(random), received_);
      let_live(std::chrono::milliseconds(random() % 30));
    }
  }

  void churn_writers(unsigned seed) {
    std::mt19937 random(seed);
    for (; !over_; ++writers_) {
      const auto of = ChurnTopic::any(random);
      const auto writer = churn_writer(*other_, of);
      for (unsigned i = random() % 10; i > 0; --i) {
        churn_write(*writer, of, random);
        let_live(3ms);
      }
    }
  }

  void churn_participants(unsigned seed) {
    std::mt19937 random(seed);
    for (; !over_; ++participants_) {
      Vendor& vendor = random() % 2 ? *Pairing::get().server : *Pairing::get().client;
      const auto participant = churn_participant(vendor, kLeases[random() % kLeases.size()]);
      const auto of = ChurnTopic::any(random);
      const auto reader = churn_reader(*participant, of, received_);
      const auto writer = churn_writer(*participant, of);
      for (unsigned i = random() % 40; i > 0; --i) {
        churn_write(*writer, of, random);
        let_live(5ms);
      }
    }
  }

  /// Another process, stopped for about its lease, goes on; now and then it is killed.
  void disturb(std::chrono::milliseconds length) {
    std::mt19937 random(next_seed_++);
    const auto end = std::chrono::steady_clock::now() + length;
    std::optional<ChildProcess> peer;
    while (std::chrono::steady_clock::now() < end) {
      if (!peer) {
        const auto vendor = random() % 2 ? Pairing::get().server : Pairing::get().client;
        ChildProcess::Options options;
        options.arguments = {vendor->name(), std::to_string(lease_.count())};
        peer.emplace("churn_peer", options);
        peer->expect("ready");
      }
      let_live(lease_ / 2 + std::chrono::milliseconds(random() % 300));
      if (random() % 3 == 0) {
        peer.reset();
        ++kills_;
        continue;
      }
      peer->signal(SIGSTOP);
      let_live(lease_ * (50 + random() % 150) / 100);
      peer->signal(SIGCONT);
      ++stops_;
    }
    if (peer) CHECK(peer->finish() == 0);
  }

  static void check_flows(Participant& from, Participant& to) {
    std::mt19937 random(1);
    const ChurnTopic of{{"churn_healed", "Churn", false}, {}};
    std::atomic<std::uint64_t> received{0};
    const auto reader = churn_reader(to, of, received);
    const auto writer = churn_writer(from, of);
    CHECK(eventually([&] {
      churn_write(*writer, of, random);
      return received > 0;
    }));
  }

  const std::chrono::milliseconds lease_;
  std::unique_ptr<Participant> one_;
  std::unique_ptr<Participant> other_;
  std::atomic<bool> over_{false};
  std::atomic<std::uint64_t> received_{0};
  std::atomic<unsigned long long> readers_{0};
  std::atomic<unsigned long long> writers_{0};
  std::atomic<unsigned long long> participants_{0};
  unsigned long long stops_ = 0;
  unsigned long long kills_ = 0;
  unsigned next_seed_ = static_cast<unsigned>(seed_of_this_run());
};

}  // namespace

TEST_CASE(
    "participants and endpoints come and go on several threads, while peers are stopped and "
    "killed") {
  const auto length = length_of_a_round();
  for (const auto lease : kLeases) {
    abort_in(length + 4min);
    Round round(lease);
    round.run(length);
    round.check_healed();
  }
  alarm(0);
}
