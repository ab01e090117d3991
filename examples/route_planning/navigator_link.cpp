#include "navigator_link.hpp"

#include <fmt/core.h>
#include <signal.h>

#include <cerrno>
#include <cstring>
#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "brokerless_discovery/process_watch.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

using namespace std::chrono_literals;

namespace route_planning {
namespace {

using AE_navigatorI::INavigator;
using AE_navigatorI::PlanningStatus;
using skein::Instant;

constexpr auto kPatience = 20s;
constexpr auto kReportPatience = 5s;
// A quick planner runs so often that what it took to load the terrain is forgotten.
constexpr int kPractice = 12;
constexpr auto kQuick = 100ms;
// A planner that is to be killed is to be at work, not just done.
constexpr auto kLeftToPlan = 200ms;

/// What `ask` brings back: the route, or the reason why there is none.
template <class Ask>
Answer answer_of(skein::Clock& clock, Ask ask) {
  Answer answer;
  const Instant begin = clock.now();
  try {
    answer.route = ask();
  } catch (const AE_navigator::NoRoute& refusal) {
    answer.refusal = refusal.reason;
    answer.proven = refusal.proven;
  } catch (const AE_navigator::InvalidProblem& refusal) {
    answer.refusal = refusal.reason;
  } catch (const skein::TimedOut& error) {
    answer.refusal = error.what();
  }
  answer.took = clock.now() - begin;
  return answer;
}

}  // namespace

NavigatorLink::NavigatorLink(skein::Entity& entity)
    : entity_(entity), navigator_(entity.connect<INavigator>({.timeout = kPatience})) {}

void NavigatorLink::select_by(const std::string& strategy) {
  navigator_ = entity_.connect<INavigator>({.strategy = strategy, .timeout = kPatience});
}

void NavigatorLink::brief(const std::string& planner, AE_navigator::Problem problem) {
  problem.time_limit_ms = 2000;
  const Instant deadline = entity_.clock().now() + kPatience;
  while (!practise(planner, problem)) {
    if (entity_.clock().now() >= deadline)
      throw skein::Unavailable(fmt::format("{} is not available at the navigator", planner));
    std::this_thread::sleep_for(20ms);
  }
}

void NavigatorLink::train(const std::string& planner, AE_navigator::Problem problem) {
  brief(planner, problem);
  problem.time_limit_ms = 400;
  for (int i = 0; i < kPractice; ++i) {
    const Instant begin = entity_.clock().now();
    practise(planner, problem);
    if (entity_.clock().now() - begin > kQuick) break;
  }
}

bool NavigatorLink::practise(const std::string& planner, const AE_navigator::Problem& problem) {
  try {
    navigator_.within(kPatience).request_route({"briefing " + planner, problem, planner});
  } catch (const AE_navigator::NoRoute&) {
    // It answered, which is all that counts here.
  } catch (const skein::Unavailable&) {
    return false;
  }
  return true;
}

Answer NavigatorLink::ask(const Question& question) {
  Question asked = question;
  Answer answer = ask_once(asked);
  while (!answer.route && !answer.proven && answer.times_asked <= question.repetitions) {
    const int times_asked = answer.times_asked + 1;
    // A name of its own, under which the navigator reports this one and not the one before.
    asked.id = fmt::format("{}, try {}", question.id, times_asked);
    answer = ask_once(asked);
    answer.times_asked = times_asked;
  }
  answer.report = report_of(asked);
  return answer;
}

Answer NavigatorLink::ask_once(const Question& question) {
  return answer_of(entity_.clock(), [&] {
    return navigator_.within(question.time_to_think)
        .request_route({question.id, question.problem, ""});
  });
}

Answer NavigatorLink::ask_and_kill(const Question& question, Kill& kill) {
  auto call = navigator_.within(question.time_to_think)
                  .async_request_route({question.id, question.problem, ""});
  const Instant begin = entity_.clock().now();
  const PlanningStatus status = await_planner(begin + question.time_to_think);
  require_killable(status);
  kill = {status.planner, status.pid, entity_.clock().now() - begin, entity_.clock().now()};
  if (::kill(static_cast<pid_t>(status.pid), SIGKILL) != 0) {
    throw skein::InvalidArgument(fmt::format("process {} of {} cannot be killed: {}", status.pid,
                                             status.planner, std::strerror(errno)));
  }
  Answer answer = answer_of(entity_.clock(), [&] { return call.get(); });
  answer.took += kill.planned_for;
  answer.report = report_of(question);
  return answer;
}

// A call whose time is up may end here before it has ended at the navigator, or begun. Empty where
// the navigator does not report it.
AE_navigatorI::PlanningReport NavigatorLink::report_of(const Question& question) {
  const Instant deadline = entity_.clock().now() + kReportPatience;
  for (;;) {
    try {
      return navigator_.report(question.id);
    } catch (const AE_navigatorI::UnknownRequest&) {
      if (entity_.clock().now() >= deadline) return {};
    }
    std::this_thread::sleep_for(2ms);
  }
}

PlanningStatus NavigatorLink::await_planner(Instant deadline) {
  PlanningStatus seen;
  Instant since = entity_.clock().now();
  for (;;) {
    const PlanningStatus status = navigator_.status();
    const Instant now = entity_.clock().now();
    if (status != seen) {
      seen = status;
      since = now;
    }
    if (status.planning && now - since >= kLeftToPlan) return status;
    if (now >= deadline)
      throw skein::TimedOut("no planner was seen at work for long enough to kill it");
    std::this_thread::sleep_for(2ms);
  }
}

void NavigatorLink::require_killable(const PlanningStatus& status) {
  if (status.host != skein::brokerless_discovery::ProcessWatch::host()) {
    throw skein::InvalidArgument(
        fmt::format("{} plans on another host; it cannot be killed from here", status.planner));
  }
  auto& broker = entity_.broker();
  for (const auto& navigator : broker.find_service(broker.query("AE_navigatorI/INavigator"))) {
    if (navigator->pid != status.pid) continue;
    throw skein::InvalidArgument(
        fmt::format("{} plans inside of the navigator's process; give it one of its own in the "
                    "mission profile (process=\"own\") to have it killed",
                    status.planner));
  }
}

}  // namespace route_planning
