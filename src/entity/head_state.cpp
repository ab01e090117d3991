#include "head_state.hpp"

#include <algorithm>

#include "head_session.hpp"
#include "skein/brokerless_discovery/process_watch.hpp"
#include "skein/core/call_context.hpp"
#include "skein/core/error.hpp"
#include "skein/core/log.hpp"
#include "skein/idl/type_support.hpp"
#include "skein/introspection.idl.hpp"

namespace skein {
namespace {

using Outcome = Attempt::Outcome;

constexpr std::size_t kKeptDecisions = 64;

// A CSP runs on its Body's thread if as many like runs as a prediction rests on were quick, and the
// task has so much time that the system's load is not taken for a hang.
constexpr std::size_t kRunsBeforeInline = History::kNeighbours;
constexpr std::chrono::milliseconds kTimeInline{100};

}  // namespace

Head::State::State(const Parts& parts_, HeadOptions options_)
    : parts(parts_),
      options(std::move(options_)),
      host(brokerless_discovery::ProcessWatch::host()),
      watch(std::make_shared<entity::InlineWatch>(parts_.clock, parts_.control)),
      topic(parts.participant, parts.control) {
  strategies.make(options.strategy);
  if (!options.history.empty()) history = History::load(options.history);
  if (options.log.empty()) return;
  log_file.open(options.log, std::ios::app | std::ios::binary);
  if (!log_file) {
    throw InvalidArgument("the Head of " + parts.entity + " cannot write its decisions to '" +
                          options.log + "'; name a file in a folder that may be written to");
  }
}

std::shared_ptr<const SelectionStrategy> Head::State::strategy() const {
  if (const CallContext* context = CallContext::current()) {
    if (const auto* session = dynamic_cast<const entity::HeadSession*>(context->session()))
      return session->strategy;
  }
  std::lock_guard lock(mutex);
  return strategies.make(options.strategy);
}

Head::State::Standing& Head::State::standing(std::string_view interface, std::string_view csp) {
  const auto found = standings.find(ByCsp::View(interface, csp));
  if (found != standings.end()) return found->second;
  const Standing first{CircuitBreaker(options.breaker), history.was_late(interface, csp)};
  return standings.try_emplace({std::string(interface), std::string(csp)}, first).first->second;
}

std::optional<Head::State::Beginning> Head::State::begin(const InterfaceInfo& interface,
                                                         const Candidate& candidate, Instant now,
                                                         Duration time) {
  std::lock_guard lock(mutex);
  Standing& standing = this->standing(interface.name, candidate.name);
  // Listed as open it is the last resort.
  if (standing.breaker.state(now) == CircuitBreaker::State::Open &&
      candidate.breaker != CircuitBreaker::State::Open) {
    return std::nullopt;
  }
  standing.breaker.begin(now);
  running.push_back({++last_run, candidate.name, candidate.pid});
  return Beginning{last_run, room_inline(candidate, standing, time)};
}

std::size_t Head::State::room_inline(const Candidate& candidate, const Standing& standing,
                                     Duration time) const {
  const auto& learned = candidate.learned;
  const bool quick = learned && learned->samples >= kRunsBeforeInline && learned->median &&
                     *learned->median <= options.quick;
  if (!candidate.in_process || standing.hung || !quick || time < kTimeInline) return 0;
  return options.most_stuck - std::min(options.most_stuck, hung.size());
}

void Head::State::end(const InterfaceInfo& interface, const Candidate& candidate,
                      const Features& features, std::uint64_t run, const Attempt& attempt,
                      bool fault) {
  const bool timed_out = attempt.outcome == Outcome::TimedOut;
  const bool is_told = timed_out && fault && attempt.expected > Duration::zero() &&
                       !candidate.in_process && options.on_hang;
  {
    std::lock_guard lock(mutex);
    std::erase_if(running, [&](const Running& each) { return each.run == run; });
    Standing& standing = this->standing(interface.name, candidate.name);
    if (is_told) {  // it may be ended
      standing.breaker.trip(parts.clock.now());
    } else if (fault) {
      standing.breaker.fail(parts.clock.now());
    } else if (attempt.outcome == Outcome::Accepted || attempt.outcome == Outcome::Refused) {
      standing.breaker.succeed();
    } else {
      standing.breaker.end();
    }
    learn(interface, candidate, features, attempt);
    if (timed_out && candidate.in_process) {
      standing.hung = true;
      hung.insert(candidate.provider);
    }
  }
  if (is_told) options.on_hang(candidate);
}

void Head::State::distrust(const InterfaceInfo& interface, const Candidate& candidate) {
  std::lock_guard lock(mutex);
  Standing& standing = this->standing(interface.name, candidate.name);
  standing.breaker.trip(parts.clock.now());
  standing.hung = true;
  hung.erase(candidate.provider);  // its worker is counted
}

void Head::State::learn(const InterfaceInfo& interface, const Candidate& candidate,
                        const Features& features, const Attempt& attempt) {
  const bool overran = attempt.expected > Duration::zero() && attempt.took > attempt.expected;
  const bool late =
      attempt.outcome == Outcome::TimedOut || (attempt.outcome == Outcome::Cancelled && overran);
  if (attempt.outcome == Outcome::Cancelled && !late) return;
  history.add(
      interface.name, candidate.name,
      {features, attempt.took, attempt.outcome == Outcome::Accepted, late, attempt.quality});
}

std::size_t Head::State::count_stuck() {
  std::lock_guard lock(mutex);
  return stuck();
}

// Under the lock.
std::size_t Head::State::stuck() {
  std::erase_if(hung, [&](const Guid& provider) {
    const auto service = parts.directory->find(provider);
    return !service || !service->overdue();
  });
  const std::size_t stuck = hung.size() + watch->lost();
  const bool degraded = stuck >= options.most_stuck;
  if (degraded && !was_degraded) {
    log(LogLevel::Error, parts.entity,
        std::to_string(stuck) + " CSPs in this process do not return; it should be restarted");
  }
  was_degraded = degraded;
  return stuck;
}

void Head::State::conclude(DecisionRecord&& record, DecisionRecord* wanted) {
  const bool explored = std::any_of(record.attempts.begin(), record.attempts.end(),
                                    [](const Attempt& attempt) { return attempt.explores; });
  const bool told = topic.on() || !options.log.empty();
  std::optional<DecisionRecord> copy;
  std::optional<DecisionRecord> dropped;  // outside the lock
  {
    std::lock_guard lock(mutex);
    record.stuck = stuck();
    history.count(record.interface, explored);
    record.number = ++last_decision;
    if (told || wanted) copy = record;
    decisions.push_back(std::move(record));
    if (decisions.size() > kKeptDecisions) {
      dropped = std::move(decisions.front());
      decisions.pop_front();
    }
  }
  if (told) topic.tell(*copy);
  if (!options.log.empty()) write_log(*copy);
  if (wanted) *wanted = std::move(*copy);
}

void Head::State::write_log(const DecisionRecord& record) {
  const std::string line = idl::to_json(report_of(record));
  std::lock_guard lock(log_mutex);
  log_file << line << std::endl;
  if (log_file) return;
  log_file.clear();
  log(LogLevel::Warning, parts.entity, "a decision could not be written to '" + options.log + "'");
}

}  // namespace skein
