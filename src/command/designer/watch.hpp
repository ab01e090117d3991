#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "domain_state.hpp"
#include "entity/statistics_topic.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "rpc/service/introspection_topic.hpp"

namespace skein {
class Entity;
}

namespace skein::command::designer {

/// Asks this user's launchers once a second, on a thread of its own: a launcher that is stopped
/// delays the answer by ten seconds.
class LauncherWatch {
 public:
  explicit LauncherWatch(std::uint32_t domain);
  ~LauncherWatch();
  LauncherWatch(const LauncherWatch&) = delete;
  LauncherWatch& operator=(const LauncherWatch&) = delete;

  std::uint32_t domain() const noexcept { return domain_; }
  /// The last status of each launcher of the domain, and for a minute of those that have ended.
  std::vector<launch::MissionStatus> missions() const;
  /// Launchers that did not answer.
  std::vector<std::string> troubles() const;
  /// The last lines of their processes, printed or told by the launcher.
  std::vector<LogNote> lines() const;

 private:
  struct Known {
    launch::MissionStatus status;
    std::uint64_t heard = 0;  ///< Nanoseconds by a clock that is never set.
    std::vector<launch::MissionLine> lines{};
  };

  void run();
  void take(const std::vector<launch::LauncherAnswer>& answers);
  void take_lines(const std::vector<launch::LauncherAnswer>& answers);

  const std::uint32_t domain_;
  mutable std::mutex mutex_;
  std::condition_variable ends_;
  bool ended_ = false;
  std::map<pid_t, Known> known_;
  std::vector<std::string> troubles_;
  std::thread thread_;  // last: it uses the rest
};

/// The latest decisions of each Head and service, and the latest lines of logs. Thread-safe.
class EventHistory {
 public:
  void add(const introspection::Decision& decision);
  void add(const introspection::LogLine& line);

  std::vector<introspection::Decision> latest_decisions() const;  ///< One of each Head and service.
  /// Adds decisions and log lines, with `printed`, in order of time.
  void tell(DomainState& state, std::vector<LogNote> printed) const;

 private:
  static constexpr std::size_t kDecisions = 3;  // of each Head and service
  static constexpr std::size_t kHeads = 500;
  static constexpr std::size_t kLines = 300;

  mutable std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::deque<introspection::Decision>> decisions_;
  std::deque<introspection::LogLine> lines_;
  std::set<std::tuple<std::string, std::uint32_t, std::uint64_t>> known_lines_;
};

/// Looks at a domain. Its existence makes all entities tell their statistics, decisions and logs.
class DomainWatch {
 public:
  /// `entity` must outlive it. Throws as Inspector.
  DomainWatch(Entity& entity, std::uint32_t domain, std::optional<Plan> plan,
              std::function<bool()> gives_up);

  /// Waits for peers that do not answer, a second or two.
  DomainState look();

 private:
  Entity& entity_;
  StateMaker maker_;
  DomainLook look_;
  LauncherWatch launchers_;
  EventHistory history_;
  introspection::StatisticsReader statistics_;
  introspection::Reader<introspection::Decision> decisions_;  // its listener uses the history,
  introspection::Reader<introspection::LogLine> log_;         // and so does this one's
};

}  // namespace skein::command::designer
