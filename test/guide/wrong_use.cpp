// What people write by mistake. Behind each line that the compiler is to find stands what it is to
// say.
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/head.hpp"
#include "survey.idl.hpp"

using survey::Area;
using survey::IPlanner;

struct Rows : IPlanner {
  survey::Track plan(const Area&) override { return {}; }
};

struct Unplanned : IPlanner {};
struct Misplanned : IPlanner {
  survey::Track plan(const Area&) const { return {}; }
};
struct Later : IPlanner::Deferred {};
std::shared_ptr<Later> later();

void use(skein::ComponentRegistry& registry, skein::Entity& entity) {
  const auto make_csp = [](const skein::ParameterValues&) { return std::make_shared<Rows>(); };
  registry.add_csp<IPlanner>("Rows", make_csp);  // the factory of a CSP takes .* and returns
  registry.add_csp("Rows", make_csp);            // a CSP is registered with its interface
  const auto make_body = [](skein::Entity&, const skein::ParameterValues&) {
    return std::make_shared<Rows>();
  };
  registry.add_body("Rows", make_body);  // a Body is registered with its interface

  entity.publisher<IPlanner>("planner");     // a topic carries values of an IDL struct or union
  entity.publisher<int>("number");           // a topic carries values of an IDL struct or union
  entity.subscription<int>("number");        // a topic carries values of an IDL struct or union
  entity.connect<Area>();                    // only an IDL interface is connected to
  entity.head().preselect<survey::Track>();  // only an IDL interface is connected to
  const auto area = std::make_shared<Area>();
  entity.provide<Area>(area);  // only an IDL interface is provided

  const auto rows = std::make_shared<Rows>();
  const auto number = std::make_shared<int>();
  entity.provide<IPlanner>(Rows(), {.threads = 2});          // is given as a std::shared_ptr
  entity.provide<IPlanner>(area);                            // does not implement the interface
  entity.provide<IPlanner>(std::make_shared<Unplanned>());   // lacks an operation
  entity.provide<IPlanner>(std::make_unique<Misplanned>());  // or has it with other parameters
  entity.provide<IPlanner>(later());                         // lacks an operation
  entity.provide_csp<IPlanner>("Rows", entity.id(), std::make_shared<Unplanned>());  // lacks an
  entity.provide_csp<IPlanner>("Rows", entity.id(), Area());  // is given as a std::shared_ptr
  entity.provide_csp<IPlanner>("Rows", entity.id(), number);  // does not implement the interface
  entity.provide_csp<IPlanner>("Rows", entity, rows);         // its owner's Entity::id
  entity.provide_csp<IPlanner>(rows, "Rows", entity.id());    // takes the CSP's name, its owner's
  entity.connect<IPlanner>("rover");                          // takes its options in braces
  entity.connect<IPlanner>(std::chrono::seconds(5));          // takes its options in braces
  entity.connect<IPlanner>({.timeout = 5});                   // a time has a unit
  entity.provide<IPlanner>(rows, {.attributes = {{"kind", true}}});  // a text, a number or a

  auto call = entity.connect<IPlanner>().async_plan({});
  entity.connect<IPlanner>().within(5L);         // a time has a unit
  call.then([](skein::Call<survey::Track>) {});  // write std::move.call..then

  skein::Task<IPlanner, survey::Track> task;
  const auto run = [](IPlanner::Proxy& planner) { return planner.plan({}); };
  task.run = run;  // a task's .run. is called with the CSP's Proxy

  skein::EntityOptions options;
  options.vendor = "fastdds";  // dds::load_vendor
}
