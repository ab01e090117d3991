#include "watch.hpp"

#include <algorithm>
#include <chrono>

#include "brokerless_discovery/broker.hpp"
#include "command/doctor/reading.hpp"
#include "core/printable.hpp"
#include "core/threads/start_thread.hpp"
#include "core/wall_clock.hpp"
#include "entity/entity_access.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein::command::designer {

using namespace std::chrono;

namespace {

constexpr std::size_t kLongestTrouble = 1024;

std::uint64_t steady_nanoseconds() {
  return static_cast<std::uint64_t>(
      duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count());
}

std::set<std::uint32_t> stopped_of(const std::vector<launch::MissionStatus>& missions) {
  std::set<std::uint32_t> stopped;
  for (const auto& mission : missions)
    for (const auto& process : mission.processes)
      if (process.pid != 0 && doctor::is_stopped(static_cast<int>(process.pid)))
        stopped.insert(process.pid);
  return stopped;
}

}  // namespace

LauncherWatch::LauncherWatch(std::uint32_t domain)
    : domain_(domain), thread_(start_thread("skein-launchers", [this] { run(); })) {}

LauncherWatch::~LauncherWatch() {
  {
    std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ends_.notify_all();
  thread_.join();
}

std::vector<launch::MissionStatus> LauncherWatch::missions() const {
  std::lock_guard lock(mutex_);
  std::vector<launch::MissionStatus> missions;
  for (const auto& [launcher, known] : known_) missions.push_back(known.status);
  return missions;
}

std::vector<std::string> LauncherWatch::troubles() const {
  std::lock_guard lock(mutex_);
  return troubles_;
}

void LauncherWatch::run() {
  std::unique_lock lock(mutex_);
  while (!ended_) {
    lock.unlock();
    const auto answers = launch::ask_launchers("status", domain_);
    const auto lines = launch::ask_launchers("lines", domain_);
    lock.lock();
    take(answers);
    take_lines(lines);
    ends_.wait_for(lock, 1s, [this] { return ended_; });
  }
}

void LauncherWatch::take(const std::vector<launch::LauncherAnswer>& answers) {
  const std::uint64_t now = steady_nanoseconds();
  troubles_.clear();
  for (const launch::LauncherAnswer& answer : answers) {
    const auto known = known_.find(answer.launcher);
    if (known != known_.end()) known->second.heard = now;
    try {
      if (!answer.failure.empty()) throw Unavailable(answer.failure);
      Known& heard = known_[answer.launcher];
      heard.heard = now;
      heard.status = idl::from_json<launch::MissionStatus>(answer.text);
    } catch (const Error& error) {
      const std::string name = known == known_.end() ? "" : known->second.status.mission + ": ";
      troubles_.push_back(printable(name + error.what(), kLongestTrouble));
    }
  }
  for (auto& [launcher, known] : known_) {
    if (known.heard == now || known.status.launcher == 0) continue;
    known.status.launcher = 0;
    if (known.status.ending.empty()) known.status.ending = "its launcher is gone";
    known.status.processes.clear();
  }
  std::erase_if(
      known_, [&](const auto& each) { return now - each.second.heard > StateMaker::kRemembered; });
}

/// Those that do not answer are told of by their status.
void LauncherWatch::take_lines(const std::vector<launch::LauncherAnswer>& answers) {
  for (const launch::LauncherAnswer& answer : answers) {
    const auto known = known_.find(answer.launcher);
    if (known == known_.end() || !answer.failure.empty()) continue;
    try {
      const auto told = idl::from_json<launch::MissionLines>(answer.text);
      known->second.lines.assign(told.lines.begin(), told.lines.end());
    } catch (const Error&) {  // of another version
      known->second.lines.clear();
    }
  }
}

std::vector<LogNote> LauncherWatch::lines() const {
  std::lock_guard lock(mutex_);
  std::vector<LogNote> notes;
  for (const auto& [launcher, known] : known_)
    for (const launch::MissionLine& line : known.lines)
      notes.push_back(note_of(line, known.status.mission));
  return notes;
}

void EventHistory::add(const introspection::Decision& decision) {
  std::lock_guard lock(mutex_);
  const std::pair key(decision.entity, decision.service);
  if (decisions_.size() >= kHeads && !decisions_.contains(key)) {
    decisions_.erase(std::ranges::min_element(
        decisions_, {}, [](const auto& each) { return each.second.back().time; }));
  }
  auto& latest = decisions_[key];
  latest.push_back(decision);
  if (latest.size() > kDecisions) latest.pop_front();
}

/// All entities of a process tell its lines, each with the same number.
void EventHistory::add(const introspection::LogLine& line) {
  std::lock_guard lock(mutex_);
  if (!known_lines_.emplace(line.host, line.pid, line.number).second) return;
  lines_.push_back(line);
  if (lines_.size() <= kLines) return;
  const auto& oldest = lines_.front();
  known_lines_.erase({oldest.host, oldest.pid, oldest.number});
  lines_.pop_front();
}

std::vector<introspection::Decision> EventHistory::latest_decisions() const {
  std::lock_guard lock(mutex_);
  std::vector<introspection::Decision> latest;
  for (const auto& [head, decisions] : decisions_) latest.push_back(decisions.back());
  return latest;
}

void EventHistory::tell(DomainState& state, std::vector<LogNote> printed) const {
  std::lock_guard lock(mutex_);
  for (const auto& [head, decisions] : decisions_) {
    for (const auto& decision : decisions) state.decisions.push_back(note_of(decision));
  }
  // The library prints its log lines, too, behind level and place.
  std::erase_if(printed, [&](const LogNote& note) {
    return std::ranges::any_of(lines_, [&](const introspection::LogLine& line) {
      return !line.text.empty() && note.text.ends_with(": " + line.text);
    });
  });
  for (const auto& line : lines_) state.log.push_back(note_of(line));
  for (LogNote& note : printed) state.log.push_back(std::move(note));
  std::ranges::stable_sort(state.decisions, {}, &DecisionNote::time);
  std::ranges::stable_sort(state.log, {}, &LogNote::time);
}

DomainWatch::DomainWatch(Entity& entity, std::uint32_t domain, std::optional<Plan> plan,
                         std::function<bool()> gives_up)
    : entity_(entity),
      maker_(std::move(plan)),
      look_(entity, std::move(gives_up)),
      launchers_(domain),
      statistics_(EntityAccess::participant(entity)),
      decisions_(EntityAccess::participant(entity), introspection::kTopic<introspection::Decision>,
                 [this](const introspection::Decision& each) { history_.add(each); }),
      log_(EntityAccess::participant(entity), introspection::kTopic<introspection::LogLine>,
           [this](const introspection::LogLine& each) { history_.add(each); }) {}

DomainState DomainWatch::look() {
  Observation sight;
  sight.picture = look_.take(true);
  std::erase_if(sight.picture, is_tool);
  sight.time = steady_nanoseconds();
  sight.wall_time = nanoseconds_since_1970();
  sight.statistics = statistics_.latest();
  sight.missions = launchers_.missions();
  sight.stopped = stopped_of(sight.missions);
  sight.decisions = history_.latest_decisions();
  DomainState state = maker_.make(sight);
  state.domain = launchers_.domain();
  state.place = entity_.broker().options().place;
  state.time = sight.wall_time;
  for (const std::string& trouble : launchers_.troubles()) state.troubles.push_back(trouble);
  for (auto& mission : sight.missions) state.missions.push_back(std::move(mission));
  history_.tell(state, launchers_.lines());
  return state;
}

}  // namespace skein::command::designer
