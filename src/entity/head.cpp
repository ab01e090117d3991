#include "skein/entity/head.hpp"

#include <algorithm>

#include "skein/discovery.idl.hpp"
#include "skein/brokerless_discovery/process_watch.hpp"
#include "skein/core/call_context.hpp"
#include "skein/core/error.hpp"
#include "skein/core/suggestion.hpp"

namespace skein {
namespace {

using brokerless_discovery::number_attribute;
using brokerless_discovery::ServiceDescription;

constexpr std::size_t kKeptDecisions = 64;

// What carrying the answer back to the caller may take of the time that it has given.
constexpr std::chrono::milliseconds kAnswerReserve{3};

// A CSP whose connection is not open by then is passed over: it is about to leave, or was not found.
constexpr std::chrono::seconds kOpeningPatience{2};

class HeadSession final : public Session {
 public:
  explicit HeadSession(std::shared_ptr<const SelectionStrategy> strategy)
      : strategy_(std::move(strategy)) {}
  const SelectionStrategy& strategy() const noexcept { return *strategy_; }

 private:
  std::shared_ptr<const SelectionStrategy> strategy_;
};

Candidate candidate_of(const ServiceDescription& description, bool in_process) {
  Candidate candidate;
  candidate.name = description.entity;
  candidate.provider = {description.provider};
  candidate.in_process = in_process;
  candidate.pid = description.pid;
  candidate.quality = number_attribute(description, "quality").value_or(0);
  if (const auto latency_ms = number_attribute(description, "latency")) {
    candidate.latency =
        std::chrono::duration_cast<Duration>(std::chrono::duration<double, std::milli>(*latency_ms));
  }
  return candidate;
}

Duration time_left(const Clock& clock, Duration limit) {
  const CallContext* context = CallContext::current();
  if (!context) return limit;
  return std::min(limit, context->deadline() - clock.now() - Duration(kAnswerReserve));
}

}  // namespace

const char* to_string(Attempt::Outcome outcome) noexcept {
  switch (outcome) {
    case Attempt::Outcome::Accepted: return "accepted";
    case Attempt::Outcome::Rejected: return "rejected";
    case Attempt::Outcome::Refused: return "refused";
    case Attempt::Outcome::TimedOut: return "timed out";
    case Attempt::Outcome::Disconnected: return "disconnected";
    case Attempt::Outcome::Failed: break;
  }
  return "failed";
}

Head::Head(Connector& connector, brokerless_discovery::Broker& broker,
           std::shared_ptr<rpc::LocalDirectory> directory, Clock& clock)
    : connector_(connector), broker_(broker), directory_(std::move(directory)), clock_(clock) {
  add_strategy(make_declared_selection());
  add_strategy(make_fixed_order_selection());
}

void Head::add_strategy(std::shared_ptr<const SelectionStrategy> strategy) {
  std::lock_guard lock(mutex_);
  const std::string name = strategy->name();
  strategies_[name] = std::move(strategy);
}

std::shared_ptr<Session> Head::initialize(const rpc::OpenRequest& request) const {
  std::lock_guard lock(mutex_);
  const std::string name = request.strategy.empty() ? "declared" : request.strategy;
  if (const auto found = strategies_.find(name); found != strategies_.end()) {
    return std::make_shared<HeadSession>(found->second);
  }
  std::vector<std::string> known;
  std::string list;
  for (const auto& [known_name, strategy] : strategies_) {
    known.push_back(known_name);
    list += (list.empty() ? "" : ", ") + known_name;
  }
  throw InvalidArgument("unknown selection strategy '" + name + "'" + suggestion(name, known) +
                        "; there are: " + list);
}

const SelectionStrategy& Head::strategy() const {
  if (const CallContext* context = CallContext::current()) {
    if (const auto* session = dynamic_cast<const HeadSession*>(context->session())) {
      return session->strategy();
    }
  }
  std::lock_guard lock(mutex_);
  return *strategies_.at("declared");
}

std::vector<Candidate> Head::candidates(const InterfaceInfo& interface, const std::string& only) const {
  auto query = broker_.query(std::string(interface.name));
  query.client = &interface;
  std::vector<Candidate> candidates;
  for (const auto& description : broker_.find_service(query)) {
    const auto local = directory_->find({description->provider});
    // An instance that overran its time is never entered again before it has come back.
    if (local && local->overdue()) continue;
    if (only.empty() || description->entity == only) {
      candidates.push_back(candidate_of(*description, local != nullptr));
    }
  }
  if (!candidates.empty()) return candidates;
  throw Unavailable(only.empty() ? broker_.explain(query)
                                 : "the planner or other CSP '" + only + "' does not stand by for " +
                                       std::string(interface.name));
}

void Head::decide(const InterfaceInfo& interface, const std::string& only, Duration limit,
                  const Try& attempt, DecisionRecord& record) {
  const Instant begin = clock_.now();
  const SelectionStrategy& strategy = this->strategy();
  record = {};
  record.interface = interface.name;
  record.strategy = strategy.name();
  record.available = time_left(clock_, limit);
  const Instant deadline = begin + record.available;
  record.candidates = candidates(interface, only);
  std::vector<Candidate> left = record.candidates;
  Verdict verdict;
  verdict.error = std::make_exception_ptr(TimedOut("no time was left to run a CSP"));
  while (!left.empty() && clock_.now() < deadline) {
    const Instant attempt_begin = clock_.now();
    Selection selection = strategy.select(left, deadline - attempt_begin);
    const Candidate candidate = left[selection.candidate];
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(selection.candidate));
    verdict = try_candidate(candidate, selection.slice, attempt);
    record.attempts.push_back({candidate.name, selection.slice, clock_.now() - attempt_begin,
                               verdict.outcome, verdict.text, std::move(selection.reason)});
    if (verdict.settled || verdict.outcome == Attempt::Outcome::Accepted) break;
  }
  record.took = clock_.now() - begin;
  keep(record);
  if (verdict.outcome == Attempt::Outcome::Accepted) return;
  if (verdict.error) std::rethrow_exception(verdict.error);
  throw Internal("no result was good enough; the last one: " + verdict.text);
}

Head::Verdict Head::try_candidate(const Candidate& candidate, Duration slice, const Try& attempt) {
  const Instant end = clock_.now() + slice;
  std::uint64_t run;
  {
    std::lock_guard lock(mutex_);
    run = ++last_run_;
    running_[run] = {candidate.name, candidate.pid, brokerless_discovery::ProcessWatch::host()};
  }
  Verdict verdict;
  try {
    auto channel = channel_to(candidate, std::min(slice, Duration(kOpeningPatience)));
    verdict = attempt(std::move(channel), std::max(Duration::zero(), end - clock_.now()), candidate);
  } catch (...) {
    verdict = verdict_of(std::current_exception());
  }
  std::lock_guard lock(mutex_);
  running_.erase(run);
  return verdict;
}

std::shared_ptr<Channel> Head::channel_to(const Candidate& candidate, Duration timeout) {
  {
    std::lock_guard lock(mutex_);
    std::erase_if(channels_, [](const auto& entry) { return !entry.second->connected(); });
    if (const auto found = channels_.find(candidate.provider); found != channels_.end()) {
      return found->second;
    }
  }
  for (const auto& description : broker_.all()) {
    if (description->provider != candidate.provider.bytes) continue;
    auto channel = connector_.open_provider(*description, {}, timeout);
    std::lock_guard lock(mutex_);
    return channels_.insert_or_assign(candidate.provider, std::move(channel)).first->second;
  }
  throw Unavailable(candidate.name + " left before it could be asked");
}

Head::Verdict Head::verdict_of(std::exception_ptr error) {
  Verdict verdict;
  verdict.error = error;
  try {
    std::rethrow_exception(error);
  } catch (const UserException& exception) {
    verdict.outcome = Attempt::Outcome::Refused;
    verdict.text = exception.what();
  } catch (const TimedOut& exception) {
    verdict.outcome = Attempt::Outcome::TimedOut;
    verdict.text = exception.what();
  } catch (const Disconnected& exception) {
    verdict.outcome = Attempt::Outcome::Disconnected;
    verdict.text = exception.what();
  } catch (const std::exception& exception) {
    verdict.text = exception.what();
  } catch (...) {
    verdict.text = "it threw something that is no std::exception";
  }
  return verdict;
}

void Head::keep(const DecisionRecord& record) {
  std::lock_guard lock(mutex_);
  decisions_.push_back(record);
  decisions_.back().number = ++last_decision_;
  if (decisions_.size() > kKeptDecisions) decisions_.pop_front();
}

std::vector<Head::Current> Head::running() const {
  std::lock_guard lock(mutex_);
  std::vector<Current> running;
  for (const auto& [run, current] : running_) running.push_back(current);
  return running;
}

std::vector<DecisionRecord> Head::decisions() const {
  std::lock_guard lock(mutex_);
  return {decisions_.begin(), decisions_.end()};
}

}  // namespace skein
