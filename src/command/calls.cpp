#include <cstdio>
#include <ctime>

#include "commands.hpp"
#include "core/printable.hpp"
#include "interruption.hpp"
#include "rpc/introspection_topic.hpp"
#include "skein/entity.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestError = 4096;

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

void print(const introspection::CallEvent& event) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  const auto seconds = static_cast<std::time_t>(event.time / kSecond);
  std::tm local{};
  localtime_r(&seconds, &local);
  char time[16];
  std::strftime(time, sizeof time, "%H:%M:%S", &local);
  std::printf("%s.%06u %-8s %s %s.%s #%s:%llu%s%s\n", time,
              static_cast<unsigned>(event.time % kSecond / 1000), word_of(event.step),
              printable(event.entity).c_str(), printable(event.service).c_str(),
              printable(event.operation).c_str(), Guid{event.client}.hex().c_str(),
              static_cast<unsigned long long>(event.number), event.error.empty() ? "" : "  ",
              printable(event.error, kLongestError).c_str());
  if (event.dropped > 0) {
    std::printf("  (%s has dropped %llu events)\n", printable(event.entity).c_str(),
                static_cast<unsigned long long>(event.dropped));
  }
  std::fflush(stdout);
}

}  // namespace

int show_calls(const CallsArguments& arguments) {
  const Interruption interruption;
  Entity entity(arguments.entity_options("calls"));
  introspection::Reader<introspection::CallEvent> reader(entity.participant(),
                                                         introspection::kCalls, print);
  interruption.wait(arguments.seconds);
  return 0;
}

}  // namespace skein::command
