#include <algorithm>
#include <chrono>
#include <cstdio>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "command/commands.hpp"
#include "command/print/json_output.hpp"
#include "command/print/time_limits.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "mission/process/exit_codes.hpp"
#include "peer_parameters.hpp"
#include "service_names.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/inspector.hpp"
#include "topic_survey.hpp"

namespace skein::command {
namespace {

using brokerless_discovery::Table;
using launch::ILiveParameters;
using launch::RunningParameter;

constexpr std::chrono::milliseconds kParameterPeriod{20};
constexpr std::chrono::milliseconds kAskAgain{200};
/// A name alone may be that of entities in several systems, which are not found at once.
constexpr std::chrono::seconds kSettling{1};
constexpr std::size_t kLongestAssignment = 4096;

/// Who answers, by names.
struct Present {
  std::vector<std::string> names;
  std::string asked;  ///< SYSTEM/NAME of who has the name that is looked for; empty: nobody.
};

Present ask_for(Inspector& inspector, const std::string& name, Duration patience) {
  Present present;
  for (const Inspected& peer : inspector.ask_all(inspection::Subject::Self, patience)) {
    const std::string& whole = peer.answer.entity;
    present.names.push_back(whole);
    present.names.push_back(whole.substr(whole.find('/') + 1));
    if (name == present.names.back() || name == whole) present.asked = whole;
  }
  return present;
}

/// For who is there, and does not tell, or is not there at all.
std::string reason_for_none(const Present& present, const std::string& name) {
  if (!present.asked.empty()) {
    return present.asked +
           " has no parameter that may change while it runs; what it was given stands in its "
           "mission profile";
  }
  return "no entity here is '" + name + "'" + suggestion(name, present.names) +
         "; `skein peers` lists them";
}

/// Why it is left open which of them is meant.
std::string choice_among_namesakes(const Table::Found& found, const std::string& name) {
  std::set<std::string> names;
  std::string processes;
  for (const auto& service : found) {
    names.insert(entity_name_of(*service));
    processes += (processes.empty() ? "" : ", ") + std::to_string(service->pid);
  }
  if (names.size() == 1) {
    return "several processes have the name " + *names.begin() + " (" + processes +
           "): end all but one, or give them other names or systems";
  }
  std::string list;
  for (const std::string& each : names) list += (list.empty() ? "" : ", ") + each;
  return "there are several '" + name + "': name one of " + list;
}

/// Who tells of the parameters of that entity, once it is there. Of several nobody is chosen.
Table::Found::value_type await_teller(Entity& entity, const ParamArguments& arguments) {
  const bool names_system = arguments.entity.find('/') != std::string::npos;
  const Instant end = entity.clock().now() + duration_of(arguments.seconds);
  Inspector inspector(entity);
  Instant settled = Instant::max();
  std::optional<Instant> silent;  // since when it is known to be there, and tells nothing
  for (;; std::this_thread::sleep_for(kParameterPeriod)) {
    const auto found = tellers(entity, arguments.entity);
    if (found.empty()) {
      settled = Instant::max();
      const Present present = ask_for(inspector, arguments.entity, kSettling);
      const Instant now = entity.clock().now();
      silent = present.asked.empty() ? std::nullopt : std::optional(silent.value_or(now));
      if (now >= end || (silent && now >= *silent + kSettling))
        throw Unavailable(reason_for_none(present, arguments.entity));
      std::this_thread::sleep_for(kAskAgain);
      continue;
    }
    const Instant now = entity.clock().now();
    settled = std::min(settled, now + kSettling);
    if (found.size() == 1 && (names_system || now >= settled)) return found.front();
    if (now >= settled) throw InvalidArgument(choice_among_namesakes(found, arguments.entity));
  }
}

/// What the service answers. A TimedOut names the option that helps.
template <class Question>
auto ask(Entity& entity, const discovery::ServiceDescription& service, double within,
         const Question& question) {
  try {
    return question(connect(entity, service, duration_of(within)));
  } catch (const TimedOut& error) {
    throw TimedOut(at_command_line(error.what()));
  }
}

std::vector<RunningParameter> parameters_of(Entity& entity,
                                            const discovery::ServiceDescription& service,
                                            double within) {
  return ask(entity, service, within,
             [](ILiveParameters::Proxy peer) { return peer.parameters(); });
}

std::string with_unit(const std::string& value, const RunningParameter& parameter) {
  return parameter.unit.empty() ? value : value + " " + parameter.unit;
}

/// `60000`, `0.1`.
std::string number_text(double number) {
  std::string text = nlohmann::json(number).dump();
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

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

nlohmann::ordered_json json_of_parameter(const RunningParameter& parameter) {
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

void print_parameters(const std::string& entity, const std::vector<RunningParameter>& parameters) {
  std::printf("%s\n", printable(entity).c_str());
  for (const RunningParameter& parameter : parameters) {
    std::printf("    %-32s %s\n", printable(assignment(parameter), kLongestAssignment).c_str(),
                printable(kind_of(parameter)).c_str());
  }
}

nlohmann::ordered_json json_of_parameter(const std::string& entity,
                                         const std::vector<RunningParameter>& parameters) {
  auto list = nlohmann::ordered_json::array();
  for (const RunningParameter& parameter : parameters) list.push_back(json_of_parameter(parameter));
  return {{"entity", entity}, {"parameters", list}};
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
  Entity entity = join(arguments, "param");
  const bool of_all = arguments.entity.empty();
  Table::Found asked;
  if (of_all) {
    std::this_thread::sleep_for(duration_of(arguments.seconds));
    asked = tellers(entity, "");
  } else {
    asked.push_back(await_teller(entity, arguments));
  }
  // All at once: who does not answer must not take the time of the others.
  std::vector<std::future<std::vector<RunningParameter>>> answers;
  for (const auto& service : asked) {
    answers.push_back(std::async(std::launch::async, [&entity, &arguments, &service] {
      return parameters_of(entity, *service, arguments.within);
    }));
  }
  auto all = nlohmann::ordered_json::array();
  bool complete = true;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::string name = entity_name_of(*asked[i]);
    try {
      const auto parameters = answers[i].get();
      all.push_back(json_of_parameter(name, parameters));
      if (!arguments.json) print_parameters(name, parameters);
    } catch (const Error& error) {
      if (!of_all) throw;
      complete = false;
      std::fprintf(stderr, "skein: %s: %s\n", printable(name).c_str(),
                   printable(error.what(), kLongestAssignment).c_str());
    }
  }
  if (arguments.json) print_json(all, true);
  if (asked.empty()) {
    if (!arguments.json) {
      std::printf("nobody in %s has parameters that may change while it runs\n",
                  entity.broker().options().place.c_str());
    }
    tell_missions_elsewhere(arguments);
  }
  return complete ? 0 : launch::kNoAnswer;
}

int get_parameter(const ParamArguments& arguments) {
  Entity entity = join(arguments, "param");
  const auto service = await_teller(entity, arguments);
  const auto all = parameters_of(entity, *service, arguments.within);
  const RunningParameter& parameter = find(all, arguments.parameter);
  if (arguments.json) {
    print_json(json_of_parameter(parameter), false);
  } else {
    std::printf("%s\n",
                printable(with_unit(parameter.value, parameter), kLongestAssignment).c_str());
  }
  return 0;
}

int set_parameter(const ParamArguments& arguments) {
  Entity entity = join(arguments, "param");
  const auto service = await_teller(entity, arguments);
  const std::string name = entity_name_of(*service);
  try {
    const auto parameter =
        ask(entity, *service, arguments.within, [&](ILiveParameters::Proxy peer) {
          return peer.set(arguments.parameter, arguments.value);
        });
    if (arguments.json) {
      nlohmann::ordered_json json{{"entity", name}};
      json.update(json_of_parameter(parameter));
      print_json(json, false);
    } else {
      std::printf("%s: %s\n", printable(name).c_str(),
                  printable(assignment(parameter), kLongestAssignment).c_str());
    }
    return 0;
  } catch (const launch::ValueRefused& refusal) {
    std::fprintf(stderr, "skein: %s does not take it: %s\n", printable(name).c_str(),
                 printable(refusal.reason, kLongestAssignment).c_str());
    return 1;
  }
}

}  // namespace skein::command
