#include <unistd.h>

#include <filesystem>

#include "calls/benchmarks.hpp"
#include "command/bench/random_turns.hpp"
#include "harness/goals.hpp"

namespace skein::benchmarks {
namespace {

constexpr const char* kClaim = "find_service among many descriptions";
constexpr const char* kChoosing =
    "find_service by constraints among many providers of one interface";
constexpr const char* kLimit = "limit 1 us";
constexpr std::uint32_t kSeed = 19;

/// Where the name server keeps its log; gone with this object.
class LogFolder {
 public:
  LogFolder() { std::filesystem::create_directories(path_); }
  ~LogFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  LogFolder(const LogFolder&) = delete;
  LogFolder& operator=(const LogFolder&) = delete;
  std::string path() const { return path_.string(); }

 private:
  const std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                      ("skein-benchmark-names-" + std::to_string(getpid()));
};

/// A process that knows `bind COUNT` and `find COUNT`, and what it needs beside it. Skein's knows
/// `choose COUNT`, too.
class Finder {
 public:
  explicit Finder(const Configuration& configuration) : name_(configuration.name) {
    absence_ = attempt(name_, [&] {
      if (!configuration.server.empty()) service_.emplace(configuration.server);
      client_.emplace(configuration.client);
      client_->receive();
    });
  }

  void bind(std::size_t count) {
    if (!absence_) absence_ = attempt(name_, [&] { ask("bind", count); });
  }

  /// Adds to `outcome`, or tells there why it cannot.
  void search(const char* how, std::size_t count, Outcome& outcome) {
    if (!absence_) {
      absence_ = attempt(name_, [&] {
        for (const double time : times_us(ask(how, count))) outcome.samples.push_back(time);
      });
    }
    outcome.absence = absence_;
  }

 private:
  std::string ask(const char* command, std::size_t count) {
    client_->send(std::string(command) + ' ' + std::to_string(count));
    return client_->receive();
  }

  const std::string name_;
  std::optional<Child> service_;
  std::optional<Child> client_;
  Absence absence_;
};

Comparison search_comparison(const char* claim, const char* rival, std::size_t count,
                             const Outcome& own, const Outcome& other) {
  Comparison comparison{claim, "skein", rival, {{"descriptions", count}}};
  comparison.parameters["placement"] = "anywhere";
  fill(comparison, own, other);
  return comparison;
}

}  // namespace

std::vector<Comparison> compare_find_service(Configurations& configurations, const FindPlan& plan) {
  const LogFolder log;
  Finder own(configurations.skein_finder());
  Finder other(configurations.name_server(log.path()));
  const Outcome promise{{kLookUpUs}};
  std::vector<Comparison> comparisons;
  for (const std::size_t count : {10, 100, 1000, 10'000}) {
    own.bind(count);
    other.bind(count);
    Outcome found, found_there, chosen;
    take_turns(plan.rounds,
               {[&] { own.search("find", plan.searches, found); },
                [&] { other.search("find", plan.searches, found_there); }},
               kSeed);
    for (std::size_t i = 0; i < plan.rounds; ++i) own.search("choose", plan.searches, chosen);
    comparisons.push_back(
        search_comparison(kClaim, "omniORB's name server", count, found, found_there));
    comparisons.push_back(search_comparison(kClaim, kLimit, count, found, promise));
    // omniORB's name server knows no constraints.
    comparisons.push_back(search_comparison(kChoosing, kLimit, count, chosen, promise));
  }
  return comparisons;
}

}  // namespace skein::benchmarks
