#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "brokerless_discovery/admission.hpp"
#include "skein/detail/codec.hpp"
#include "test/faults/exposed_service.hpp"
#include "test/faults/processes.hpp"

namespace skein::test {

using brokerless_discovery::Refusal;
using brokerless_discovery::ServiceDescription;

inline dds::Topic description_topic() {
  return {"skein/services", "skein::discovery::ServiceDescription", true};
}

inline dds::Qos description_qos() {
  dds::Qos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  qos.liveliness_lease = std::chrono::milliseconds(1000);
  qos.partitions = {""};
  return qos;
}

/// A participant that is no entity and writes descriptions as it likes.
class Rogue {
 public:
  explicit Rogue(dds::Vendor& vendor) {
    dds::ParticipantOptions options;
    options.domain = 17;
    options.name = "rogue";
    participant_ = vendor.create_participant(options);
    writer_ = participant_->create_writer(description_topic(), description_qos());
    REQUIRE(eventually([&] { return writer_->matched_readers().size() == 2; }));
  }

  /// Of its own, under whatever name.
  ServiceDescription describe(std::uint32_t number, const std::string& entity) const {
    Guid provider = participant_->guid();
    for (int i = 0; i < 3; ++i) {
      provider.bytes[12 + i] = static_cast<std::uint8_t>(number >> 8 * i);
    }
    auto description = describe_echo(provider, entity);
    description.system = "uav-1";
    return description;
  }

  void write(const ServiceDescription& description) { write(description, {description.provider}); }
  void write(const ServiceDescription& description, const Guid& key) {
    write(idl::encode_message(description), key);
  }
  void write(std::span<const std::byte> message, const Guid& key) { writer_->write(message, key); }
  void withdraw(const Guid& provider) { writer_->dispose(provider); }

 private:
  std::unique_ptr<dds::Participant> participant_;
  std::unique_ptr<dds::Writer> writer_;
};

/// A provider and a client that calls it.
struct Scene {
  Scene() {
    REQUIRE(eventually([&] { return client->broker().knows(service.id()); }));
  }

  bool all(const std::function<bool(brokerless_discovery::Broker&)>& holds) {
    return eventually([&] { return holds(server->broker()) && holds(client->broker()); });
  }
  bool all_know(const ServiceDescription& description, bool known = true) {
    return all([&](auto& broker) { return broker.knows({description.provider}) == known; });
  }
  bool all_refused(Refusal why, std::uint64_t count) {
    return all([&](auto& broker) { return broker.refused(why) == count; });
  }

  std::unique_ptr<Entity> server =
      entity_with_lease("server", Pairing::get().server, std::chrono::milliseconds(1000));
  std::unique_ptr<Entity> client =
      entity_with_lease("client", Pairing::get().client, std::chrono::milliseconds(1000));
  ExposedService service{*server, std::make_shared<EchoService>()};
  ::test::LouderEcho::Proxy echo = client->connect<::test::LouderEcho>(
      {.provider = service.id(), .timeout = std::chrono::seconds(20)});
};

inline dds::Vendor& vendor_of_rogue() {
  return *GENERATE(Pairing::get().server, Pairing::get().client);
}

}  // namespace skein::test
