// A CSP that was built from another version of the managed interface than the rest of its mission.
#include <memory>
#include <string>

#include "changed_worker.idl.hpp"
#include "skein/component_registry.hpp"

namespace {

class Stranger final : public crew::Worker {
 public:
  std::string work(double) override { return "done"; }
};

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_csp<crew::Worker>("stranger", [](const skein::ParameterValues&) {
    return std::make_shared<crew::Worker::Skeleton>(std::make_shared<Stranger>());
  });
}
