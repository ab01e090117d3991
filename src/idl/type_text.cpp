#include "idl/type_text.hpp"

#include <sstream>

#include "skein/describe.hpp"

namespace skein::idl {

std::string type_text(const TypeSupport& type) {
  if (type.description.declaration.empty()) return {};
  std::istringstream lines(to_idl(describe(type)));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const auto begin = line.find_first_not_of(' ');
    if (begin != std::string::npos) text.append(line, begin).append("\n");
  }
  return text;
}

}  // namespace skein::idl
