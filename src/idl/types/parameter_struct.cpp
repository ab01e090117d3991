#include "parameter_struct.hpp"

#include "scoped_name.hpp"

namespace skein::idl {
namespace {

using types::Direction;

types::Declaration struct_of(const types::Interface& interface, const types::Operation& operation,
                             const char* suffix) {
  types::Declaration declaration;
  declaration.modules = interface.modules;
  declaration.name = inside(first_parts(interface.name, interface.modules),
                            last_part(interface.name) + "_" + operation.name + suffix);
  return declaration;
}

void add_parameter(types::Declaration& declaration, const std::string& name,
                   const types::Type& type) {
  types::Member& member = declaration.members.emplace_back();
  member.name = name;
  member.type = type;
}

void add_parameters(types::Declaration& declaration, const types::Operation& operation,
                    Direction left_out) {
  for (const types::Parameter& parameter : operation.parameters) {
    if (parameter.direction != left_out) add_parameter(declaration, parameter.name, parameter.type);
  }
}

}  // namespace

types::Declaration in_struct(const types::Interface& interface, const types::Operation& operation) {
  types::Declaration declaration = struct_of(interface, operation, "_In");
  add_parameters(declaration, operation, Direction::Out);
  return declaration;
}

types::Declaration out_struct(const types::Interface& interface,
                              const types::Operation& operation) {
  types::Declaration declaration = struct_of(interface, operation, "_Out");
  if (!operation.result.empty()) add_parameter(declaration, "return_", operation.result.front());
  add_parameters(declaration, operation, Direction::In);
  return declaration;
}

}  // namespace skein::idl
