#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "skein/entity.hpp"

namespace reconnaissance {

/// With these systems, if there are any and the QoS names none itself.
inline skein::TopicQos in_systems(std::vector<std::string> systems, skein::TopicQos qos = {}) {
  if (qos.systems.empty()) qos.systems = std::move(systems);
  return qos;
}

/// An entity's topics in the system of an aircraft, which may be another than its own.
class InSystem {
 public:
  /// Empty: the entity's own system.
  explicit InSystem(skein::Entity& entity, std::string system = "")
      : entity_(entity), system_(std::move(system)) {}

  skein::Entity& entity() const { return entity_; }
  /// As it was named; empty: the entity's own.
  const std::string& name() const { return system_; }

  skein::TopicQos qos(skein::TopicQos qos = {}) const {
    return system_.empty() ? std::move(qos) : in_systems({system_}, std::move(qos));
  }

  template <class T>
  skein::Subscription<T> subscription(const std::string& topic, const skein::TopicQos& wanted,
                                      typename skein::Subscription<T>::Callback callback) const {
    return entity_.subscription<T>(topic, qos(wanted), std::move(callback));
  }

  template <class T>
  skein::Publisher<T> publisher(const std::string& topic,
                                const skein::TopicQos& wanted = {}) const {
    return entity_.publisher<T>(topic, qos(wanted));
  }

  /// Whether an entity is of the system, by `system/name`.
  bool has(const std::string& entity) const {
    return system_.empty() || entity.starts_with(system_ + "/");
  }

  /// To a service of the system.
  template <class Interface>
  typename Interface::Proxy connect(skein::Duration timeout) const {
    skein::ConnectOptions options{.timeout = timeout};
    if (!system_.empty()) options.system = system_;
    return entity_.connect<Interface>(options);
  }

 private:
  skein::Entity& entity_;
  std::string system_;
};

/// Subscriptions that live as long as their owner, of which they are the last member.
class Subscriptions {
 public:
  template <class T>
  void add(const InSystem& system, const std::string& topic, const skein::TopicQos& qos,
           typename skein::Subscription<T>::Callback callback) {
    all_.push_back(std::make_shared<skein::Subscription<T>>(
        system.subscription<T>(topic, qos, std::move(callback))));
  }

 private:
  std::vector<std::shared_ptr<void>> all_;
};

}  // namespace reconnaissance
