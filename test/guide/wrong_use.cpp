// What people write by mistake; each is to end with one sentence of the compiler's.
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/head.hpp"
#include "survey.idl.hpp"

struct Rows : survey::IPlanner {
  survey::Track plan(const survey::Area&) override { return {}; }
};

void use(skein::ComponentRegistry& registry, skein::Entity& entity) {
#if defined(CSP_WITHOUT_SKELETON)
  registry.add_csp<survey::IPlanner>(
      "Rows", [](const skein::ParameterValues&) { return std::make_shared<Rows>(); });
#elif defined(CSP_WITHOUT_INTERFACE)
  registry.add_csp("Rows", [](const skein::ParameterValues&) { return std::make_shared<Rows>(); });
#elif defined(BODY_WITHOUT_INTERFACE)
  registry.add_body("Rows", [](skein::Entity&, const skein::ParameterValues&) {
    return std::make_shared<Rows>();
  });
#elif defined(INTERFACE_AS_TOPIC)
  auto planners = entity.publisher<survey::IPlanner>("planner");
#elif defined(NUMBER_AS_TOPIC)
  auto numbers = entity.publisher<int>("number");
#elif defined(NUMBER_AS_SUBSCRIPTION)
  auto numbers = entity.subscription<int>("number");
#elif defined(STRUCT_AS_SERVICE)
  auto area = entity.connect<survey::Area>();
#elif defined(STRUCT_AS_CSP)
  auto area = entity.head().preselect<survey::Area>();
#elif defined(STRUCT_AS_BODY)
  entity.provide<survey::Area>(std::make_shared<survey::Area>());
#elif defined(NAMED_CALL_CONTINUED)
  auto call = entity.connect<survey::IPlanner>().async_plan({});
  call.then([](skein::Call<survey::Track>) {});
#elif defined(RUN_WITHOUT_BUDGET)
  skein::Task<survey::IPlanner, survey::Track> task;
  task.run = [](survey::IPlanner::Proxy& planner) { return planner.plan({}); };
#elif defined(VENDOR_BY_NAME)
  skein::Entity other({.name = "drone", .vendor = "fastdds"});
#endif
}
