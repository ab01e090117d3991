#include "json_text.hpp"

#include <nlohmann/json.hpp>

#include "core/printable.hpp"

namespace skein::command {
namespace {

bool is_printable(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line(text.data() + at, end - at);
    if (printable(line, line.size()) != line) return false;
    at = end + 1;
  }
  return true;
}

}  // namespace

std::string json_text(const std::string& json, bool indented) {
  const auto value = nlohmann::ordered_json::parse(json);
  const int indent = indented ? 2 : -1;
  std::string text = value.dump(indent);
  return is_printable(text) ? text : value.dump(indent, ' ', true);
}

}  // namespace skein::command
