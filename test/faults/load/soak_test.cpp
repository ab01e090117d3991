// Everything at once for a while, over and over: calls, connects and disconnects, joins, leaves and
// deaths of clients, large payloads, a killed provider now and then. What lives through it must not
// hold more and more.
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <map>
#include <sstream>

#include "test/faults/matrix/fault_stage.hpp"
#include "test/faults/matrix/footprint.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

std::chrono::seconds soak_length() {
  const char* given = std::getenv("SKEIN_SOAK_SECONDS");
  return std::chrono::seconds(given != nullptr ? std::stoul(given) : 45);
}

/// Beyond the soak itself: start, a last round, and the checks.
constexpr auto kPatient = 60s;
/// So many at least, where the machine is slow.
constexpr int kFewestRounds = 16;
constexpr int kGuests = 2;
constexpr int kRoundsToKill = 3;

class Soak {
 public:
  explicit Soak(std::chrono::seconds length) : length_(length) {
    // The callers find the one that is going to be killed, and nobody else.
    mortal_ = &stage_.add_server();
    observe("the callers", stage_.add_clients(4));
    stage_.connect();
    observe("the provider", stage_.add_server());
    visitor_ = &stage_.add_clients(0);
    observe("the visitor", *visitor_);
    visitor_->expect("connected", kPatient);
  }

  void run() {
    const auto end = std::chrono::steady_clock::now() + length_;
    for (int round = 1; round <= kFewestRounds || std::chrono::steady_clock::now() < end; ++round) {
      stage_.start("timeout 20000 bytes 10000");
      visit();
      receive_guests(round % 2 == 0);
      if (round % kRoundsToKill == 0) kill_and_replace();
      stage_.run_for_calls(500);
      stage_.stop();
      stage_.check_healed();
      for (auto& [who, observed] : observed_)
        observed.rounds.push_back(footprint_of(*observed.peer));
    }
  }

  void check() {
    stage_.check("soak of " + std::to_string(length_.count()) + " s",
                 {"Ok", "Disconnected", "Unavailable", "Killed"});
    std::printf("clients that lost their provider: %zu\n", struck_);
    CHECK(struck_ > 0);
    for (const auto& [who, observed] : observed_) check_flat(who, observed.rounds);
  }

 private:
  struct Observed {
    ChildProcess* peer;
    std::vector<Footprint> rounds{};
  };

  void observe(const std::string& who, ChildProcess& peer) { observed_.insert({who, {&peer}}); }

  // Connects, makes large calls, and disconnects, in a process that stays.
  void visit() {
    visitor_->send("connect 2");
    visitor_->expect("connected", kPatient);
    visitor_->send("burst 1 timeout 20000 bytes 400000");
    visitor_->expect("sent");
    visitor_->send("settle");
    visitor_->expect("settled", kPatient);
    visitor_->send("disconnect");
    visitor_->expect("disconnected");
  }

  // A process that joins, calls, and leaves, or is killed while it calls.
  void receive_guests(bool kill) {
    ChildProcess& guests = stage_.add_clients(kGuests);
    guests.expect("connected", kPatient);
    guests.send("start timeout 20000 bytes 10000");
    guests.expect("started");
    stage_.run_for_calls(100);
    if (kill) {
      guests.signal(SIGKILL);
    } else {
      CHECK(guests.finish() == 0);
    }
    stage_.bury_clients(guests, kill);
  }

  void kill_and_replace() {
    std::size_t active = 0, clients = 0;
    mortal_->send("server");
    std::istringstream(mortal_->expect("server")) >> active >> clients;
    struck_ += clients;
    mortal_->signal(SIGKILL);
    stage_.bury(*mortal_);
    mortal_ = &stage_.add_server();
  }

  const std::chrono::seconds length_;
  FaultStage stage_;
  ChildProcess* mortal_;
  ChildProcess* visitor_;
  std::size_t struck_ = 0;  // clients that lost their provider
  std::map<std::string, Observed> observed_;
};

}  // namespace

TEST_CASE("peers that stay hold no more and more while others call, come, go and die") {
  Soak soak(soak_length());
  soak.run();
  soak.check();
}
