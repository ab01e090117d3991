#include "skein/head.hpp"

#include <algorithm>
#include <cmath>

#include "core/wall_clock.hpp"
#include "dds/port/port.hpp"
#include "head_run.hpp"
#include "selection/decision_record.hpp"
#include "skein/call_context.hpp"
#include "skein/error.hpp"

namespace skein {

using introspection::Decision;
using introspection::Outcome;

namespace {

// What carrying the answer back to the caller may take of the time that it has given.
constexpr std::chrono::milliseconds kAnswerReserve{3};

Duration time_left(Instant now, Duration limit) {
  const CallContext* context = CallContext::current();
  if (!context) return limit;
  return std::min(limit, context->deadline() - now - Duration(kAnswerReserve));
}

void check_features(const Features& features) {
  for (auto feature = features.begin(); feature != features.end(); ++feature) {
    const auto refuse = [&](const std::string& why) {
      throw InvalidArgument("the feature '" + feature->name + "' of the task " + why);
    };
    if (!std::isfinite(feature->value)) refuse("is no finite number");
    const auto same = [&](const Feature& other) { return other.name == feature->name; };
    if (std::any_of(features.begin(), feature, same)) refuse("stands there twice");
  }
}

void check_options(const TaskOptions& task) {
  if (task.width == 0) {
    throw InvalidArgument("the task's `width` is 0, so that no CSP may work on it; give 1 or more");
  }
  if (task.enough == 0) {
    throw InvalidArgument(
        "the task's `enough` is 0, which no result is needed for; give 1 or more, or kAll");
  }
  if (!std::isfinite(task.utility.good_enough)) {
    throw InvalidArgument("the task's `utility.good_enough` is no finite number");
  }
  check_features(task.features);
}

}  // namespace

const char* to_string(Execution execution) noexcept {
  switch (execution) {
    case Execution::One:
      return "one";
    case Execution::Staggered:
      return "staggered";
    case Execution::All:
      break;
  }
  return "all";
}

Head::Head(const Parts& parts, HeadOptions options)
    : state_(std::make_unique<State>(parts, std::move(options))) {}

Head::~Head() = default;

void Head::add_strategy(std::shared_ptr<const SelectionStrategy> strategy) {
  state_->strategies.add(std::move(strategy));
}

std::shared_ptr<Session> Head::initialize(const rpc::OpenRequest& request) const {
  return state_->strategies.open(request.strategy);
}

Decision Head::open_record(const InterfaceInfo& interface, const SelectionStrategy& strategy,
                           const TaskOptions& task, Instant begin, Duration limit) const {
  Decision record;
  record.entity = state_->parts.entity;
  record.time = nanoseconds_since_1970();
  record.service = interface.name;
  record.strategy = strategy.name();
  record.features = wire_values::list(task.features);
  record.utility = to_string(task.utility.aim);
  record.good_enough = task.utility.good_enough;
  record.available = wire_values::ns(time_left(begin, limit));
  record.exploration = state_->options.exploration;
  const auto past = state_->learning.begin_request(interface.name);
  record.decided = past.made;
  record.explored = past.explored;
  return record;
}

void Head::decide(const InterfaceInfo& interface, task_run::TaskRun& task, Duration limit,
                  Decision* wanted) {
  const Instant begin = state_->parts.clock.now();
  const TaskOptions& options = task.options();
  check_options(options);
  const auto strategy = state_->strategies.of_this_call();
  Decision record = open_record(interface, *strategy, options, begin, limit);
  record.request = options.request;
  record.execution = to_string(options.execution);
  state_->record(record, begin, wanted, [&] {
    const auto candidates =
        state_->await_candidates(interface, options, *strategy,
                                 saturating_sum(begin, wire_values::duration(record.available)));
    if (candidates.empty()) state_->known.refuse(interface, options.only);
    state_->warnings.tell_too_few(interface, options, candidates.size());
    Run run(*state_, interface, *strategy, task, candidates, record, begin);
    if (!run.run()) run.fail();
  });
}

std::shared_ptr<Channel> Head::preselect(const InterfaceInfo& interface, const Features& features,
                                         Duration limit) {
  const Instant begin = state_->parts.clock.now();
  check_features(features);
  const auto strategy = state_->strategies.of_this_call();
  TaskOptions options;
  options.features = features;
  Decision record = open_record(interface, *strategy, options, begin, limit);
  record.execution = "none";
  std::shared_ptr<Channel> channel;
  state_->record(record, begin, nullptr, [&] {
    auto candidates =
        state_->await_candidates(interface, options, *strategy,
                                 saturating_sum(begin, wire_values::duration(record.available)));
    if (candidates.empty()) state_->known.refuse(interface, {});
    decision_record::list(record, candidates);
    const Situation situation = decision_record::situation_of(record);
    CandidateIterator iterator(*strategy, std::move(candidates), situation);
    const auto next = iterator.next(situation.remaining);
    introspection::Attempt& attempt = record.attempts.emplace_back();
    decision_record::note_choice(attempt, next, situation.remaining);
    Instant reached = begin;
    channel = state_->channels.open(next.candidate, situation.remaining, reached);
    attempt.outcome = Outcome::Preselected;
  });
  return channel;
}

std::vector<Head::Current> Head::running() const { return state_->running.list(); }

std::vector<Decision> Head::decisions() const { return state_->decisions.list(); }

History Head::history() const { return state_->learning.history(); }

bool Head::degraded() const { return state_->overdue.count() >= state_->options.max_stuck; }

}  // namespace skein
