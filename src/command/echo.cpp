#include <atomic>
#include <cstdio>

#include "commands.hpp"
#include "core/printable.hpp"
#include "json_text.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "topic_survey.hpp"

namespace skein::command {

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
  interruption.wait(arguments.seconds);
  const SubscriptionCounters lost = subscription.counters();
  if (lost.dropped + lost.malformed > 0) {
    std::fprintf(stderr, "skein: %llu values came too fast to be shown, %llu were no %s\n",
                 static_cast<unsigned long long>(lost.dropped),
                 static_cast<unsigned long long>(lost.malformed), printable(topic.type).c_str());
  }
  return arguments.count > 0 && printed < arguments.count ? 1 : 0;
}

}  // namespace skein::command
