#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "entity/entity_access.hpp"
#include "idl/types/dynamic_codec.hpp"
#include "idl/types/dynamic_support.hpp"
#include "skein/detail/codec.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

using idl::DynamicSupport;
using idl::DynamicValue;

Guid key_of(const void* value) {
  const auto& dynamic = *static_cast<const DynamicValue*>(value);
  Guid key;
  idl::parse_json(idl::json_of(dynamic), [&](const idl::JsonReader& json) {
    key = idl::key_hash_of(json, dynamic.support->type);
  });
  return key;
}

struct DynamicTopicType {
  DynamicTopicType(const std::string& name, const types::TypeSystem& known, idl::DynamicForm form)
      : types(known), support(checked(types.type(name)), form) {}

  static const idl::DynamicType& checked(const idl::DynamicType& type) {
    if (type.is_struct() || type.is(types::DeclarationKind::Union)) return type;
    throw InvalidArgument("'" + type.declaration->name +
                          "' is no type of a topic: no struct or union");
  }

  idl::DynamicTypes types;
  DynamicSupport support;
  topics::TopicType type{&support, idl::is_keyed(support.type) ? key_of : nullptr,
                         &types.described()};
};

/// Made once and kept until the process ends: vendors' threads may decode until then.
const topics::TopicType& topic_type(const std::string& name, const types::TypeSystem& known,
                                    idl::DynamicForm form = idl::DynamicForm::Json) {
  static std::mutex mutex;
  static auto& made = *new std::map<std::string, std::unique_ptr<DynamicTopicType>>;
  const Bytes types = idl::encode_message(known);
  std::string key = name + (form == idl::DynamicForm::Json ? "\n" : "\r");
  key.append(reinterpret_cast<const char*>(types.data()), types.size());
  std::lock_guard lock(mutex);
  auto& type = made[key];
  if (!type) type = std::make_unique<DynamicTopicType>(name, known, form);
  return type->type;
}

}  // namespace

DynamicPublisher::DynamicPublisher(Entity& entity, const std::string& topic,
                                   const std::string& type, const types::TypeSystem& known,
                                   const TopicQos& qos)
    : type_(topic_type(type, known)),
      writer_(EntityAccess::topic_writer(entity, topic, type_, qos)) {}

void DynamicPublisher::publish(const std::string& json) {
  const DynamicValue value{static_cast<const DynamicSupport*>(type_.support), json};
  topics::held(writer_).publish(&value);
}

void DynamicPublisher::publish_encoded(std::span<const std::byte> cdr) {
  Guid key;
  if (type_.key_of != nullptr) {
    const auto* support = static_cast<const DynamicSupport*>(type_.support);
    DynamicValue value{support, {}};
    support->decode(&value, cdr, idl::kEncapsulation.size());
    key = type_.key_of(&value);
  }
  topics::held(writer_).publish(cdr, key);
}

DynamicSubscription::DynamicSubscription(Entity& entity, const std::string& topic,
                                         const std::string& type, const types::TypeSystem& known,
                                         const TopicQos& qos, Callback callback,
                                         SubscriptionOptions options)
    : reader_(EntityAccess::topic_reader(
          entity, topic, topic_type(type, known), qos,
          [callback = std::move(callback)](const void* value) {
            callback(static_cast<const DynamicValue*>(value)->json);
          },
          std::move(options))) {}

DynamicSubscription::DynamicSubscription(Entity& entity, const std::string& topic,
                                         const std::string& type, const types::TypeSystem& known,
                                         const TopicQos& qos, CdrCallback callback,
                                         SubscriptionOptions options)
    : reader_(EntityAccess::topic_reader(
          entity, topic, topic_type(type, known, idl::DynamicForm::Cdr), qos,
          [callback = std::move(callback)](const void* value) {
            callback(static_cast<const DynamicValue*>(value)->cdr);
          },
          std::move(options))) {}

}  // namespace skein
