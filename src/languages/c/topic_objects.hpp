#pragma once

#include <memory>

#include "interface_object.hpp"
#include "skein/dynamic.hpp"

namespace skein::c {

/// A topic's type.
class TopicType {
 public:
  TopicType(const types::TypeSystem& known, const std::string& type)
      : types_(known), support_(types_.type(type), idl::DynamicForm::Cdr) {}

  const idl::DynamicType& type() const noexcept { return support_.type; }
  const TypeSupport& support() const noexcept { return support_; }

 private:
  const idl::DynamicTypes types_;
  const idl::DynamicSupport support_;
};

/// A publisher, and the type of its values.
class PublisherObject {
 public:
  PublisherObject(std::unique_ptr<DynamicPublisher> publisher, const types::TypeSystem& known,
                  const std::string& type)
      : type_(known, type), guarded_("publisher", std::move(publisher)) {}

  Guarded<DynamicPublisher>::Use use() { return guarded_.use(); }
  const TypeSupport& support() const noexcept { return type_.support(); }
  void end() { guarded_.end(); }

 private:
  const TopicType type_;
  Guarded<DynamicPublisher> guarded_;
};
SKEIN_NAMES(skein_publisher, Publisher, PublisherObject);

/// A subscription, and the callbacks that it has.
class SubscriptionObject {
 public:
  SubscriptionObject(std::unique_ptr<DynamicSubscription> subscription,
                     std::shared_ptr<CallbackGate> gate_)
      : gate(std::move(gate_)), guarded_("subscription", std::move(subscription)) {}

  Guarded<DynamicSubscription>::Use use() { return guarded_.use(); }
  /// Waits for a running callback.
  void end() {
    guarded_.end();
    gate->close();
  }

  const std::shared_ptr<CallbackGate> gate;

 private:
  Guarded<DynamicSubscription> guarded_;
};
SKEIN_NAMES(skein_subscription, Subscription, SubscriptionObject);

}  // namespace skein::c
