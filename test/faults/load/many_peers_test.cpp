// Many peers that start at once. SKEIN_PEERS and SKEIN_STARTS tell how many and how often,
// SKEIN_PATIENCE how many seconds a registry may take.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <list>
#include <set>
#include <sstream>

#include "test/faults/processes.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

using SteadyClock = std::chrono::steady_clock;

std::size_t number_from(const char* variable, std::size_t otherwise) {
  const char* given = std::getenv(variable);
  return given != nullptr ? std::stoul(given) : otherwise;
}

/// Only a broken registry is not complete by then: on two busy processors 50 peers take some 15 s.
const auto kPatient = std::chrono::seconds(number_from("SKEIN_PATIENCE", 120));

std::set<std::string> words_of(const std::string& line) {
  std::istringstream words(line);
  std::set<std::string> all;
  for (std::string word; words >> word;) all.insert(word);
  return all;
}

/// Peers of the pairing's vendors in turn, each in a process of its own, each with one service.
class Crowd {
 public:
  explicit Crowd(std::size_t size) : begin_(SteadyClock::now()) {
    const auto& pairing = Pairing::get();
    for (std::size_t i = 0; i < size; ++i) {
      const auto& vendor = i % 2 == 0 ? *pairing.server : *pairing.client;
      members_.emplace_back("peer" + std::to_string(i) + "_" + vendor.name(), vendor);
      members_.back().process.send("provide");
      members_.back().process.send(gathering(size));
    }
  }

  /// Waits until each peer has told whose services it knows, then asks all of them once more: the
  /// later ones find them all still there. What is missing, in words.
  std::string shortfall() {
    for (Member& member : members_) {
      member.process.expect("provided", kPatient);
      member.process.expect("known", 2 * kPatient);
    }
    took_ = SteadyClock::now() - begin_;
    for (Member& member : members_) member.process.send(gathering(members_.size()));
    std::string text;
    for (Member& member : members_)
      text += shortfall(member, words_of(member.process.expect("known", 2 * kPatient)));
    return text;
  }

  double seconds() const { return std::chrono::duration<double>(took_).count(); }

 private:
  struct Member {
    Member(const std::string& name_, const skein::dds::Vendor& vendor)
        : name(name_), process(start_peer(name_, vendor, {"keep_log=1"})) {}
    std::string name;
    ChildProcess process;
  };

  static std::string gathering(std::size_t size) {
    return "gather " + std::to_string(size) + " " + std::to_string(kPatient.count());
  }

  std::string shortfall(Member& member, const std::set<std::string>& known) {
    constexpr std::size_t kNamed = 8;
    std::size_t missing = 0;
    std::string names;
    for (const Member& other : members_) {
      if (known.contains(other.name) || ++missing > kNamed) continue;
      names += " " + other.name;
    }
    if (missing == 0) return "";
    return member.name + " lacks " + std::to_string(missing) + ", among them" + names + "; it " +
           member.process.ask("logged") + "\n";
  }

  const SteadyClock::time_point begin_;
  SteadyClock::duration took_{};
  std::list<Member> members_;
};

}  // namespace

TEST_CASE("each of many peers that start at once finds the services of all others") {
  const std::size_t peers = number_from("SKEIN_PEERS", 20);
  const std::size_t starts = number_from("SKEIN_STARTS", 1);
  for (std::size_t start = 1; start <= starts; ++start) {
    Crowd crowd(peers);
    const std::string missing = crowd.shortfall();
    std::printf("start %zu of %zu: %zu peers took %.1f s\n", start, starts, peers, crowd.seconds());
    std::fflush(stdout);
    INFO("start " << start);
    CHECK(missing == "");
  }
}
