// A plugin with a service whose every tide is a metre high.
#include "skein/component_registry.hpp"
#include "tides/tide_table.idl.hpp"

namespace {

class FlatTable : public tides::ITideTable {
 public:
  double height_m(const tides::Harbour& harbour, std::uint32_t) override {
    if (harbour.name.empty()) throw tides::UnknownHarbour(harbour.name);
    return 1;
  }
};

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_csp<tides::ITideTable>("FlatTable", [](const skein::ParameterValues&) {
    return std::make_shared<tides::ITideTable::Skeleton>(std::make_shared<FlatTable>());
  });
}
