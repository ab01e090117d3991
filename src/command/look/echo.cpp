#include <algorithm>
#include <atomic>
#include <cstdio>
#include <utility>

#include "command/commands.hpp"
#include "command/print/json_text.hpp"
#include "core/printable.hpp"
#include "recording/recorded_values.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "topic_survey.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestReason = 4096;

/// Until its time is over or it is interrupted; tells where nobody publishes any more.
void watch_topic(const DynamicSubscription& subscription, const KnownTopic& topic, double seconds,
                 const Interruption& interruption) {
  constexpr double kLookAgain = 1;
  bool has_publisher = false;
  for (double left = seconds; seconds <= 0 || left > 0; left -= kLookAgain) {
    if (interruption.wait(seconds <= 0 ? kLookAgain : std::min(left, kLookAgain))) return;
    const bool had_publisher = std::exchange(has_publisher, subscription.publishers() > 0);
    if (had_publisher && !has_publisher) {
      std::fprintf(stderr,
                   "skein: nobody publishes '%s' any more; Ctrl-C ends the wait for others\n",
                   printable(topic.name).c_str());
    }
  }
}

void print_value(const std::string& json, bool one_line) {
  std::printf("%s\n%s", json_text(json, !one_line).c_str(), one_line ? "" : "---\n");
  std::fflush(stdout);
}

int came_fewer(std::uint64_t printed, std::uint64_t wanted) {
  std::fprintf(stderr, "skein: %llu of %llu values came\n",
               static_cast<unsigned long long>(printed), static_cast<unsigned long long>(wanted));
  return 1;
}

int echo_recording(const TopicArguments& arguments) {
  const Interruption interruption;
  const recording::Reader reader(arguments.file);
  std::uint64_t printed = 0;
  const auto unread = recording::for_each_value(
      reader, {arguments.topic}, [&](const recording::RecordedValue& value) {
        print_value(value.json, arguments.json);
        return ++printed != arguments.count && !interruption.came();
      });
  if (interruption.signal() != 0) {
    throw Interrupted("interrupted: " + std::to_string(printed) + " values were printed",
                      interruption.signal());
  }
  if (unread.count > 0) {
    std::fprintf(stderr, "skein: %s\n",
                 printable(recording::to_text(unread), kLongestReason).c_str());
  }
  return printed < arguments.count ? came_fewer(printed, arguments.count) : 0;
}

}  // namespace

int echo(const TopicArguments& arguments) {
  if (!arguments.file.empty()) return echo_recording(arguments);
  const Interruption interruption;
  Entity entity = join(arguments, "echo");
  Inspector inspector(entity, interruption.gives_up());
  const KnownTopic topic = await_topic(inspector, arguments.topic, arguments.wait, interruption);
  tell_conflicts(inspector, topic);
  std::atomic<std::uint64_t> printed{0};
  const DynamicSubscription subscription(entity, topic.name, topic.type, types_of(inspector, topic),
                                         topic.reading_qos(), [&](const std::string& json) {
                                           if (arguments.count > 0 && printed == arguments.count)
                                             return;
                                           print_value(json, arguments.json);
                                           if (++printed == arguments.count) interruption.end();
                                         });
  watch_topic(subscription, topic, arguments.seconds, interruption);
  const SubscriptionCounters lost = subscription.counters();
  if (lost.dropped + lost.malformed > 0) {
    std::fprintf(stderr, "skein: %llu values came too fast to be shown, %llu were no %s\n",
                 static_cast<unsigned long long>(lost.dropped),
                 static_cast<unsigned long long>(lost.malformed), printable(topic.type).c_str());
  }
  if (arguments.count == 0 || printed >= arguments.count) return 0;
  const std::string came =
      std::to_string(printed) + " of " + std::to_string(arguments.count) + " values came";
  if (interruption.signal() != 0) throw Interrupted("interrupted: " + came, interruption.signal());
  return came_fewer(printed, arguments.count);
}

}  // namespace skein::command
