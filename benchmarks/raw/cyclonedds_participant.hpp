#pragma once

#include <dds/dds.h>

#include <cstdint>

#include "raw/cyclonedds_sample.hpp"
#include "raw/main.hpp"
#include "raw/message.hpp"

namespace skein::benchmarks::raw {

/// The code, where it is no error. Throws Internal where it is.
dds_entity_t check(dds_return_t code);

/// A participant of Cyclone DDS with the transport of Skein's back end, on loopback alone.
class CycloneddsParticipant {
 public:
  /// `greatest_number` of participants are looked for.
  explicit CycloneddsParticipant(std::uint32_t domain, std::uint32_t greatest_number = 3);
  ~CycloneddsParticipant();
  CycloneddsParticipant(const CycloneddsParticipant&) = delete;
  CycloneddsParticipant& operator=(const CycloneddsParticipant&) = delete;

  struct Topic {
    dds_entity_t entity;
    const ddsi_sertype* type;
  };
  Topic topic(const char* name);

  /// For calls: reliable, everything kept.
  dds_entity_t writer(const Topic& topic);
  dds_entity_t reader(const Topic& topic, const dds_listener_t* listener = nullptr);

  /// As Skein's back end makes them.
  dds_entity_t writer(const Topic& topic, Delivery delivery);
  dds_entity_t reader(const Topic& topic, Delivery delivery,
                      const dds_listener_t* listener = nullptr);

  dds_entity_t waitset();

 private:
  dds_entity_t participant_ = 0;
  dds_qos_t* qos_;
};

void write(dds_entity_t writer, const ddsi_sertype* type, const Outgoing& message);

/// False where nothing waits.
bool take(dds_entity_t reader, Message& message);

}  // namespace skein::benchmarks::raw
