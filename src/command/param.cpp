#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "brokerless_discovery/broker.hpp"
#include "commands.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "interruption.hpp"
#include "json_output.hpp"
#include "service_names.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/inspector.hpp"
#include "skein/live_parameters.idl.hpp"
#include "topic_survey.hpp"

namespace skein::command {
namespace {

using brokerless_discovery::Table;
using launch::ILiveParameters;
using launch::RunningParameter;

constexpr double kLookAgain = 0.02;
constexpr std::size_t kLongestText = 4096;

/// Of the entity of that name, NAME or SYSTEM/NAME; of all where it is empty.
Table::Found tellers(Entity& entity, const std::string& name) {
  auto found = entity.broker().all();
  std::erase_if(found, [&](const auto& service) {
    return service->service != ILiveParameters::interface_info().name ||
           (!name.empty() && service->entity != name && entity_name_of(*service) != name);
  });
  return found;
}

/// For who is there, and does not tell, or is not there at all.
std::string reason_for_none(Entity& entity, const std::string& name) {
  std::vector<std::string> names;
  Inspector inspector(entity);
  for (const Inspected& peer : inspector.ask_all(inspection::Subject::Self, kAnswerPatience)) {
    const std::string& whole = peer.answer.entity;
    names.push_back(whole);
    names.push_back(whole.substr(whole.find('/') + 1));
    if (name != names.back() && name != whole) continue;
    return whole +
           " has no parameter that may change while it runs; what it was given stands in its "
           "mission profile";
  }
  return "no entity here is '" + name + "'" + suggestion(name, names) +
         "; `skein peers` lists them";
}

/// Who tells of the parameters of that entity, once it is there.
Table::Found::value_type await_teller(Entity& entity, const ParamArguments& arguments,
                                      const Interruption& interruption) {
  for (double waited = 0;; waited += kLookAgain) {
    const auto found = tellers(entity, arguments.entity);
    if (found.size() == 1) return found.front();
    if (!found.empty()) {
      std::string list;
      for (const auto& service : found)
        list += (list.empty() ? "" : ", ") + entity_name_of(*service);
      throw InvalidArgument("there are several '" + arguments.entity + "': name one of " + list);
    }
    if (waited >= arguments.seconds) throw Unavailable(reason_for_none(entity, arguments.entity));
    if (interruption.wait(kLookAgain))
      throw Interrupted("interrupted before the peer was found", interruption.signal());
  }
}

ILiveParameters::Proxy connect(Entity& entity, const discovery::ServiceDescription& service,
                               Duration within) {
  return entity
      .connect<ILiveParameters>({.system = ConnectOptions::kAnySystem,
                                 .provider = Guid{service.provider},
                                 .timeout = within})
      .within(within);
}

Duration nanoseconds(double seconds) { return Duration(std::llround(seconds * 1e9)); }

std::string with_unit(const std::string& value, const RunningParameter& parameter) {
  return parameter.unit.empty() ? value : value + " " + parameter.unit;
}

std::string number_text(double number) { return nlohmann::json(number).dump(); }

/// `duration, at least 10 ms`.
std::string kind_of(const RunningParameter& parameter) {
  std::string text = parameter.type;
  for (const double minimum : parameter.minimum)
    text += ", at least " + with_unit(number_text(minimum), parameter);
  for (const double maximum : parameter.maximum)
    text += ", at most " + with_unit(number_text(maximum), parameter);
  return parameter.live ? text : text + "; fixed while the peer runs";
}

/// Numbers and booleans as such.
nlohmann::ordered_json value_of(const RunningParameter& parameter) {
  if (parameter.type == "text" || parameter.type == "service") return parameter.value;
  auto value = nlohmann::ordered_json::parse(parameter.value, nullptr, false);
  if (value.is_number() || value.is_boolean()) return value;
  return parameter.value;
}

nlohmann::ordered_json to_json(const RunningParameter& parameter) {
  nlohmann::ordered_json json{{"name", parameter.name},
                              {"value", value_of(parameter)},
                              {"unit", parameter.unit},
                              {"type", parameter.type}};
  for (const double minimum : parameter.minimum) json["minimum"] = minimum;
  for (const double maximum : parameter.maximum) json["maximum"] = maximum;
  json["live"] = parameter.live;
  json["description"] = parameter.description;
  return json;
}

std::string assignment(const RunningParameter& parameter) {
  return parameter.name + " = " + with_unit(parameter.value, parameter);
}

/// What one entity tells, or that it does not.
nlohmann::ordered_json list_of(Entity& entity, const discovery::ServiceDescription& service,
                               Duration within, bool json) {
  const std::string name = entity_name_of(service);
  auto list = nlohmann::ordered_json::array();
  const auto parameters = connect(entity, service, within).parameters();
  if (!json) std::printf("%s\n", printable(name).c_str());
  for (const RunningParameter& parameter : parameters) {
    list.push_back(to_json(parameter));
    if (json) continue;
    std::printf("    %-32s %s\n", printable(assignment(parameter), kLongestText).c_str(),
                printable(kind_of(parameter)).c_str());
  }
  return {{"entity", name}, {"parameters", list}};
}

const RunningParameter& find(const std::vector<RunningParameter>& parameters,
                             const std::string& name) {
  std::vector<std::string> names;
  for (const RunningParameter& parameter : parameters) {
    if (parameter.name == name) return parameter;
    names.push_back(parameter.name);
  }
  throw InvalidArgument("there is no parameter '" + name + "'" + suggestion(name, names) +
                        "; `skein param list` tells all");
}

}  // namespace

int list_parameters(const ParamArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "param");
  const Duration within = nanoseconds(arguments.within);
  auto all = nlohmann::ordered_json::array();
  if (!arguments.entity.empty()) {
    const auto service = await_teller(entity, arguments, interruption);
    all.push_back(list_of(entity, *service, within, arguments.json));
  } else {
    if (arguments.seconds > 0) interruption.wait(arguments.seconds);
    for (const auto& service : tellers(entity, "")) {
      try {
        all.push_back(list_of(entity, *service, within, arguments.json));
      } catch (const Error& error) {  // the others are told all the same
        std::fprintf(stderr, "skein: %s: %s\n", printable(entity_name_of(*service)).c_str(),
                     printable(error.what(), kLongestText).c_str());
      }
    }
  }
  if (arguments.json) {
    print_json(all, true);
  } else if (all.empty()) {
    std::printf("nobody in %s has parameters that may change while it runs\n",
                entity.broker().options().place.c_str());
  }
  if (all.empty()) tell_missions_elsewhere(arguments);
  return 0;
}

int get_parameter(const ParamArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "param");
  const auto service = await_teller(entity, arguments, interruption);
  const auto all = connect(entity, *service, nanoseconds(arguments.within)).parameters();
  const RunningParameter& parameter = find(all, arguments.parameter);
  if (arguments.json) {
    print_json(to_json(parameter), false);
  } else {
    std::printf("%s\n", printable(with_unit(parameter.value, parameter), kLongestText).c_str());
  }
  return 0;
}

int set_parameter(const ParamArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "param");
  const auto service = await_teller(entity, arguments, interruption);
  try {
    const RunningParameter parameter = connect(entity, *service, nanoseconds(arguments.within))
                                           .set(arguments.parameter, arguments.value);
    if (arguments.json) {
      print_json(to_json(parameter), false);
    } else {
      std::printf("%s\n", printable(assignment(parameter), kLongestText).c_str());
    }
    return 0;
  } catch (const launch::ValueRefused& refusal) {
    std::fprintf(stderr, "skein: %s does not take it: %s\n",
                 printable(entity_name_of(*service)).c_str(),
                 printable(refusal.reason, kLongestText).c_str());
    return 1;
  }
}

}  // namespace skein::command
