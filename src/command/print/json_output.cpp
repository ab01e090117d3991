#include "json_output.hpp"

#include <cstdio>

#include "json_text.hpp"

namespace skein::command {

void print_json(const nlohmann::ordered_json& value, bool indented) {
  // Text that is no UTF-8 would be refused.
  const std::string valid =
      value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::printf("%s\n", json_text(valid, indented).c_str());
  std::fflush(stdout);
}

}  // namespace skein::command
