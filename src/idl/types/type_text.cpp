#include "idl/types/type_text.hpp"

#include <sstream>
#include <vector>

#include "skein/describe.hpp"

namespace skein::idl {
namespace {

std::string without_indentation(const std::string& idl) {
  std::istringstream lines(idl);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const auto begin = line.find_first_not_of(' ');
    if (begin != std::string::npos) text.append(line, begin).append("\n");
  }
  return text;
}

/// The next line of a type's text, without its end; nothing behind the last whole one.
std::optional<std::string_view> take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

/// What a line that opens a declaration declares: of `@final struct Pose {` that is Pose.
std::string_view declared(std::string_view line) {
  line = line.substr(0, line.find(" {"));
  line = line.substr(0, line.find(" switch ("));
  return line.substr(line.rfind(' ') + 1);
}

std::string shown(const std::string& scope, std::string_view line) {
  if (scope.empty()) return std::string(line);
  if (line.starts_with('}')) return scope + " without a further member";
  if (line.ends_with(';')) line.remove_suffix(1);
  return scope + " with '" + std::string(line) + "'";
}

}  // namespace

std::string type_text(const TypeSupport& type) {
  if (type.description.declaration.empty()) return {};
  return without_indentation(to_idl(describe(type)));
}

std::optional<std::pair<std::string, std::string>> difference_of_texts(std::string_view first,
                                                                       std::string_view second) {
  std::vector<std::string> scopes{""};
  for (;;) {
    const auto one = take_line(first);
    const auto other = take_line(second);
    if (!one || !other) return std::nullopt;
    if (*one != *other) return std::pair(shown(scopes.back(), *one), shown(scopes.back(), *other));
    if (one->ends_with('{')) {
      const std::string around = scopes.back().empty() ? "" : scopes.back() + "::";
      scopes.push_back(around + std::string(declared(*one)));
    } else if (one->starts_with('}') && scopes.size() > 1) {
      scopes.pop_back();
    }
  }
}

}  // namespace skein::idl
