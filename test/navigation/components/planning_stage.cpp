#include "planning_stage.hpp"

#include <stdexcept>

#include "brokerless_discovery/broker.hpp"
#include "navigation/components/flight_controller.hpp"
#include "navigation/components/navigator.hpp"
#include "navigation/route_checker/route_checker.hpp"
#include "navigation/routes/demo_problem.hpp"
#include "skein/discovery.idl.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/places.hpp"

using namespace std::chrono_literals;

namespace skein::test {
namespace {

using AE_navigatorI::INavigator;

constexpr const char* kTerrain = "synthetic:7";

std::unique_ptr<Entity> make_patient(const std::string& name, std::shared_ptr<dds::Vendor> vendor,
                                     HeadOptions head) {
  EntityOptions options;
  options.name = name;
  options.system = "uav-1";
  options.vendor = std::move(vendor);
  options.domain = 17;
  options.lease = 60s;
  options.head = std::move(head);
  return std::make_unique<Entity>(std::move(options));
}

navigation::HeightGrid ground_of(const navigation::Terrain& terrain) {
  return {terrain.rows(), terrain.columns(), terrain.north_spacing_m(), terrain.east_spacing_m(),
          terrain.heights_m()};
}

}  // namespace

PlanningStage::PlanningStage(HeadOptions head)
    : problem(),
      terrains_(std::make_shared<navigation::TerrainProvider>()),
      ground_(ground_of(*terrains_->load(kTerrain))),
      navigator_(make_patient("navigator", Pairing::get().server, std::move(head))),
      client_(make_patient("client", Pairing::get().client, {})) {
  problem = navigation::demo_problem(*terrains_->load(kTerrain));
  navigator_->provide<AE_flightControllerI::IFlightController>(
      std::make_shared<navigation::FlightController>(ParameterValues{}));
  navigator_->provide<INavigator>(
      std::make_shared<navigation::Navigator>(*navigator_, ParameterValues{}, terrains_),
      {.threads = navigation::Navigator::kThreads});
  proxy_ = client_->connect<INavigator>({.timeout = 20s});
  problem.limits = navigation::FlightController(ParameterValues{}).flight_limits();
}

PlanningStage::~PlanningStage() = default;

std::vector<std::string> PlanningStage::command(const std::string& name, const std::string& kind,
                                                Declared declared, int seed) const {
  return {built_program("planner_process"),
          Pairing::get().client->name(),
          name,
          navigator_->id(),
          kind,
          std::to_string(declared.latency_ms),
          std::to_string(declared.quality),
          std::to_string(seed)};
}

ChildProcess& PlanningStage::add(const std::string& name, const std::string& kind,
                                 Declared declared) {
  auto words = command(name, kind, declared);
  const std::string program = words.front();
  words.erase(words.begin());
  ChildProcess& planner =
      planners_.emplace_back(program, ChildProcess::Options{.arguments = std::move(words)});
  planner.expect("ready");
  await(name);
  ask(2s, name);
  return planner;
}

bool PlanningStage::is_available(const std::string& name) const {
  auto& broker = navigator_->broker();
  for (const auto& csp : broker.find_service(broker.query("AE_navigator/IPlanner"))) {
    if (csp->entity == name) return true;
  }
  return false;
}

void PlanningStage::await(const std::string& name) const {
  if (!eventually([&] { return is_available(name); }))
    throw std::runtime_error(name + " was never seen");
}

PlanningStage::Answer PlanningStage::ask(Duration budget, const std::string& planner) {
  return end(begin(budget, planner));
}

PlanningStage::Asked PlanningStage::begin(Duration budget, const std::string& planner) {
  const std::string id = std::to_string(++asked_);
  const Instant now = client_->clock().now();
  return {id, now, proxy_->within(budget).async_request_route({id, problem, planner, {}})};
}

PlanningStage::Answer PlanningStage::end(Asked asked) {
  Answer answer;
  try {
    answer.route = asked.call.get();
  } catch (const AE_navigator::NoRoute& refusal) {
    answer.refusal = refusal.reason;
    answer.proven = refusal.proven;
  } catch (const TimedOut& error) {
    answer.refusal = error.what();
  }
  answer.took = client_->clock().now() - asked.begin;
  // Where the caller's time ran out, its request may end a moment later.
  eventually([&] {
    try {
      answer.report = proxy_->within(20s).report(asked.id);
      return true;
    } catch (const AE_navigatorI::UnknownRequest&) {
      return false;
    }
  });
  return answer;
}

void PlanningStage::await_work_of(ChildProcess& planner) {
  const bool seen = eventually([&] {
    for (const auto& running : navigator_->head().running()) {
      if (running.pid == static_cast<std::uint32_t>(planner.pid())) return true;
    }
    return false;
  });
  if (!seen) throw std::runtime_error("the planner was never at work");
}

bool PlanningStage::valid(const Answer& answer) const {
  return answer.route && navigation::check_route(problem, *answer.route, ground_).empty();
}

std::string PlanningStage::Answer::outcome_of(const std::string& planner) const {
  std::string outcome;
  for (const auto& attempt : report.attempts) {
    if (attempt.planner == planner) outcome = attempt.outcome;
  }
  return outcome;
}

const AE_navigatorI::PlannerCandidate& PlanningStage::Answer::candidate(
    const std::string& planner) const {
  for (const auto& candidate : report.candidates) {
    if (candidate.planner == planner) return candidate;
  }
  throw std::runtime_error(planner + " is no candidate");
}

}  // namespace skein::test
