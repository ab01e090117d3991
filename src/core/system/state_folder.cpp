#include "state_folder.hpp"

#include <cstdlib>

namespace skein {

std::filesystem::path state_folder() {
  const auto set = [](const char* variable) {
    const char* value = std::getenv(variable);
    return std::filesystem::path(value == nullptr ? "" : value);
  };
  if (const auto state = set("XDG_STATE_HOME"); state.is_absolute()) return state / "skein";
  if (const auto home = set("HOME"); home.is_absolute()) return home / ".local" / "state" / "skein";
  return {};
}

}  // namespace skein
