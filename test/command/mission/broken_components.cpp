// Components for missions that are to be refused; with BROKEN_PLUGIN in the environment, the plugin
// itself is broken, in the way that it says.
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "worker.idl.hpp"

namespace {

using namespace skein;

class Desk final : public crew::Desk {
 public:
  std::string ask(const std::string& text) override { return text; }
};

class Worker final : public crew::Worker {
 public:
  std::string work(const std::string& task) override { return task; }
  void improve(const std::string&, StreamSink<std::string>&) override {}
};

std::shared_ptr<Servant> desk() {
  return std::make_shared<crew::Desk::Skeleton>(std::make_shared<Desk>());
}

std::shared_ptr<Servant> worker() {
  return std::make_shared<crew::Worker::Skeleton>(std::make_shared<Worker>());
}

/// A route is a list of roads, one a line.
void check_route(const std::string& text) {
  std::istringstream roads(text);
  for (std::string road; std::getline(roads, road);) {
    if (road == "abyss") std::abort();
    if (!road.ends_with(" street"))
      throw std::invalid_argument("'" + road + "' is no road; write NAME street");
  }
}

void break_down(ComponentRegistry& registry, const std::string& how) {
  if (how == "aborts") std::abort();
  if (how == "exits") _exit(0);
  if (how == "exits in order") std::exit(0);
  if (how == "hangs") {
    while (true) ::pause();
  }
  if (how == "throws") throw std::runtime_error("no licence");
  if (how == "registers twice") registry.add_csp("office", [](const auto&) { return desk(); });
}

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() {
  const char* how = std::getenv("BROKEN_PLUGIN");
  return how && std::string(how) == "is old" ? SKEIN_ABI - 1 : SKEIN_ABI;
}

extern "C" void skein_register_components(ComponentRegistry& registry) {
  const char* how = std::getenv("BROKEN_PLUGIN");
  if (how && std::string(how) == "registers nothing") return;
  const auto body = [](Entity&, const ParameterValues&) { return ComponentRegistry::Body{desk()}; };
  registry.add_body<crew::Desk>("office", body);
  registry.add_body("quiet", body);
  registry.add_csp<crew::Desk>("clerk", [](const ParameterValues&) { return desk(); });
  registry.add_mission("client", [](Entity&, const ParameterValues&) { return 0; });
  registry.add_activity("herald",
                        [](Entity&, const ParameterValues&, const std::stop_token&) { return 0; });
  registry.add_csp<crew::Worker>("worker", [](const ParameterValues&) { return worker(); });
  registry.add_check<std::string>("Route", check_route);
  if (how) break_down(registry, how);
}
