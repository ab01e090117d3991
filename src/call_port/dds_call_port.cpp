#include "dds_call_port.hpp"

#include <string>
#include <utility>
#include <vector>

#include "core/system/interface_name.hpp"

namespace skein::calls {
namespace {

dds::Topic topic_of(const std::string& service, const char* suffix) {
  const std::string type = scoped_interface_name(service);
  std::string name = type;
  for (std::size_t at; (at = name.find("::")) != std::string::npos;) name.replace(at, 2, "/");
  return {name + suffix, type + suffix, false};
}

dds::Qos qos_of(const Address& address, std::vector<std::string> partitions) {
  dds::Qos qos;
  if (is_xcdr2(address.representation)) qos.representation = dds::DataRepresentation::Xcdr2;
  qos.partitions = std::move(partitions);
  qos.max_blocking = kPatience;
  return qos;
}

class DdsReceiver final : public Receiver {
 public:
  DdsReceiver(dds::Participant& participant, const dds::Topic& topic, const dds::Qos& qos,
              Listener listener)
      : reader_(participant.create_reader(topic, qos, listener_of(std::move(listener)))) {}

  std::uint64_t malformed() const override { return reader_->counters().malformed; }
  std::shared_ptr<CallerDelivery> caller_delivery() const override { return nullptr; }

 private:
  static dds::ReaderListener listener_of(Listener listener) {
    dds::ReaderListener made;
    made.on_data = [on_message = std::move(listener.on_message)](dds::Reader& reader) {
      reader.take([&on_message](const dds::Sample& sample) {
        if (sample.state == dds::InstanceState::Alive) on_message({sample.cdr, sample.writer});
      });
    };
    made.on_matched = std::move(listener.on_peer);
    return made;
  }

  const std::unique_ptr<dds::Reader> reader_;
};

class DdsSender final : public Sender {
 public:
  DdsSender(dds::Participant& participant, const dds::Topic& topic, const dds::Qos& qos,
            PeerListener on_peer)
      : writer_(participant.create_writer(topic, qos, {std::move(on_peer)})) {}

  void send(std::span<const std::byte> message, const std::function<Duration()>&) override {
    writer_->write(message);
  }
  bool send_lending(std::span<const std::byte>, const std::shared_ptr<LoanMemory>&,
                    std::size_t) override {
    return false;
  }
  bool await_taken(std::chrono::milliseconds timeout) override {
    return writer_->wait_for_acknowledgments(timeout);
  }
  Guid identity() const override { return writer_->guid(); }

 private:
  const std::unique_ptr<dds::Writer> writer_;
};

}  // namespace

dds::Topic request_topic(const Address& address) { return topic_of(address.service, "_Request"); }
dds::Topic reply_topic(const Address& address) { return topic_of(address.service, "_Reply"); }
std::string partition_of(const Guid& peer) { return peer.is_nil() ? std::string() : peer.hex(); }

std::unique_ptr<Receiver> DdsCallPort::receive_requests(const Address& address, bool foreign,
                                                        Listener listener) {
  std::vector<std::string> partitions{partition_of(address.provider)};
  if (foreign) partitions.push_back(partition_of({}));
  return std::make_unique<DdsReceiver>(participant_, request_topic(address),
                                       qos_of(address, std::move(partitions)), std::move(listener));
}

std::unique_ptr<Sender> DdsCallPort::send_replies(const Address& address, const Guid& client,
                                                  PeerListener on_peer) {
  return std::make_unique<DdsSender>(participant_, reply_topic(address),
                                     qos_of(address, {partition_of(client)}), std::move(on_peer));
}

// A vendor's writer does not tell when it waits for room.
std::unique_ptr<Sender> DdsCallPort::send_requests(const Address& address, PeerListener on_peer,
                                                   std::function<void()>) {
  return std::make_unique<DdsSender>(participant_, request_topic(address),
                                     qos_of(address, {partition_of(address.provider)}),
                                     std::move(on_peer));
}

// Servers that are not built with Skein reply in the default partition.
std::unique_ptr<Receiver> DdsCallPort::receive_replies(const Address& address, const Guid& client,
                                                       Listener listener) {
  std::vector<std::string> partitions{partition_of(client)};
  if (address.provider.is_nil()) partitions.push_back(partition_of({}));
  return std::make_unique<DdsReceiver>(participant_, reply_topic(address),
                                       qos_of(address, std::move(partitions)), std::move(listener));
}

}  // namespace skein::calls
