#include "skein/describe.hpp"

#include <cstdio>
#include <set>
#include <sstream>

#include "brokerless_discovery/broker.hpp"
#include "command/commands.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "core/system/interface_name.hpp"
#include "service_names.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "topic_survey.hpp"

namespace skein::command {
namespace {

/// Of an interface that only an entity's own CSPs have; empty for others.
std::string managed_by(const discovery::ServiceDescription& service, const std::string& name) {
  for (const std::string& part : service.subcomponents) {
    if (is_interface_name(name) &&
        (part == canonical_interface_name(name) || short_interface_name(part) == name)) {
      return "'" + name + "' is a managed interface of " + entity_name_of(service) +
             ": it is between that entity and its CSPs, and its types are told to nobody else; "
             "`skein describe " +
             entity_name_of(service) + "` prints what the entity provides";
    }
  }
  return {};
}

types::TypeSystem types_named(Entity& entity, const std::string& name,
                              const Interruption& interruption) {
  Inspector inspector(entity, interruption.gives_up());
  std::set<std::string> known;
  std::string managed;
  for (const auto& service : entity.broker().all()) {
    known.insert({scoped_interface_name(service->service), short_interface_name(service->service),
                  service->entity});
    if (managed.empty()) managed = managed_by(*service, name);
    const auto participant = entity.broker().participant_of({service->provider});
    if (participant && is_named(*service, name)) {
      return inspector.types(service->service, *participant, kAnswerPatience);
    }
  }
  for (const KnownTopic& topic : known_topics(inspector, kAnswerPatience)) {
    if (topic.name == name || is_type_named(topic.type, name)) {
      tell_conflicts(inspector, topic);
      return types_of(inspector, topic);
    }
    known.insert({topic.name, topic.type});
  }
  if (!managed.empty()) throw Unavailable(managed);
  throw Unavailable("no service, entity or topic here is '" + name + "'" +
                    suggestion(name, std::vector<std::string>(known.begin(), known.end())) +
                    "; `skein services` and `skein topics` list them");
}

/// What a peer told is text of its own.
void print_lines(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::printf("%s\n", printable(line, line.size()).c_str());
  }
}

}  // namespace

int describe(const DescribeArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "describe");
  if (arguments.seconds > 0) interruption.wait(arguments.seconds);
  const types::TypeSystem types = types_named(entity, arguments.name, interruption);
  if (arguments.json) {
    print_json(json_of(types), true);
  } else {
    print_lines(to_idl(types));
  }
  return 0;
}

}  // namespace skein::command
