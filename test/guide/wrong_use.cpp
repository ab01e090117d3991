// What people write by mistake; each is to end with one sentence of the compiler's.
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "survey.idl.hpp"

struct Rows : survey::IPlanner {
  survey::Track plan(const survey::Area&) override { return {}; }
};

void use(skein::ComponentRegistry& registry, skein::Entity& entity) {
#if defined(CSP_WITHOUT_SKELETON)
  registry.add_csp<survey::IPlanner>(
      "Rows", [](const skein::ParameterValues&) { return std::make_shared<Rows>(); });
#elif defined(INTERFACE_AS_TOPIC)
  auto planners = entity.publisher<survey::IPlanner>("planner");
#endif
}
