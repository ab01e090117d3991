#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "command/commands.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "command/print/local_time.hpp"
#include "command/print/wrapped.hpp"
#include "core/printable.hpp"
#include "entity/entity_access.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "service_names.hpp"
#include "skein/entity.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestFailure = 4096;

const char* word_of(introspection::CallStep step) {
  switch (step) {
    case introspection::CallStep::Sent:
      return "sent";
    case introspection::CallStep::Received:
      return "received";
    case introspection::CallStep::Replied:
      return "replied";
    case introspection::CallStep::RepliedError:
      return "refused";
    case introspection::CallStep::Answered:
      return "answered";
    case introspection::CallStep::EndedInError:
      break;
  }
  return "failed";
}

void print_event(const introspection::CallEvent& event) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  std::array<char, 32> step{};
  std::snprintf(step.data(), step.size(), ".%06u %-8s ",
                static_cast<unsigned>(event.time % kSecond / 1000), word_of(event.step));
  const std::string line = local_time(event.time, "%H:%M:%S") + step.data() +
                           printable(event.entity) + " " + printable(event.service) + "." +
                           printable(event.operation) + " #" + Guid{event.client}.hex() + ":" +
                           std::to_string(event.number) + (event.error.empty() ? "" : "  ") +
                           printable(event.error, kLongestFailure);
  std::printf("%s\n", folded(line, terminal_width()).c_str());
}

void print_event_json(const introspection::CallEvent& event) { print_json(json_of(event), false); }

/// Tells of drops where there are more than the last time.
class Narration {
 public:
  Narration(std::string entity, bool json)
      : entity_(std::move(entity)), print_(json ? print_event_json : print_event) {}

  void tell(const introspection::CallEvents& batch) {
    if (batch.values.empty()) return;
    const std::string& entity = batch.values.front().entity;
    if (!entity_.empty() && !is_entity_named(entity, entity_)) return;
    for (const introspection::CallEvent& event : batch.values) print_(event);
    std::fflush(stdout);
    if (std::exchange(dropped_[entity], batch.dropped) >= batch.dropped) return;
    std::fprintf(stderr, "skein: %s has dropped %llu events\n", printable(entity).c_str(),
                 static_cast<unsigned long long>(batch.dropped));
  }

 private:
  const std::string entity_;  // empty: all
  void (*const print_)(const introspection::CallEvent&);
  std::map<std::string, std::uint64_t> dropped_;
};

}  // namespace

int show_calls(const CallsArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "calls");
  Narration narration(arguments.entity, arguments.json);
  introspection::Reader<introspection::CallEvents> reader(
      EntityAccess::participant(entity), introspection::kTopic<introspection::CallEvents>,
      [&](const introspection::CallEvents& batch) { narration.tell(batch); });
  tell_waiting(arguments, "the next call");
  interruption.wait(arguments.seconds);
  return 0;
}

}  // namespace skein::command
