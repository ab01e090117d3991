#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "command/commands.hpp"
#include "command/print/json_text.hpp"
#include "command/print/time_limits.hpp"
#include "core/printable.hpp"
#include "idl/types/flags.hpp"
#include "service_names.hpp"
#include "skein/detail/json.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestException = 4096;
constexpr std::chrono::milliseconds kTablePeriod{20};

std::string values_of(const CallArguments& arguments) {
  if (arguments.values != "-") return arguments.values;
  return {std::istreambuf_iterator<char>(std::cin), {}};
}

/// What the operation returns, where it has no out parameters beside it; otherwise all of them.
std::string result_text(const std::string& result, bool json) {
  const auto members = nlohmann::ordered_json::parse(result);
  const bool alone = members.size() == 1 && members.contains("return_");
  return json_text(alone ? members["return_"].dump() : result, !json);
}

/// What JSON has for a type.
std::string type_word(const types::Type& type) {
  switch (type.kind) {
    case types::Kind::Boolean:
      return "true or false";
    case types::Kind::Char:
    case types::Kind::WideChar:
      return "a character";
    case types::Kind::String:
    case types::Kind::WideString:
      return "string";
    case types::Kind::Sequence:
    case types::Kind::Array:
      return "array of " + type_word(type.elements.at(0));
    case types::Kind::Map:
      return "array of pairs";
    case types::Kind::OptionalMember:
      return type_word(type.elements.at(0)) + " or null";
    case types::Kind::Declared:
      return type.name;
    case types::Kind::Reference:
      return "reference to " + type.name;
    default:
      return type.elements.empty() ? "number" : "object";
  }
}

bool is_text(const types::Type& type) {
  return type.kind == types::Kind::String || type.kind == types::Kind::WideString;
}

std::vector<types::Parameter> accepted_parameters(const types::Operation& operation) {
  std::vector<types::Parameter> taken;
  std::ranges::copy_if(operation.parameters, std::back_inserter(taken), [](const auto& parameter) {
    return parameter.direction != types::Direction::Out;
  });
  return taken;
}

/// What the operation needs, and how to write it.
std::string needs_of(const types::Operation& operation, const std::string& values) {
  const auto parameters = accepted_parameters(operation);
  std::string text;
  for (const types::Parameter& parameter : parameters) {
    text += (text.empty() ? operation.name + " needs " : ", ") + parameter.name + " (" +
            type_word(parameter.type) + ")";
  }
  const bool structured = values.starts_with('{') || values.starts_with('[');
  const bool one_line = values.find('\n') == std::string::npos && !structured;
  text += parameters.size() == 1 && is_text(parameters.front().type) && one_line
              ? "; for text write '\"" + (values.empty() ? "text" : values) + "\"'"
              : "; --example prints a template";
  return text + ", for a file write - < request.json";
}

/// Before anything is sent: people forget arguments, and the quotes of JSON within those of the
/// shell.
void demand_arguments(const types::Operation& operation, const std::string& values) {
  if (accepted_parameters(operation).empty()) {
    std::string said = values;
    std::erase_if(said, [](unsigned char c) { return std::isspace(c); });
    if (said.empty() || said == "{}") return;
    throw InvalidArgument(operation.name + " takes no arguments; leave out '" + values + "'");
  }
  try {
    idl::parse_json(values, [](const idl::JsonReader&) {});
  } catch (const InvalidArgument& error) {
    if (values.empty()) throw InvalidArgument(needs_of(operation, values));
    throw InvalidArgument(std::string(error.what()) + "; " + needs_of(operation, values));
  }
}

/// An entity's name must not leave open which of its services is meant.
void demand_one_service(Entity& entity, const CallArguments& arguments,
                        const std::string& interface) {
  if (is_interface_named(interface, arguments.name)) return;
  const auto services = entity.broker().all();
  const auto found = std::ranges::find_if(services, [&](const auto& service) {
    return service->service == interface && is_named(*service, arguments.name) &&
           (arguments.system.empty() || service->system == arguments.system);
  });
  if (found == services.end()) return;
  const std::string choice = choice_among(services_of(entity.broker(), entity_name_of(**found)));
  if (!choice.empty()) throw InvalidArgument(choice);
}

/// SYSTEM/ENTITY names an entity as `skein peers` does, unless an interface is spelled like that.
ConnectOptions connection_of(Entity& entity, const CallArguments& arguments) {
  ConnectOptions options;
  options.name = arguments.name;
  options.system = arguments.system.empty() ? ConnectOptions::kAnySystem : arguments.system;
  options.timeout = duration_of(arguments.seconds);
  const std::size_t slash = arguments.name.find('/');
  if (slash == std::string::npos) return options;
  const auto& broker = entity.broker();
  const auto is_there = [&](const auto& service) { return is_named(*service, arguments.name); };
  const Instant end = entity.clock().now() + options.timeout;
  while (std::ranges::none_of(broker.all(), is_there) && entity.clock().now() < end)
    std::this_thread::sleep_for(kTablePeriod);
  options.timeout = std::max(Duration(1), end - entity.clock().now());
  const auto services = services_of(broker, arguments.name);
  if (services.empty()) return options;
  options.system = arguments.name.substr(0, slash);
  options.name = services.front()->service;
  options.provider = Guid{services.front()->provider};
  return options;
}

void print_result(const std::string& result, bool json) {
  if (result != "{}" || json) std::printf("%s\n", result_text(result, json).c_str());
  std::fflush(stdout);
}

}  // namespace

int call(const CallArguments& arguments) {
  const std::string values = arguments.example ? "" : values_of(arguments);
  Entity entity = join(arguments, "call");
  const DynamicProxy proxy = connect_dynamic(entity, connection_of(entity, arguments))
                                 .within(duration_of(arguments.within));
  demand_one_service(entity, arguments, proxy.interface_name());
  if (arguments.example) {
    std::printf("%s\n", json_text(proxy.example(arguments.operation), !arguments.json).c_str());
    return 0;
  }
  const auto& operation = proxy.operation(arguments.operation);
  demand_arguments(operation, values);
  const auto flags = operation.flags;
  try {
    if (idl::has(flags, types::OperationFlags::stream)) {
      for (const std::string& result : proxy.stream(arguments.operation, values)) {
        print_result(result, arguments.json);
      }
    } else {
      print_result(proxy.call(arguments.operation, values), arguments.json);
    }
  } catch (const DynamicException& exception) {
    std::fflush(stdout);
    std::fprintf(stderr, "skein: %s.%s raised %s\n", printable(arguments.name).c_str(),
                 arguments.operation.c_str(),
                 printable(exception.what(), kLongestException).c_str());
    return 1;
  } catch (const TimedOut& error) {
    throw TimedOut(at_command_line(error.what()));
  }
  return 0;
}

}  // namespace skein::command
