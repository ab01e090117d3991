// A small mission, for tests of how missions are started: a desk that answers, and one who asks it;
// and a strategy of selection.
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/head.hpp"
#include "skein/selection.hpp"
#include "worker.idl.hpp"

namespace {

using namespace skein;
using namespace std::chrono_literals;

class Desk final : public crew::Desk {
 public:
  std::string ask(const std::string& text) override { return "yes, " + text; }
};

class First final : public SelectionStrategy {
 public:
  std::string name() const override { return "first"; }
  Selection select(const std::vector<Candidate>&, const Situation& situation) const override {
    return {0, situation.remaining, "it is the first"};
  }
};

int ask(Entity& entity, const ParameterValues&) {
  auto desk = entity.connect<crew::Desk>();
  std::printf("the desk says: %s\n", desk.within(10s).ask("dear \x1b[31mclient").c_str());
  std::fflush(stdout);
  return 0;
}

int stumble(Entity&, const ParameterValues&) { throw std::runtime_error("the client stumbled"); }

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_body("office", [](skein::Entity&, const skein::ParameterValues&) {
    return skein::ComponentRegistry::Body{
        std::make_shared<crew::Desk::Skeleton>(std::make_shared<Desk>())};
  });
  registry.add_mission("client", ask);
  registry.add_mission("clumsy", stumble);
  registry.add_strategy(std::make_shared<First>());
}
