#include <unistd.h>

#include <filesystem>

#include "calls/benchmarks.hpp"
#include "harness/goals.hpp"
#include "harness/skipped.hpp"
#include "harness/turns.hpp"

namespace skein::benchmarks {
namespace {

constexpr const char* kClaim = "find_service among many descriptions";
constexpr const char* kChoosing = "find_service by constraints among many providers of one interface";
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
struct Finder {
  std::optional<Child> service{};
  std::optional<Child> client{};
  std::string skipped{};

  explicit Finder(const Configuration& configuration) {
    try {
      if (!configuration.server.empty()) service.emplace(configuration.server);
      client.emplace(configuration.client);
      client->receive();
    } catch (const Skipped& reason) {
      skipped = reason.what();
    }
  }

  std::vector<double> search(const char* how, std::size_t count) {
    client->send(std::string(how) + ' ' + std::to_string(count));
    return times_us(client->receive());
  }

  void bind(std::size_t count) {
    client->send("bind " + std::to_string(count));
    client->receive();
  }
};

Comparison measure(Finder& own, Finder& other, std::size_t count, const FindPlan& plan) {
  Comparison comparison{kClaim, "skein", "omniORB's name server", {{"descriptions", count}}};
  comparison.parameters["placement"] = "anywhere";
  comparison.skipped = own.skipped.empty() ? other.skipped : own.skipped;
  if (!comparison.skipped.empty()) return comparison;
  other.bind(count);
  const auto add = [&](std::vector<double>& samples, Finder& finder) {
    for (const double time : finder.search("find", plan.searches)) samples.push_back(time);
  };
  take_turns(plan.rounds,
             {[&] { add(comparison.samples, own); }, [&] { add(comparison.rival_samples, other); }},
             kSeed);
  return comparison;
}

/// Beside the promise alone: omniORB's name server knows no constraints.
Comparison measure_choosing(Finder& own, std::size_t count, const FindPlan& plan) {
  Comparison comparison{kChoosing, "skein", kLimit, {{"descriptions", count}}};
  comparison.parameters["placement"] = "anywhere";
  comparison.rival_samples = {kLookUpUs};
  comparison.skipped = own.skipped;
  for (std::size_t round = 0; round < plan.rounds && own.skipped.empty(); ++round) {
    for (const double time : own.search("choose", plan.searches)) comparison.samples.push_back(time);
  }
  return comparison;
}

}  // namespace

std::vector<Comparison> compare_find_service(Configurations& configurations, const FindPlan& plan) {
  const LogFolder log;
  Finder own(configurations.skein_finder());
  Finder other(configurations.name_server(log.path()));
  std::vector<Comparison> comparisons;
  for (const std::size_t count : {10, 100, 1000, 10'000}) {
    if (own.skipped.empty()) own.bind(count);
    comparisons.push_back(measure(own, other, count, plan));
    if (comparisons.back().skipped.empty()) {
      Comparison limited = comparisons.back();
      limited.rival = kLimit;
      limited.rival_samples = {kLookUpUs};
      comparisons.push_back(std::move(limited));
    }
    comparisons.push_back(measure_choosing(own, count, plan));
  }
  return comparisons;
}

}  // namespace skein::benchmarks
