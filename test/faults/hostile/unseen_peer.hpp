#pragma once

#include <catch2/catch.hpp>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "call_port/dds_call_port.hpp"
#include "rpc/wire/wire.hpp"
#include "skein/detail/operation.hpp"
#include "test/tools/eventually.hpp"

namespace skein::test {

/// Reads the requests to a provider, as anybody can.
class Ear {
 public:
  Ear(dds::Participant& participant, const calls::Address& address) {
    dds::Qos qos;
    qos.partitions = {calls::partition_of(address.provider)};
    dds::ReaderListener listener;
    listener.on_data = [this](dds::Reader& reader) {
      reader.take([this](const dds::Sample& sample) {
        if (sample.state != dds::InstanceState::Alive) return;
        const auto head = rpc::wire::read_request_head(sample.cdr);
        std::lock_guard lock(mutex_);
        client_ = head.id.client;
        heads_.push_back(head);
      });
    };
    reader_ = participant.create_reader(calls::request_topic(address), qos, std::move(listener));
  }

  bool matched() const { return !reader_->matched_writers().empty(); }

  /// Who sent the last request; nil before there was one.
  Guid client() const {
    std::lock_guard lock(mutex_);
    return client_;
  }

  /// The first request of that operation.
  rpc::wire::RequestHead await_request(const InterfaceInfo& interface,
                                       std::string_view operation) const {
    rpc::wire::RequestHead found;
    const bool came = eventually([&] {
      std::lock_guard lock(mutex_);
      for (const auto& head : heads_) {
        const OperationInfo* info = interface.find_operation(head.operation);
        if (!info || info->name != operation) continue;
        found = head;
        return true;
      }
      return false;
    });
    REQUIRE(came);
    return found;
  }

 private:
  mutable std::mutex mutex_;
  Guid client_;
  std::vector<rpc::wire::RequestHead> heads_;
  std::unique_ptr<dds::Reader> reader_;
};

/// Writes replies to a client, as anybody can who knows its GUID.
class Mouth {
 public:
  Mouth(dds::Participant& participant, const calls::Address& address, const Guid& client) {
    dds::Qos qos;
    qos.partitions = {client.hex()};
    writer_ = participant.create_writer(calls::reply_topic(address), qos);
    REQUIRE(eventually([&] { return !writer_->matched_readers().empty(); }));
  }

  void say(const Bytes& message) { writer_->write(message); }

  /// Whether the client's reader has all that was said since it found this writer.
  bool heard() { return writer_->wait_for_acknowledgments(std::chrono::seconds(20)); }

 private:
  std::unique_ptr<dds::Writer> writer_;
};

}  // namespace skein::test
