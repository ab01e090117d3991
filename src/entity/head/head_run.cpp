#include "head_run.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "selection/decision_record.hpp"
#include "selection/slice.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

using introspection::Attempt;
using introspection::Outcome;
using task_run::Verdict;

// A CSP whose connection is not open by then is passed over: it is about to leave, or was not
// found.
constexpr std::chrono::seconds kOpeningPatience{2};

/// Of Skein's errors those that say nothing of CSPs get the name before their text.
[[noreturn]] void rethrow_naming(const std::string& csp, const std::exception_ptr& error,
                                 const std::string& more) {
  try {
    std::rethrow_exception(error);
  } catch (const NoCandidate&) {
    throw;
  } catch (const NoneAccepted&) {
    throw;
  } catch (const Error& named) {
    if (csp.empty()) throw;
    throw_error(named.code(), "CSP '" + csp + "': " + named.what() + more);
  }
}

/// Why a CSP is at fault.
std::string reason(const Attempt& attempt) {
  if (attempt.check.empty()) return attempt.text;
  return "the check '" + attempt.check + "' rejects its result: " + attempt.text;
}

}  // namespace

Verdict task_run::verdict_of_current_exception() {
  Verdict verdict;
  verdict.error = std::current_exception();
  try {
    throw;
  } catch (const UserException& exception) {
    verdict.outcome = Outcome::Refused;
    verdict.fault = false;
    verdict.text = exception.what();
  } catch (const Error& error) {
    verdict.text = error.what();
    if (error.code() == ErrorCode::TimedOut) verdict.outcome = Outcome::TimedOut;
    if (error.code() == ErrorCode::Disconnected) verdict.outcome = Outcome::Disconnected;
    // Not executed: nothing is known of how it works.
    verdict.fault = !is_refusal(error.code());
  } catch (const std::exception& exception) {
    verdict.text = exception.what();
  } catch (...) {
    verdict.text = "it threw something that is no std::exception";
  }
  return verdict;
}

void task_run::throw_as_thrown_by(const std::string& who, const std::exception_ptr& thrown) {
  const std::string threw = who + " threw: ";
  try {
    std::rethrow_exception(thrown);
  } catch (const UserException&) {
    throw;
  } catch (const Error& error) {
    throw_error(error.code(), threw + error.what());
  } catch (const std::exception& error) {
    throw Internal(threw + error.what());
  } catch (...) {
    throw Internal(threw + "something that is no std::exception");
  }
}

Verdict task_run::verdict_on_body(const std::string& who, const std::exception_ptr& thrown) {
  Verdict verdict;
  try {
    throw_as_thrown_by(who, thrown);
  } catch (const UserException& exception) {
    verdict.text = who + " threw: " + exception.what();
    verdict.error = thrown;
  } catch (const Error& error) {
    verdict.text = error.what();
    verdict.error = std::current_exception();
  }
  verdict.fault = false;
  verdict.own = true;
  return verdict;
}

void Head::Run::Bell::ring() {
  std::lock_guard lock(mutex_);
  rung_ = true;
  changed_.notify_one();
}

void Head::Run::Bell::await() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return rung_; });
  rung_ = false;
}

Head::Run::Run(State& state, const InterfaceInfo& interface, const SelectionStrategy& strategy,
               task_run::TaskRun& task, const std::vector<Candidate>& candidates,
               introspection::Decision& record, Instant begin)
    : state_(state),
      interface_(interface),
      task_(task),
      record_(record),
      begin_(begin),
      deadline_(saturating_sum(begin, wire_values::duration(record.available))),
      strategy_(strategy),
      features_(std::make_shared<const Features>(task.options().features)),
      iterator_(strategy, candidates, decision_record::situation_of(record)),
      lost_(task.options().only) {
  decision_record::list(record_, candidates);
}

bool Head::Run::run() {
  try {
    run_all();
  } catch (...) {  // a strategy's or a synthesis's own
    cancel_rest();
    throw;
  }
  cancel_rest();
  return done_;
}

void Head::Run::run_all() {
  while (!done_ && !settled_) {
    while (begin_another()) {
    }
    if (live_.empty()) {
      if (!look_again()) break;
      continue;
    }
    await();
    judge_ready();
  }
  if (!done_ && !settled_) {
    if (auto how = task_.synthesise()) {
      record_.synthesis = std::move(*how);
      note_too_few();
      done_ = true;
    }
  }
}

bool Head::Run::too_few() const {
  const std::size_t enough = task_.options().enough;
  return enough != TaskOptions::kAll && task_.accepted() < enough;
}

// The result is made of what there was.
void Head::Run::note_too_few() {
  if (!too_few()) return;
  record_.synthesis += (record_.synthesis.empty() ? "of " : "; of ") +
                       std::to_string(task_.accepted()) + " results, where " +
                       std::to_string(task_.options().enough) + " were to be waited for";
}

// Whether it was stopped at the end of its slice, while more time than that is left.
bool Head::Run::may_have_another_turn(const std::string& csp) const {
  const Duration left = deadline_ - now();
  const auto last = std::find_if(record_.attempts.rbegin(), record_.attempts.rend(),
                                 [&](const Attempt& attempt) { return attempt.csp == csp; });
  return last != record_.attempts.rend() && last->outcome == Outcome::TimedOut &&
         wire_values::duration(last->slice) < left;
}

// Where all have failed others may have joined: those that left, say, have been replaced.
bool Head::Run::look_again() {
  std::vector<Candidate> joined;
  do {
    if (done_ || settled_ || now() >= deadline_) return false;
    const std::uint64_t seen = state_.parts.broker.generation();
    joined = this->joined();
    if (joined.empty() && !await_return(seen)) return false;
  } while (joined.empty());
  ++round_;
  for (Candidate& candidate : joined) candidate.round = round_;
  decision_record::list(record_, joined);
  iterator_.add(std::move(joined));
  return true;
}

// A request at which a CSP died twice is not given to it a third time: it may be the cause.
std::vector<Candidate> Head::Run::joined() {
  auto joined = state_.candidates(interface_, task_.options(), strategy_, now());
  std::erase_if(joined, [&](const Candidate& candidate) {
    const bool known =
        std::any_of(record_.candidates.begin(), record_.candidates.end(),
                    [&](const auto& each) { return each.provider == candidate.provider.bytes; });
    return lost_.is_worn_out(candidate.name) || (known && !may_have_another_turn(candidate.name));
  });
  return joined;
}

// Only with nothing in hand: what there is is not held back.
bool Head::Run::await_return(std::uint64_t seen) {
  if (lost_.empty() || task_.accepted() > 0) return false;
  const bool changed = state_.await_change(interface_, lost_, seen, deadline_);
  waited_ = !changed;
  return changed;
}

bool Head::Run::begin_another() {
  if (done_ || settled_ || iterator_.done()) return false;
  const bool alone = live_.empty();
  const Execution execution = task_.options().execution;
  if (!alone && (execution == Execution::One || live_.size() >= task_.options().width))
    return false;
  const Instant now = this->now();
  if (now >= deadline_) return false;
  if (!alone && execution == Execution::Staggered && !(late_at_ && now >= *late_at_)) return false;
  begin(iterator_.next(deadline_ - now), now);
  return true;
}

void Head::Run::begin(CandidateIterator::Next next, Instant began) {
  Attempt& attempt = record_.attempts.emplace_back();
  decision_record::note_choice(attempt, next, deadline_ - began);
  attempt.round = round_;
  attempt.began = wire_values::ns(began - begin_);
  const auto run = state_.running.begin(
      interface_, next.candidate, state_.known.host_of(interface_, next.candidate.provider), began);
  if (!run) {
    attempt.outcome = Outcome::Cancelled;
    attempt.text = "it has been quarantined meanwhile";
    return;
  }
  const Selection& selection = next.selection;
  Live live{record_.attempts.size() - 1, std::move(next.candidate), *run, nullptr, nullptr};
  const Instant end = task_.options().execution == Execution::One
                          ? saturating_sum(began, selection.slice)
                          : deadline_;
  // What is late before the next may begin is late only by what it was expected to take.
  late_at_ = saturating_sum(began, selection.expected > Duration::zero()
                                       ? std::min(selection.expected, selection.slice)
                                       : selection.slice);
  try {
    Instant reached = began;
    live.channel = state_.channels.open(live.candidate,
                                        std::min(end - began, Duration(kOpeningPatience)), reached);
    {
      const entity::OverdueCsps::Watch watch(state_.overdue, interface_, live.candidate, end);
      live.work =
          task_.begin(live.channel, std::max(Duration::zero(), end - reached), live.candidate);
    }
    if (live.work->waited()) state_.warnings.tell_waiting(interface_, task_.options());
    live_.push_back(std::move(live));
  } catch (...) {
    Verdict verdict = task_run::verdict_of_current_exception();
    // It was not reached, and only for want of time: that says nothing of whether it is there.
    const bool too_late = now() >= deadline_;
    if (too_late) {
      verdict.error = std::make_exception_ptr(
          TimedOut("the time ran out before a CSP could be asked; the last one, '" +
                   live.candidate.name + "': " + verdict.text));
    }
    note(live, std::move(verdict));
    if (too_late) last_csp_.clear();
  }
}

bool Head::Run::waits_for_late_ones() const {
  return task_.options().execution == Execution::Staggered && !iterator_.done() &&
         live_.size() < task_.options().width;
}

// A CSP that works alone is waited for in its call itself.
void Head::Run::await() {
  if (live_.size() == 1 && !waits_for_late_ones()) return;
  for (const Live& live : live_) {
    if (live.work->ready()) return;
  }
  if (!bell_) bell_ = std::make_shared<Bell>();
  for (const Live& live : live_) live.work->notify([bell = bell_] { bell->ring(); });
  Clock& clock = state_.parts.clock;
  const TimerId timer = waits_for_late_ones()
                            ? clock.call_at(*late_at_, [bell = bell_] { bell->ring(); })
                            : TimerId(0);
  bell_->await();
  clock.cancel(timer);
}

void Head::Run::judge_ready() {
  const bool alone = live_.size() == 1 && !waits_for_late_ones();
  for (std::size_t i = 0; i < live_.size() && !done_ && !settled_;) {
    if (!alone && !live_[i].work->ready()) {
      ++i;
      continue;
    }
    Live live = std::move(live_[i]);
    live_.erase(live_.begin() + static_cast<std::ptrdiff_t>(i));
    note(live, live.work->judge());
    conclude_if_enough();
  }
}

void Head::Run::note(Live& live, Verdict verdict) {
  Attempt& attempt = record_.attempts[live.attempt];
  const Duration took = now() - begin_ - wire_values::duration(attempt.began);
  const Duration expected = wire_values::duration(attempt.expected);
  attempt.took = wire_values::ns(took);
  attempt.outcome = verdict.outcome;
  attempt.check = std::move(verdict.check);
  attempt.text = verdict.text;
  attempt.quality = wire_values::list(verdict.quality);
  // Late by less is a matter of load, and for the history.
  const bool hardly_late = verdict.outcome == Outcome::TimedOut && took / kHangs < expected;
  const bool fault = verdict.fault && !hardly_late;
  state_.end(interface_, live.candidate, features_, live.run,
             {verdict.outcome, took, expected, verdict.quality, fault, verdict.settled, verdict.own,
              fault ? reason(attempt) : std::string(), record_.decided + 1,
              static_cast<std::uint32_t>(live.attempt)});
  if (verdict.outcome == Outcome::Disconnected && live.channel && !live.channel->connected())
    lost_.add(live.candidate, now());
  settled_ = verdict.settled;
  last_csp_ = verdict.own ? std::string() : live.candidate.name;
  last_ = std::move(verdict);
}

void Head::Run::conclude_if_enough() {
  const std::size_t enough = task_.options().enough;
  if (last_.outcome != Outcome::Accepted || enough == TaskOptions::kAll ||
      task_.accepted() < enough)
    return;
  if (auto how = task_.synthesise()) {
    record_.synthesis = std::move(*how);
    done_ = true;
  }
}

void Head::Run::cancel_rest() {
  for (Live& live : live_) {
    Verdict verdict;
    verdict.outcome = Outcome::Cancelled;
    verdict.fault = false;
    verdict.text = done_ ? "others were enough" : "another CSP's word settled the matter";
    const Verdict last = std::exchange(last_, {});
    const std::string last_csp = last_csp_;
    note(live, std::move(verdict));
    last_ = last;
    last_csp_ = last_csp;
  }
  live_.clear();
}

// What is added to the last error where a CSP was waited for.
std::string Head::Run::in_vain() const {
  std::string text;
  if (!waited_) return text;
  for (const auto& csp : state_.parts.broker.absent(interface_.name))
    text += "; " + in_words(csp, now());
  return text;
}

void Head::Run::fail() const {
  if (task_.accepted() > 0 && !settled_ && too_few()) {
    std::set<std::string_view> csps;
    for (const auto& candidate : record_.candidates) csps.insert(candidate.csp);
    throw NoneAccepted(std::to_string(task_.options().enough) +
                       " accepted results are needed, and " + std::to_string(task_.accepted()) +
                       " came of " + std::to_string(csps.size()) +
                       " CSPs; lower `enough`, or provide further CSPs");
  }
  if (task_.accepted() > 0 && !settled_) {
    throw NoneAccepted("the results of " + std::to_string(task_.accepted()) + " CSPs do not agree");
  }
  if (lost_.is_worn_out(last_csp_)) {
    throw Internal("CSP '" + last_csp_ +
                   "' was lost at this request twice, and is not asked again, as the request "
                   "itself may be the cause: " +
                   last_.text);
  }
  if (last_.error) rethrow_naming(last_csp_, last_.error, in_vain());
  if (record_.attempts.empty()) throw TimedOut("no time was left to run a CSP");
  throw NoneAccepted("no result was good enough; the last one, of CSP '" + last_csp_ +
                     "': " + last_.text);
}

}  // namespace skein
