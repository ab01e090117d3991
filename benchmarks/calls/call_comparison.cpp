#include <cstdio>
#include <map>

#include "calls/benchmarks.hpp"
#include "harness/turns.hpp"

namespace skein::benchmarks {
namespace {

constexpr const char* kClaim = "a call over DDS";
constexpr std::uint32_t kSeed = 7;

/// One configuration and what was measured of it.
struct Contender {
  explicit Contender(Configuration made) : configuration(std::move(made)) {
    try {
      running.emplace(configuration);
    } catch (const Skipped& reason) {
      skipped = reason.what();
    }
  }

  void take_turn(const CallPlan::Size& size) {
    if (!running) return;
    running->call(size.size_bytes, size.calls_per_turn / 10 + 1);  // wakes the processes up
    const auto measured = running->call(size.size_bytes, size.calls_per_turn);
    auto& all = samples[size.size_bytes];
    all.insert(all.end(), measured.begin(), measured.end());
  }

  Configuration configuration;
  std::optional<Running> running;
  std::string skipped;
  std::map<std::size_t, std::vector<double>> samples;
};

class Contest {
 public:
  Contest(Configurations& configurations, const CallPlan& plan) : plan_(plan) {
    for (const auto& [server, client] : vendor_pairs()) {
      enter(configurations.skein(server, client));
      enter(configurations.raw(server, client));
    }
    enter(configurations.unix_socket());
  }

  void run() {
    std::vector<std::function<void()>> turns;
    for (auto& [name, contender] : contenders_) {
      for (const auto& size : plan_.sizes) {
        turns.push_back([&contender = contender, size] { contender.take_turn(size); });
      }
    }
    take_turns(plan_.rounds, std::move(turns), kSeed, [this](std::size_t round) {
      std::fprintf(stderr, "\rcalls: round %zu of %zu ", round + 1, plan_.rounds);
    });
    std::fputc('\n', stderr);
    for (auto& [name, contender] : contenders_) contender.running.reset();
  }

  Comparison compare(const std::string& subject, const std::string& rival, std::size_t size) const {
    const Contender& own = contenders_.at(subject);
    const Contender& other = contenders_.at(rival);
    Comparison comparison{kClaim, subject, rival, {{"size_bytes", size}, {"rounds", plan_.rounds}}};
    comparison.skipped = !own.skipped.empty() ? own.skipped : other.skipped;
    if (comparison.skipped.empty()) {
      comparison.samples = own.samples.at(size);
      comparison.rival_samples = other.samples.at(size);
    }
    return comparison;
  }

  /// The vendor whose raw call is the slower one at this size: a mixed pair can be no better.
  std::string slower_raw(const std::string& server, const std::string& client, std::size_t size) const {
    const auto median = [&](const std::string& vendor) {
      const auto& samples = contenders_.at("raw " + vendor).samples;
      const auto found = samples.find(size);
      return found == samples.end() ? 0 : summarize(found->second).p50;
    };
    return "raw " + (median(server) >= median(client) ? server : client);
  }

 private:
  void enter(Configuration configuration) {
    std::fprintf(stderr, "starting: %s\n", configuration.name.c_str());
    const std::string name = configuration.name;
    contenders_.emplace(name, std::move(configuration));
  }

  const CallPlan& plan_;
  std::map<std::string, Contender> contenders_;
};

}  // namespace

std::vector<Comparison> compare_calls(Configurations& configurations, const CallPlan& plan) {
  Contest contest(configurations, plan);
  contest.run();
  std::vector<Comparison> comparisons;
  for (const auto& [server, client] : vendor_pairs()) {
    const std::string pair = server == client ? server : server + "-" + client;
    for (const auto& size : plan.sizes) {
      auto main = contest.compare("skein " + pair, contest.slower_raw(server, client, size.size_bytes),
                                  size.size_bytes);
      main.goal_p50 = 1.2;
      comparisons.push_back(std::move(main));
      if (server != client) {
        comparisons.push_back(contest.compare("skein " + pair, "raw " + pair, size.size_bytes));
      }
      comparisons.push_back(contest.compare("skein " + pair, "unix socket", size.size_bytes));
      comparisons.push_back(contest.compare("raw " + pair, "unix socket", size.size_bytes));
    }
  }
  return comparisons;
}

}  // namespace skein::benchmarks
