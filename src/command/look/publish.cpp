#include <cstdio>
#include <nlohmann/json.hpp>

#include "command/commands.hpp"
#include "command/print/json_output.hpp"
#include "command/print/value_lines.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "topic_survey.hpp"

namespace skein::command {
namespace {

constexpr std::chrono::seconds kDeliveryPatience{5};
constexpr std::chrono::milliseconds kAcknowledgmentPeriod{100};
constexpr double kSubscribersPeriod_s = 0.01;

std::size_t subscribers_of(const KnownTopic& topic) {
  std::size_t count = 0;
  for (const auto& endpoint : topic.endpoints) count += endpoint.told.publishes ? 0 : 1;
  return count;
}

void await_subscribers(const DynamicPublisher& publisher, std::size_t expected, double seconds,
                       const Interruption& interruption) {
  for (double waited = 0; publisher.subscribers() < expected && waited < seconds;
       waited += kSubscribersPeriod_s) {
    if (interruption.wait(kSubscribersPeriod_s)) {
      throw Interrupted("interrupted before it published", interruption.signal());
    }
  }
}

/// False where some subscriber has not acknowledged within the time, or before an interruption.
bool await_acknowledgments(DynamicPublisher& publisher, const Interruption& interruption) {
  const auto end = std::chrono::steady_clock::now() + kDeliveryPatience;
  const auto gives_up = interruption.gives_up();
  while (!publisher.wait_for_acknowledgments(kAcknowledgmentPeriod))
    if (gives_up() || std::chrono::steady_clock::now() >= end) return false;
  return true;
}

struct Published {
  std::uint64_t published = 0;
  bool done = false;  ///< Nothing that was asked for is missing.
};

Published publish_lines(DynamicPublisher& publisher, const PublishArguments& arguments,
                        const Interruption& interruption) {
  ValueLines lines(interruption);
  Published outcome;
  while (arguments.count == 0 || outcome.published < arguments.count) {
    const auto value = lines.next();
    if (!value) return {outcome.published, interruption.signal() == 0};
    publisher.publish(*value);
    ++outcome.published;
    if (arguments.rate > 0 && interruption.wait(1 / arguments.rate)) return outcome;
  }
  return {outcome.published, true};
}

Published publish_value(DynamicPublisher& publisher, const PublishArguments& arguments,
                        const Interruption& interruption) {
  const bool endless = arguments.count == 0 && arguments.rate > 0;
  const std::uint64_t count = arguments.count > 0 ? arguments.count : 1;
  Published outcome;
  while (!interruption.came()) {
    publisher.publish(arguments.value);
    ++outcome.published;
    if (!endless && outcome.published == count) return {count, true};
    if (arguments.rate > 0 && interruption.wait(1 / arguments.rate)) break;
  }
  return {outcome.published, endless};
}

void print_published(std::uint64_t published, std::size_t subscribers, bool acknowledged,
                     bool json) {
  if (json) {
    print_json(
        {{"published", published}, {"subscribers", subscribers}, {"acknowledged", acknowledged}},
        false);
    return;
  }
  std::printf("published %llu %s to %zu %s\n", static_cast<unsigned long long>(published),
              published == 1 ? "value" : "values", subscribers,
              subscribers == 1 ? "subscriber" : "subscribers");
}

}  // namespace

int publish(const PublishArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "publish");
  Inspector inspector(entity, interruption.gives_up());
  const KnownTopic topic = await_topic(inspector, arguments.topic, arguments.wait, interruption);
  DynamicPublisher publisher(entity, topic.name, topic.type, types_of(inspector, topic, false),
                             topic.writing_qos());
  await_subscribers(publisher, subscribers_of(topic), arguments.wait, interruption);
  const Published outcome = arguments.value == "-"
                                ? publish_lines(publisher, arguments, interruption)
                                : publish_value(publisher, arguments, interruption);
  const bool acknowledged = await_acknowledgments(publisher, interruption);
  print_published(outcome.published, publisher.subscribers(), acknowledged, arguments.json);
  if (!outcome.done) {
    throw Interrupted("interrupted before all was published", interruption.signal());
  }
  if (!acknowledged) throw TimedOut("not all subscribers have acknowledged what was published");
  return 0;
}

}  // namespace skein::command
