#include "skein/detail/union_access.hpp"

#include <string>

#include "skein/error.hpp"

namespace skein::idl {

void throw_not_held(const char* type, const char* member) {
  throw InvalidArgument(std::string(type) + " does not hold '" + member +
                        "': its discriminator selects something else");
}

void throw_not_selected(const char* type, const char* member) {
  throw InvalidArgument("the discriminator given for '" + std::string(member) + "' of " + type +
                        " selects something else");
}

}  // namespace skein::idl
