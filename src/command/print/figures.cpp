#include "figures.hpp"

#include <cstdio>
#include <iterator>

namespace skein::command {
namespace {

struct Unit {
  double size;
  const char* name;
};

template <std::size_t N>
std::string in_units(double value, const Unit (&units)[N]) {
  const Unit* unit = units;
  while (unit + 1 != std::end(units) && value >= unit[1].size) ++unit;
  return short_number(value / unit->size) + " " + unit->name;
}

}  // namespace

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value < 9.95 ? "%.1f" : "%.0f", value);
  const std::string number = text;
  return number.ends_with(".0") ? number.substr(0, number.size() - 2) : number;
}

std::string short_time(std::uint64_t nanoseconds) {
  static constexpr Unit kUnits[] = {{1e3, "us"},   {1e6, "ms"},   {1e9, "s"},
                                    {60e9, "min"}, {3600e9, "h"}, {86400e9, "d"}};
  return in_units(static_cast<double>(nanoseconds), kUnits);
}

std::string short_size(std::uint64_t bytes) {
  static constexpr Unit kUnits[] = {{1, "B"}, {1024, "KiB"}, {1048576, "MiB"}, {1073741824, "GiB"}};
  return in_units(static_cast<double>(bytes), kUnits);
}

}  // namespace skein::command
