#include "transport.hpp"

#include "announced_representation.hpp"
#include "put_off_leases.hpp"

namespace skein::dds::fastdds {
namespace {

using namespace rtps_message;

/// The IPv4 address of a UDPv4 locator, in host order; 0 of others.
std::uint32_t address_of(const rtps::Locator_t& locator) {
  return locator.kind == LOCATOR_KIND_UDPv4 ? get32(locator.address + 12, false) : 0;
}

/// RTPS 9.6.1: discovery has the even ports, samples have the odd ones.
bool is_discovery(const rtps::Locator_t& local) { return local.port % 2 == 0; }

class StartupTransport final : public TransportBefore {
 public:
  explicit StartupTransport(const StartupTransportDescriptor& descriptor)
      : TransportBefore(descriptor), descriptor_(descriptor) {}

  transports::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  // By RTPS's ports, whatever the participant counts its own by (participant_attributes).
  bool configureInitialPeerLocator(rtps::Locator_t& locator, const rtps::PortParameters&,
                                   std::uint32_t domain,
                                   rtps::LocatorList_t& peers) const override {
    return ChainingTransport::configureInitialPeerLocator(locator, {}, domain, peers);
  }

  bool OpenInputChannel(const rtps::Locator_t& locator,
                        transports::TransportReceiverInterface* receiver,
                        std::uint32_t max_size) override {
    const bool opened = ChainingTransport::OpenInputChannel(locator, receiver, max_size);
    // It also says "opened" when asked a second time for a port that was taken.
    if (opened && IsInputChannelOpen(locator)) ++descriptor_.state->ports;
    return opened;
  }

  bool send_message(Outgoing message, rtps::LocatorsIterator* first,
                    rtps::LocatorsIterator* last) override {
    // "Sent" although dropped: a failure would only be logged.
    if (!descriptor_.state->open.load(std::memory_order_relaxed)) return true;
    const auto now = std::chrono::steady_clock::now();
    if (!descriptor_.state->suspend.may_send(now)) return true;
    Guid receiver;
    std::optional<std::int64_t> number;
    message.for_each_submessage([&](const Submessage& submessage) {
      descriptor_.state->guard.sent(submessage, receiver);
      if (const auto announced = announcement_number(submessage)) number = announced;
      if constexpr (kForgettingMayHang) descriptor_.state->discovery.sent.note(submessage);
      if constexpr (!kAnnouncesRepresentation) announce_representation(submessage);
    });
    if (!number) return message.send(first, last);
    std::vector<rtps::Locator_t> due;
    for (; *first != *last; ++*first) {
      const rtps::Locator_t& locator = **first;
      const AnnouncementPace::Destination destination{message.sender(), address_of(locator),
                                                      locator.port};
      if (descriptor_.state->pace.due(*number, destination, now)) due.push_back(locator);
    }
    rtps::Locators begin(due.begin());
    rtps::Locators end(due.end());
    return due.empty() || message.send(&begin, &end);
  }

  void receive(transports::TransportReceiverInterface* next, const rtps::octet* message,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    const auto now = std::chrono::steady_clock::now();
    if (!descriptor_.state->suspend.may_receive(now)) return;
    // The buffer is the receiving socket's own, which nobody reads before `next`.
    auto* writable = const_cast<rtps::octet*>(message);
    const RtpsGuard::Passed passed =
        descriptor_.state->guard.pass(writable, size, address_of(remote), now);
    if (passed.size == 0) return;
    const auto length = static_cast<std::uint32_t>(passed.size);
    const bool just_returned = descriptor_.state->lease_watch.heard(sender(message), now);
    if (passed.acknowledges) repair_.repair(writable, length, just_returned);
    if (passed.announces) {
      put_off_leases(writable, length);
      descriptor_.state->discovery.announced_at(next);
    }
    if (is_discovery(local)) {
      descriptor_.state->discovery.receive(*next, writable, passed, local, remote);
    } else {
      next->OnDataReceived(message, length, local, remote);
    }
  }

 private:
  StartupTransportDescriptor descriptor_;
  AckNackRepair repair_;
};

}  // namespace

void DiscoveryInput::receive(Receiver& receiver, unsigned char* message,
                             const RtpsGuard::Passed& passed, const rtps::Locator_t& local,
                             const rtps::Locator_t& remote) {
  std::lock_guard lock(mutex_);
  if (kForgettingMayHang && passed.announces) {
    for_each_farewell(message, passed.size,
                      [&](const Guid& participant) { acknowledge_all(receiver, participant); });
  }
  receiver.OnDataReceived(message, static_cast<std::uint32_t>(passed.size), local, remote);
}

void DiscoveryInput::acknowledge_all(Receiver& receiver, const Guid& participant) {
  const auto message = sent.acknowledged_by(participant);
  receiver.OnDataReceived(message.data(), message.size(), {}, {});
}

void DiscoveryInput::say_farewell(const Guid& participant) {
  auto message = make_farewell(participant);
  std::lock_guard lock(mutex_);
  Receiver* receiver = receiver_;
  if (closed_ || receiver == nullptr) return;
  if (kForgettingMayHang) acknowledge_all(*receiver, participant);
  receiver->OnDataReceived(message.data(), message.size(), {}, {});
}

void DiscoveryInput::close() {
  std::lock_guard lock(mutex_);
  closed_ = true;
}

transports::TransportInterface* StartupTransportDescriptor::create_transport() const {
  return new StartupTransport(*this);
}

}  // namespace skein::dds::fastdds
