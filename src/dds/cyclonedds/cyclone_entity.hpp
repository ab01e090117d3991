#pragma once

#include <dds/dds.h>

#include <string>
#include <utility>

#include "dds/port/port.hpp"

namespace skein::dds::cyclonedds {

/// Throws Internal with Cyclone's reason where `code` is an error; returns it otherwise.
dds_return_t check(dds_return_t code, const std::string& what);

/// Owns an entity of Cyclone's. Deleting it waits until none of its listeners runs.
class Entity {
 public:
  Entity() = default;
  explicit Entity(dds_entity_t handle) : handle_(handle) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Entity() { reset(); }
  void reset() noexcept {
    if (handle_ > 0) dds_delete(std::exchange(handle_, 0));
  }
  dds_entity_t handle() const noexcept { return handle_; }
  Guid guid() const;

 private:
  dds_entity_t handle_ = 0;
};

/// Cyclone's form of our QoS, for a writer or a reader of the topic.
class QosSet {
 public:
  QosSet();
  explicit QosSet(const Qos& qos);
  ~QosSet() { dds_delete_qos(qos_); }
  QosSet(const QosSet&) = delete;
  QosSet& operator=(const QosSet&) = delete;
  dds_qos_t* get() const noexcept { return qos_; }

 private:
  dds_qos_t* qos_;
};

}  // namespace skein::dds::cyclonedds
