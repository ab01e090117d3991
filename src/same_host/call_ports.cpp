#include "call_ports.hpp"

#include <atomic>
#include <string>
#include <utility>

#include "dds/port/sample_format.hpp"
#include "skein/detail/channel.hpp"
#include "skein/error.hpp"

namespace skein::same_host {
namespace {

// RTPS reserves it for vendors' own kinds of entities: no writer or reader of DDS has it.
constexpr std::uint8_t kEndpointKind = 0x43;

/// What comes through the links whose inbox it is.
class LinkReceiver : public calls::Receiver, public Inbox {
 public:
  LinkReceiver(const calls::Address& address, calls::Listener listener)
      : representation_(is_xcdr2(address.representation) ? dds::DataRepresentation::Xcdr2
                                                         : dds::DataRepresentation::Xcdr1),
        listener_(std::move(listener)) {}

  std::uint64_t malformed() const override { return malformed_; }

  void on_begin(Link& link) override { tell(link, true); }
  void on_end(Link& link) override { tell(link, false); }

  // The listener may outlive this, once it has left its turn.
  void on_message(Link& link, std::span<const std::byte> message, calls::Turn& turn) override {
    if (dds::has_representation(message, representation_)) {
      listener_.on_message({message, link.peer(), link.in().lent_value(), &turn});
    } else {
      ++malformed_;
    }
  }

 private:
  void tell(const Link& link, bool found) const {
    if (listener_.on_peer) listener_.on_peer(link.peer(), found);
  }

  const dds::DataRepresentation representation_;
  const calls::Listener listener_;
  std::atomic<std::uint64_t> malformed_{0};
};

/// Sends to the other end of a link, which ends with it.
class LinkSender final : public calls::Sender {
 public:
  /// `link` may be null: nobody is there any more.
  LinkSender(std::shared_ptr<Link> link, const calls::PeerListener& on_peer,
             std::function<void()> on_full, bool must_arrive)
      : link_(std::move(link)), on_full_(std::move(on_full)), must_arrive_(must_arrive) {
    if (!link_ || !on_peer) return;
    const Guid peer = link_->peer();
    on_peer(peer, true);
    if (!link_->ending().set([on_peer, peer] { on_peer(peer, false); })) on_peer(peer, false);
  }
  ~LinkSender() override {
    if (!link_) return;
    link_->ending().forget();
    link_->close();
  }

  void send(std::span<const std::byte> message, const std::function<Duration()>& left) override {
    dds::check_size(message.size(), "a message");
    conclude(link_ ? link_->out().send(message, patience(message.size(), left ? &left : nullptr))
                   : LinkWriter::Sent::Ended);
  }

  bool send_lending(std::span<const std::byte> message, const std::shared_ptr<LoanMemory>& value,
                    std::size_t position) override {
    dds::check_size(message.size() + sizeof(LoanNote), "a message");
    const auto sent = link_ ? link_->out().send_lending(message, value, position,
                                                        patience(message.size(), nullptr))
                            : std::optional(LinkWriter::Sent::Ended);
    if (sent) conclude(*sent);
    return sent.has_value();
  }

  bool await_taken(std::chrono::milliseconds timeout) override {
    return !link_ ||
           link_->out().await_taken(saturating_sum(std::chrono::steady_clock::now(), timeout));
  }

  Guid identity() const override { return link_ ? link_->own() : Guid{}; }

 private:
  // A large message needs time in proportion, which a receiver that takes little must not stretch.
  LinkWriter::Patience patience(std::size_t size, const std::function<Duration()>* left) const {
    constexpr std::size_t kSlowestReceiver = 16 << 10;  // octets in a millisecond
    return {calls::kPatience + std::chrono::milliseconds(size / kSlowestReceiver), on_full_, left};
  }

  void conclude(LinkWriter::Sent sent) const {
    switch (sent) {
      case LinkWriter::Sent::Yes:
        return;
      case LinkWriter::Sent::NoRoom:
        throw Overloaded("the other side has not taken the message from its memory in time: " +
                         std::to_string(calls::kPatience.count()) + " ms, and 1 s for each 16 MB");
      case LinkWriter::Sent::Ended:
        if (must_arrive_) throw NotSent("the connection has ended; nothing was sent");
    }
  }

  const std::shared_ptr<Link> link_;
  const std::function<void()> on_full_;
  const bool must_arrive_;
};

}  // namespace

Guid EndpointIdentities::next() {
  const std::uint32_t number = ++last_;
  Guid guid = participant_.participant();
  for (int i = 0; i < 3; ++i)
    guid.bytes[12 + i] = static_cast<std::uint8_t>(number >> (16 - 8 * i));
  guid.bytes[15] = kEndpointKind;
  return guid;
}

// ---- providers

/// Offers the provider while it exists.
class ProviderPort::RequestReceiver final : public LinkReceiver {
 public:
  RequestReceiver(ProviderPort& port, const calls::Address& address, calls::Listener listener)
      : LinkReceiver(address, std::move(listener)),
        port_(port),
        provider_(address.provider),
        receiver_("skein-requests", port.options_.spin) {
    port_.meeting_.offer(provider_, port_.identities_.next(), receiver_.notifier(),
                         [this](std::shared_ptr<Link> link) {
                           port_.add(link);
                           receiver_.add(std::move(link), *this);
                         });
  }
  ~RequestReceiver() override {
    port_.meeting_.withdraw(provider_);
    receiver_.remove(*this);
  }

  std::shared_ptr<calls::CallerDelivery> caller_delivery() const override {
    return receiver_.delivery();
  }

 private:
  ProviderPort& port_;
  const Guid provider_;
  same_host::Receiver receiver_;
};

ProviderPort::ProviderPort(Meeting& meeting, const PortOptions& options)
    : meeting_(meeting), options_(options), identities_(options.participant) {}

ProviderPort::~ProviderPort() = default;

void ProviderPort::add(const std::shared_ptr<Link>& link) {
  std::lock_guard lock(mutex_);
  std::erase_if(links_, [](const auto& each) { return each.second.expired(); });
  links_.insert_or_assign(link->peer(), link);
}

std::shared_ptr<Link> ProviderPort::find(const Guid& client) {
  std::lock_guard lock(mutex_);
  const auto found = links_.find(client);
  return found == links_.end() ? nullptr : found->second.lock();
}

std::unique_ptr<calls::Receiver> ProviderPort::receive_requests(const calls::Address& address, bool,
                                                                calls::Listener listener) {
  return std::make_unique<RequestReceiver>(*this, address, std::move(listener));
}

std::unique_ptr<calls::Sender> ProviderPort::send_replies(const calls::Address&, const Guid& client,
                                                          calls::PeerListener on_peer) {
  return std::make_unique<LinkSender>(find(client), on_peer, nullptr, false);
}

// ---- clients

class ClientPort::ReplyReceiver final : public LinkReceiver {
 public:
  ReplyReceiver(ClientPort& port, const calls::Address& address, calls::Listener listener)
      : LinkReceiver(address, std::move(listener)), port_(port) {}
  ~ReplyReceiver() override { port_.receiver_.remove(*this); }

  void on_end(Link& link) override {
    port_.note_end(link);
    LinkReceiver::on_end(link);
  }

  /// Before others know of this receiver.
  void receive(std::shared_ptr<Link> link) {
    delivery_ = port_.receiver_.add(std::move(link), *this);
  }
  std::shared_ptr<calls::CallerDelivery> caller_delivery() const override { return delivery_; }

 private:
  ClientPort& port_;
  std::shared_ptr<calls::CallerDelivery> delivery_;
};

ClientPort::ClientPort(Meeting& meeting, const PortOptions& options)
    : meeting_(meeting),
      options_(options),
      identities_(options.participant),
      receiver_("skein-replies", options.spin) {}

ClientPort::~ClientPort() = default;

std::unique_ptr<calls::Sender> ClientPort::send_requests(const calls::Address& address,
                                                         calls::PeerListener on_peer,
                                                         std::function<void()> on_full) {
  const Guid client = identities_.next();
  {
    std::lock_guard lock(mutex_);
    if (distrusted_.contains(address.provider)) {
      throw Unavailable("the provider has damaged the memory that it shared before");
    }
  }
  auto link = meeting_.join(address.provider, client, receiver_.notifier());
  {
    std::lock_guard lock(mutex_);
    std::erase_if(connections_, [](const auto& each) { return each.second.link.expired(); });
    connections_.insert_or_assign(client, Connection{link, address.provider});
  }
  return std::make_unique<LinkSender>(std::move(link), on_peer, std::move(on_full), true);
}

std::unique_ptr<calls::Receiver> ClientPort::receive_replies(const calls::Address& address,
                                                             const Guid& client,
                                                             calls::Listener listener) {
  auto receiver = std::make_unique<ReplyReceiver>(*this, address, std::move(listener));
  std::shared_ptr<Link> link;
  {
    std::lock_guard lock(mutex_);
    const auto found = connections_.find(client);
    if (found != connections_.end()) link = found->second.link.lock();
  }
  if (link) receiver->receive(std::move(link));
  return receiver;
}

void ClientPort::note_end(const Link& link) {
  std::lock_guard lock(mutex_);
  const auto ended = connections_.extract(link.own());
  if (ended && link.broken()) distrusted_.insert(ended.mapped().provider);
}

}  // namespace skein::same_host
