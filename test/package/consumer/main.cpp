// A provider and a caller in one program, on the vendor that the argument names.
#include <cmath>
#include <cstdio>

#include "skein/entity.hpp"
#include "tides/tide_table.idl.hpp"

namespace {

class TideTable : public tides::ITideTable {
 public:
  double height_m(const tides::Harbour& harbour, std::uint32_t hour) override {
    if (harbour.name.empty()) throw tides::UnknownHarbour(harbour.name);
    return harbour.range_m / 2 * (1 + std::cos(hour * 3.141592653589793 / 6));
  }
};

}  // namespace

int main(int, char** argv) {
  const auto vendor = skein::dds::load_vendor(argv[1]);
  skein::Entity pier({.name = "pier", .vendor = vendor, .domain = 61});
  skein::Entity boat({.name = "boat", .vendor = vendor, .domain = 61});
  pier.provide<tides::ITideTable>(std::make_shared<TideTable>());
  auto table = boat.connect<tides::ITideTable>();
  const double height_m = table.height_m({.name = "north", .range_m = 3}, 6);
  std::printf("%s: %.1f m at 6 o'clock\n", vendor->name().c_str(), height_m);
  try {
    table.height_m({}, 6);
  } catch (const tides::UnknownHarbour&) {
    return std::abs(height_m) < 1e-6 ? 0 : 1;
  }
  return 1;
}
