#include <algorithm>
#include <atomic>
#include <cstdio>
#include <utility>

#include "command/commands.hpp"
#include "command/print/json_text.hpp"
#include "core/printable.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "topic_survey.hpp"

namespace skein::command {
namespace {

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

}  // namespace

int echo(const TopicArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "echo");
  Inspector inspector(entity);
  const KnownTopic topic = await_topic(inspector, arguments.topic, arguments.wait, interruption);
  tell_conflicts(inspector, topic);
  std::atomic<std::uint64_t> printed{0};
  const DynamicSubscription subscription(entity, topic.name, topic.type, types_of(inspector, topic),
                                         topic.reading_qos(), [&](const std::string& json) {
                                           if (arguments.count > 0 && printed == arguments.count)
                                             return;
                                           std::printf("%s\n%s",
                                                       json_text(json, !arguments.json).c_str(),
                                                       arguments.json ? "" : "---\n");
                                           std::fflush(stdout);
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
  std::fprintf(stderr, "skein: %s\n", came.c_str());
  return 1;
}

}  // namespace skein::command
