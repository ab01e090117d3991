#include <algorithm>

#include "skein/error.hpp"
#include "skein/inspector.hpp"
#include "topic_objects.hpp"

namespace skein::c {
namespace {

TopicQos profile_of(const skein_topic_options& given) {
  const auto period = [&](std::chrono::milliseconds by_default) {
    return std::chrono::ceil<std::chrono::milliseconds>(
        time_of(given.period_ns, "period_ns", by_default));
  };
  switch (given.profile) {
    case SKEIN_TOPIC_EVERY_VALUE:
      return {};
    case SKEIN_TOPIC_SENSOR:
      return TopicQos::sensor(period(std::chrono::milliseconds(500)));
    case SKEIN_TOPIC_COMMAND:
      return TopicQos::command(given.strength, period(std::chrono::milliseconds(100)));
    case SKEIN_TOPIC_STATE:
      return TopicQos::state();
    default:
      throw InvalidArgument(std::to_string(given.profile) + " is no profile of a topic");
  }
}

TopicQos qos_of(const skein_topic_options& given) {
  check_reserved(given.reserved);
  check_value({nullptr, 0, given.encoding});
  TopicQos qos = profile_of(given);
  if (given.systems_size > 0) demand(given.systems, "systems");
  for (std::size_t i = 0; i < given.systems_size; ++i) {
    qos.systems.push_back(text_of(given.systems[i], "a system"));
  }
  return qos;
}

std::string type_of(const InterfaceObject& types, const char* type) {
  if (type) return type;
  if (!types.topic_type().empty()) return types.topic_type();
  throw InvalidArgument("type is NULL, and the types were not fetched for a topic: name one");
}

std::unique_ptr<DynamicSubscription> subscribe(Entity& entity, const std::string& topic,
                                               const std::string& type,
                                               const types::TypeSystem& known,
                                               const skein_topic_options& options,
                                               const skein_subscription_callbacks& callbacks,
                                               const std::shared_ptr<CallbackGate>& gate) {
  const auto tell = [gate, on_value = callbacks.on_value](const skein_value& value) {
    gate->run([&](void* user) { on_value(user, &value); });
  };
  const TopicQos qos = qos_of(options);
  if (options.encoding == SKEIN_STRUCT) {
    return std::make_unique<DynamicSubscription>(
        entity, topic, type, known, qos,
        [tell, support = std::make_shared<TopicType>(known, type)](std::span<const std::byte> cdr) {
          const StructValue value(support->type(), cdr);
          tell(skein_struct(value.data(), value.size()));
        });
  }
  if (options.encoding == SKEIN_CDR) {
    return std::make_unique<DynamicSubscription>(
        entity, topic, type, known, qos,
        [tell](std::span<const std::byte> cdr) { tell(skein_cdr(cdr.data(), cdr.size())); });
  }
  return std::make_unique<DynamicSubscription>(entity, topic, type, known, qos,
                                               [tell](const std::string& json) {
                                                 tell({json.data(), json.size(), SKEIN_JSON});
                                               });
}

/// The topic of that name whose type an entity tells.
KnownTopic known_topic(Inspector& inspector, const std::string& name, Duration timeout) {
  const auto all = known_topics(inspector, timeout);
  const auto found = std::ranges::find(all, name, &KnownTopic::name);
  if (found != all.end()) return *found;
  throw Unavailable("no entity publishes or subscribes to the topic '" + name + "'");
}

}  // namespace
}  // namespace skein::c

using namespace skein;
using namespace skein::c;

bool skein_interface_fetch_topic(skein_entity entity, const char* topic, std::int64_t timeout_ns,
                                 skein_interface* out, skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    const std::string name = text_of(topic, "the topic");
    const Duration timeout = time_of(timeout_ns, "timeout_ns", std::chrono::seconds(5));
    const auto object = find<EntityObject>(entity);
    const auto use = object->use();
    Inspector inspector(*use);
    const KnownTopic found = known_topic(inspector, name, timeout);
    *out = add(std::make_shared<InterfaceObject>(
        ToldInterface{{}, inspector.types(found.type, {}, timeout)}, found.type));
  });
}

bool skein_publisher_new(skein_entity entity, skein_interface types, const char* type,
                         const char* topic, const skein_topic_options* options,
                         skein_publisher* out, skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    const auto known = find<InterfaceObject>(types);
    const std::string name = type_of(*known, type);
    const auto object = find<EntityObject>(entity);
    const auto use = object->use();
    const auto publisher = std::make_shared<PublisherObject>(
        std::make_unique<DynamicPublisher>(*use, text_of(topic, "the topic"), name,
                                           known->told().types,
                                           qos_of(options ? *options : skein_topic_options{})),
        known->told().types, name);
    *out = add(publisher);
    object->end_before(publisher, [raw = publisher.get()] { raw->end(); });
  });
}

bool skein_publisher_publish(skein_publisher publisher, skein_value value, skein_error error) {
  return attempt(error, [&] {
    const auto object = find<PublisherObject>(publisher);
    const auto use = object->use();
    use->publish_encoded(checked(object->support(), value).cdr);
  });
}

bool skein_publisher_subscribers(skein_publisher publisher, std::size_t* out, skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    *out = find<PublisherObject>(publisher)->use()->subscribers();
  });
}

bool skein_publisher_wait(skein_publisher publisher, std::int64_t timeout_ns, bool* acknowledged,
                          skein_error error) {
  return attempt(error, [&] {
    const auto timeout = std::chrono::ceil<std::chrono::milliseconds>(
        time_of(timeout_ns, "timeout_ns", std::chrono::seconds(5)));
    const bool done = find<PublisherObject>(publisher)->use()->wait_for_acknowledgments(timeout);
    if (acknowledged) *acknowledged = done;
  });
}

bool skein_publisher_free(skein_publisher publisher, skein_error error) {
  return attempt(error, [&] {
    if (const auto object = remove<PublisherObject>(publisher)) object->end();
  });
}

bool skein_subscription_new(skein_entity entity, skein_interface types, const char* type,
                            const char* topic, const skein_topic_options* options,
                            const skein_subscription_callbacks* callbacks, skein_subscription* out,
                            skein_error error) {
  return attempt(error, [&] {
    demand(callbacks, "callbacks");
    demand(reinterpret_cast<const void*>(callbacks->on_value), "on_value");
    demand(out, "out");
    const auto known = find<InterfaceObject>(types);
    const auto object = find<EntityObject>(entity);
    const auto use = object->use();
    const auto gate =
        std::make_shared<CallbackGate>(entity.id, callbacks->user, callbacks->on_close);
    const auto subscription = std::make_shared<SubscriptionObject>(
        subscribe(*use, text_of(topic, "the topic"), type_of(*known, type), known->told().types,
                  options ? *options : skein_topic_options{}, *callbacks, gate),
        gate);
    *out = add(subscription);
    object->end_before(subscription, [raw = subscription.get()] { raw->end(); });
  });
}

bool skein_subscription_publishers(skein_subscription subscription, std::size_t* out,
                                   skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    *out = find<SubscriptionObject>(subscription)->use()->publishers();
  });
}

bool skein_subscription_free(skein_subscription subscription, skein_error error) {
  return attempt(error, [&] {
    if (subscription.id == 0) return;
    if (find<SubscriptionObject>(subscription)->gate->is_inside()) {
      throw InvalidArgument(
          "skein_subscription_free() was called in a callback of this subscription, for which it "
          "would wait; call it on another thread");
    }
    remove<SubscriptionObject>(subscription)->end();
  });
}
