#include "navigator.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "planning_value.hpp"
#include "route_judge.hpp"
#include "skein/call_context.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

using AE_flightControllerI::FlightLimits;
using AE_flightControllerI::IFlightController;
using AE_navigator::IPlanner;
using AE_navigator::NoRoute;
using AE_navigator::Problem;
using AE_navigator::Route;
using std::chrono::milliseconds;

constexpr milliseconds kLongestRequest{600'000};
// Of a planner's time, for the way there and back and for judging its route.
constexpr milliseconds kJudgingReserve{10};
constexpr milliseconds kFlightControllerPatience{500};
constexpr milliseconds kAdManagerPatience{500};

ParameterValues values_of(const AE_navigatorI::RouteRequest& request) {
  ParameterValues values;
  if (!request.planner.empty()) values.set("Planner", request.planner);
  if (request.problem.time_limit_ms > 0) {
    values.set("Time limit", milliseconds(request.problem.time_limit_ms));
  }
  return values;
}

std::uint32_t planning_time_ms(Duration budget) {
  const auto left = std::chrono::duration_cast<milliseconds>(budget);
  return static_cast<std::uint32_t>(std::max(left - kJudgingReserve, left / 2).count()) + 1;
}

/// What planners gave as reasons for having no route, by the planners' names.
using Refusals = std::map<std::string, std::string>;

/// A proof that there is no route settles it, and so does a problem that no planner could solve.
bool settles(const UserException& exception, const Candidate& planner, Refusals& refusals) {
  const auto* no_route = dynamic_cast<const NoRoute*>(&exception);
  if (!no_route) return true;
  refusals[planner.name] = no_route->reason;
  return no_route->proven;
}

/// Whether another picture of the threats would change nothing.
bool settled(const std::exception& failure) {
  const auto* no_route = dynamic_cast<const NoRoute*>(&failure);
  return no_route ? no_route->proven : dynamic_cast<const UserException*>(&failure) != nullptr;
}

/// What the caller of the current call waits for at most.
Duration in_call(Duration limit) {
  const CallContext* const call = CallContext::current();
  return call ? std::min(limit, call->remaining()) : limit;
}

/// The last of a planner's routes, which is its best: also where its time is up before its end.
Route best_of(Stream<Route> routes) {
  std::optional<Route> best;
  try {
    while (auto route = routes.next()) best = std::move(route);
  } catch (const TimedOut&) {
    if (!best) throw;
  }
  if (!best) throw NoRoute("the planner ended without a route", false);
  return std::move(*best);
}

void use_own_words(introspection::Decision& record, const Refusals& refusals) {
  for (introspection::Attempt& attempt : record.attempts) {
    const auto refusal = refusals.find(attempt.csp);
    if (refusal != refusals.end()) attempt.text = refusal->second;
  }
}

[[noreturn]] void throw_no_usable_route(const introspection::Decision& record) {
  std::string reason = "no planner had a usable route in time:";
  for (const introspection::Attempt& attempt : record.attempts) {
    reason += fmt::format(" {} {}", attempt.csp, in_words(attempt.outcome));
    reason += attempt.text.empty() ? ";" : fmt::format(" ({});", attempt.text);
  }
  reason.pop_back();
  throw NoRoute(reason, false);
}

}  // namespace

Navigator::Navigator(Entity& entity, ParameterValues profile,
                     std::shared_ptr<TerrainProvider> terrains)
    : entity_(entity),
      profile_(std::move(profile)),
      parameters_("INavigator", {{"Planner"}, {"Time limit"}}),
      terrains_(std::move(terrains)),
      threats_(entity) {}

Route Navigator::request_route(const AE_navigatorI::RouteRequest& request) {
  if (journal_.at_work() >= kMaxRequests) {
    throw Overloaded(fmt::format(
        "the navigator plans {} routes already; ask again when one is done", kMaxRequests));
  }
  journal_.begin(request.request_id);
  std::vector<Planning> plannings;
  try {
    Route route = decide(request, plannings);
    journal_.end(request.request_id, plannings, {});
    return route;
  } catch (const std::exception& error) {
    journal_.end(request.request_id, plannings, error.what());
    throw;
  }
}

Route Navigator::decide(const AE_navigatorI::RouteRequest& request,
                        std::vector<Planning>& plannings) {
  const ParameterValues parameters = parameters_.resolve({values_of(request), profile_});
  Problem problem = request.problem;
  problem.limits = flight_limits();
  const Duration limit = in_call(parameters.find<Duration>("Time limit").value_or(kLongestRequest));
  const Instant end = entity_.clock().after(limit);
  const std::string id = request.request_id;
  const std::string only = parameters.find<std::string>("Planner").value_or("");
  try {
    if (!request.own_planner.is_nil())
      return ask(request.own_planner, problem, limit, plannings.emplace_back().record);
    threats_.renew(problem);
    const bool fits_perhaps_never = problem.threat_epoch > 0 && problem.exposure_cap_m > 0;
    // What a picture that is too old may cost leaves as much for the fresh one.
    try {
      return plan({id, problem, only, fits_perhaps_never ? limit / 2 : limit}, plannings);
    } catch (const std::exception& failure) {
      if (settled(failure) || !renew_threats(problem, end)) throw;
    }
    return plan({id, problem, only, end - entity_.clock().now()}, plannings);
  } catch (const UserException&) {
    throw;
  } catch (const Error&) {
    // A planner's crash or silence is not the navigator's: the caller may well ask again.
    if (plannings.empty() || plannings.back().record.attempts.empty()) throw;
    throw_no_usable_route(plannings.back().record);
  }
}

// What the Head knows of its world may be old: a later picture may be here already, or with the AD
// manager.
bool Navigator::renew_threats(Problem& problem, Instant end) {
  if (threats_.renew(problem)) return true;
  if (problem.threat_epoch == 0 || problem.exposure_cap_m == 0) return false;
  const Duration left = end - entity_.clock().now();
  if (left <= Duration::zero()) return false;
  threats_.ask(problem.terrain, std::min(left / 2, Duration(kAdManagerPatience)));
  return threats_.renew(problem);
}

Route Navigator::plan(const Question& question, std::vector<Planning>& plannings) {
  const Problem& problem = question.problem;
  const auto terrain = terrains_->load(problem.terrain);
  Planning& planning = plannings.emplace_back();
  planning.threat_epoch = problem.threat_epoch;
  Task<IPlanner, Route> task;
  task.request = question.id;
  task.only = question.only;
  task.features = features_of(problem, question.limit);
  // A stream, so that the best route so far is there when the time is up, and that a planner in
  // this process that hangs holds up its own thread and not this.
  task.run = [&](IPlanner::Proxy& csp, Duration budget) {
    Problem timed = problem;
    timed.time_limit_ms = planning_time_ms(budget);
    return best_of(csp.improve(timed));
  };
  task.evaluate = judgement(*terrain, problem, [&] { return threats_.epoch(problem.terrain); });
  task.quality = [&](const Route& route) { return quality_of(problem, route); };
  Refusals refusals;
  task.settles = [&](const UserException& exception, const Candidate& planner) {
    return settles(exception, planner, refusals);
  };
  try {
    Route route = entity_.head().perform(task, &planning.record, question.limit);
    use_own_words(planning.record, refusals);
    return route;
  } catch (...) {
    use_own_words(planning.record, refusals);
    throw;
  }
}

// A planner that the caller chose: no candidates, no choice, but the same judgement.
Route Navigator::ask(const Reference<IPlanner>& planner, const Problem& problem, Duration limit,
                     introspection::Decision& record) {
  const Instant began = entity_.clock().now();
  introspection::Attempt attempt;
  attempt.csp = to_string(planner);
  attempt.reason = "the caller brought it";
  const auto note = [&](introspection::Outcome outcome, const std::string& text) {
    attempt.outcome = outcome;
    attempt.text = text;
    const std::chrono::nanoseconds took = entity_.clock().now() - began;
    attempt.took = record.took = took.count();
    record.attempts.push_back(attempt);
  };
  const auto terrain = terrains_->load(problem.terrain);
  Problem timed = problem;
  timed.time_limit_ms = planning_time_ms(limit);
  Route route = entity_.connect(planner, {.timeout = limit}).within(limit).plan(timed);
  const auto judge = judgement(*terrain, problem, [&] { return threats_.epoch(problem.terrain); });
  if (const auto rejection = judge(route)) {
    attempt.check = rejection->check;
    note(introspection::Outcome::Rejected, rejection->reason);
    throw_no_usable_route(record);
  }
  note(introspection::Outcome::Accepted, "");
  return route;
}

FlightLimits Navigator::flight_limits() {
  const std::lock_guard lock(mutex_);
  if (!flight_controller_) {
    flight_controller_ = entity_.connect<IFlightController>({.timeout = kFlightControllerPatience})
                             .within(kFlightControllerPatience);
  }
  try {
    return flight_controller_->flight_limits();
  } catch (const Disconnected&) {
    // It left under way; asking changes nothing, so the next one may be asked at once.
    return flight_controller_->flight_limits();
  }
}

AE_navigatorI::PlanningStatus Navigator::status() {
  AE_navigatorI::PlanningStatus status;
  status.request_id = journal_.current();
  const auto running = entity_.head().running();
  status.planning = !status.request_id.empty() && !running.empty();
  if (!status.planning) return status;
  status.planner = running.back().csp;
  status.host = running.back().host;
  status.pid = running.back().pid;
  return status;
}

AE_navigatorI::PlanningReport Navigator::report(const std::string& request_id) {
  return journal_.report(request_id);
}

}  // namespace skein::navigation
