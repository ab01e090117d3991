#include "call_ports.hpp"

#include <atomic>
#include <utility>

#include "dds/port/sample_format.hpp"
#include "skein/error.hpp"

namespace skein::same_host {
namespace {

// RTPS reserves it for vendors' own kinds of entities: no writer or reader of DDS has it.
constexpr std::uint8_t kEndpointKind = 0x43;

// Of a provider, or of a client's writer.
Guid identity_in(const std::string& partition) {
  if (const auto identity = Guid::from_hex(partition)) return *identity;
  throw InvalidArgument("the partition '" + partition +
                        "' names no peer: through shared memory one is connected to one peer");
}

/// Owns a copy: what lies in the ring is gone after the call that delivers it.
class CopyOwner final : public dds::SampleOwner {
 public:
  CopyOwner(dds::Sample& sample, Turn& turn) : sample_(sample), turn_(turn) {}
  std::shared_ptr<const void> keep() override {
    auto kept = std::make_shared<Bytes>(sample_.cdr);
    sample_.cdr = *kept;
    return kept;
  }
  bool may_take_long() override { return turn_.leave(); }

 private:
  dds::Sample& sample_;
  Turn& turn_;
};

/// A message within on_message(), on the thread that takes it.
struct Current {
  dds::Sample sample;
  Turn& turn;
};
thread_local Current* current = nullptr;

/// A reader's functions over links that an inbox is about.
class LinkReader : public dds::Reader, public Inbox {
 public:
  LinkReader(const Guid& guid, const dds::Qos& qos, dds::ReaderListener listener)
      : guid_(guid), representation_(qos.representation), listener_(std::move(listener)) {}

  // Within on_data alone is there something to take: the message that it was called for.
  std::size_t take(const std::function<void(const dds::Sample&)>& consumer,
                   std::size_t limit) override {
    if (!current || limit == 0) return 0;
    auto [sample, turn] = *std::exchange(current, nullptr);
    CopyOwner owner(sample, turn);
    sample.owner = &owner;
    consumer(sample);
    return 1;
  }

  Guid guid() const override { return guid_; }

  std::vector<Guid> matched_writers() const override {
    std::lock_guard lock(mutex_);
    return matched_;
  }

  dds::ReceiveCounters counters() const override {
    dds::ReceiveCounters counters;
    counters.malformed = malformed_;
    return counters;
  }

  void on_begin(Link& link) override {
    {
      std::lock_guard lock(mutex_);
      matched_.push_back(link.peer());
    }
    if (listener_.on_matched) listener_.on_matched(link.peer(), true);
  }

  void on_message(Link& link, std::span<const std::byte> message, Turn& turn) override {
    if (!dds::has_representation(message, representation_)) {
      ++malformed_;
      return;
    }
    Current own{{}, turn};
    own.sample.cdr = message;
    own.sample.writer = link.peer();
    own.sample.lent = link.lent();
    current = &own;
    listener_.on_data(*this);  // which may outlive this, where it has left its turn
    current = nullptr;
  }

  void on_end(Link& link) override {
    {
      std::lock_guard lock(mutex_);
      std::erase(matched_, link.peer());
    }
    if (listener_.on_matched) listener_.on_matched(link.peer(), false);
  }

 private:
  const Guid guid_;
  const dds::DataRepresentation representation_;
  const dds::ReaderListener listener_;
  std::atomic<std::uint64_t> malformed_{0};
  mutable std::mutex mutex_;
  std::vector<Guid> matched_;
};

/// Writes to the other end of a link; its end is the link's.
class LinkWriter final : public dds::Writer {
 public:
  LinkWriter(const Guid& guid, std::shared_ptr<Link> link, const dds::Qos& qos,
             const dds::WriterListener& listener, bool must_arrive)
      : guid_(guid),
        link_(std::move(link)),
        max_blocking_(qos.max_blocking),
        on_full_(listener.on_full),
        must_arrive_(must_arrive) {
    const auto on_matched = listener.on_matched;
    if (!link_ || !on_matched) return;
    const Guid reader = link_->peer();
    on_matched(reader, true);
    if (!link_->ending().set([on_matched, reader] { on_matched(reader, false); })) {
      on_matched(reader, false);
    }
  }
  ~LinkWriter() override {
    if (!link_) return;
    link_->ending().forget();
    link_->close();
  }

  void write(std::span<const std::byte> cdr, const dds::KeyHash&) override { send(cdr, nullptr); }
  void write_within(const std::function<Duration()>& left,
                    std::span<const std::byte> cdr) override {
    send(cdr, &left);
  }

  bool write_lending(std::span<const std::byte> cdr, const std::shared_ptr<LoanMemory>& value,
                     std::size_t position) override {
    dds::check_size(cdr.size() + sizeof(LoanNote), "a message");
    const auto sent = link_
                          ? link_->send_lending(cdr, value, position, patience(cdr.size(), nullptr))
                          : std::optional(Link::Sent::Ended);
    if (sent) conclude(*sent);
    return sent.has_value();
  }

  void dispose(const dds::KeyHash&) override {
    throw InvalidArgument("calls have no instances to dispose of");
  }

  bool wait_for_acknowledgments(std::chrono::milliseconds timeout) override {
    return !link_ || link_->await_taken(saturating_sum(std::chrono::steady_clock::now(), timeout));
  }

  Guid guid() const override { return guid_; }

  std::vector<Guid> matched_readers() const override {
    return link_ && !link_->ended() ? std::vector<Guid>{link_->peer()} : std::vector<Guid>();
  }

 private:
  void send(std::span<const std::byte> cdr, const std::function<Duration()>* left) const {
    dds::check_size(cdr.size(), "a message");
    conclude(link_ ? link_->send(cdr, patience(cdr.size(), left)) : Link::Sent::Ended);
  }

  // A large message needs time in proportion, which a reader that takes little must not stretch.
  Link::Patience patience(std::size_t size, const std::function<Duration()>* left) const {
    constexpr std::size_t kSlowestReader = 16 << 10;  // octets in a millisecond
    return {max_blocking_ + std::chrono::milliseconds(size / kSlowestReader), on_full_, left};
  }

  void conclude(Link::Sent sent) const {
    switch (sent) {
      case Link::Sent::Yes:
        return;
      case Link::Sent::NoRoom:
        throw Overloaded("the other side has not taken the message from its memory in time: " +
                         std::to_string(max_blocking_.count()) + " ms, and 1 s for each 16 MB");
      case Link::Sent::Ended:
        if (must_arrive_) throw Unavailable("the connection has ended; nothing was sent");
    }
  }

  const Guid guid_;
  const std::shared_ptr<Link> link_;
  const std::chrono::milliseconds max_blocking_;
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

/// Offers the provider while it stands.
class ProviderPort::RequestReader final : public LinkReader {
 public:
  RequestReader(ProviderPort& port, const dds::Qos& qos, dds::ReaderListener listener)
      : LinkReader(port.identities_.next(), qos, std::move(listener)),
        port_(port),
        receiver_("skein-requests", port.options_.spin) {
    for (const std::string& partition : qos.partitions) {
      if (!partition.empty()) providers_.push_back(identity_in(partition));
    }
    for (const Guid& provider : providers_) {
      port_.meeting_.offer(provider, guid(), receiver_.notifier(),
                           [this](std::shared_ptr<Link> link) {
                             port_.add(link);
                             receiver_.add(std::move(link), *this);
                           });
    }
  }
  ~RequestReader() override {
    for (const Guid& provider : providers_) port_.meeting_.withdraw(provider);
    receiver_.remove(*this);
  }

  std::shared_ptr<dds::CallerDelivery> caller_delivery() override { return receiver_.delivery(); }

 private:
  ProviderPort& port_;
  std::vector<Guid> providers_;
  Receiver receiver_;
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

std::unique_ptr<dds::Reader> ProviderPort::create_reader(const dds::Topic&, const dds::Qos& qos,
                                                         dds::ReaderListener listener) {
  return std::make_unique<RequestReader>(*this, qos, std::move(listener));
}

std::unique_ptr<dds::Writer> ProviderPort::create_writer(const dds::Topic&, const dds::Qos& qos,
                                                         dds::WriterListener listener) {
  const Guid client = identity_in(qos.partitions.empty() ? "" : qos.partitions.front());
  return std::make_unique<LinkWriter>(identities_.next(), find(client), qos, listener, false);
}

// ---- clients

class ClientPort::ReplyReader final : public LinkReader {
 public:
  ReplyReader(ClientPort& port, const dds::Qos& qos, dds::ReaderListener listener)
      : LinkReader(port.identities_.next(), qos, std::move(listener)), port_(port) {}
  ~ReplyReader() override { port_.receiver_.remove(*this); }

  void on_end(Link& link) override {
    port_.note_end(link);
    LinkReader::on_end(link);
  }

  /// Before others know of this reader.
  void read(std::shared_ptr<Link> link) { delivery_ = port_.receiver_.add(std::move(link), *this); }
  std::shared_ptr<dds::CallerDelivery> caller_delivery() override { return delivery_; }

 private:
  ClientPort& port_;
  std::shared_ptr<dds::CallerDelivery> delivery_;
};

ClientPort::ClientPort(Meeting& meeting, const PortOptions& options)
    : meeting_(meeting),
      options_(options),
      identities_(options.participant),
      receiver_("skein-replies", options.spin) {}

ClientPort::~ClientPort() = default;

std::unique_ptr<dds::Writer> ClientPort::create_writer(const dds::Topic&, const dds::Qos& qos,
                                                       dds::WriterListener listener) {
  const Guid provider = identity_in(qos.partitions.empty() ? "" : qos.partitions.front());
  const Guid client = identities_.next();
  {
    std::lock_guard lock(mutex_);
    if (distrusted_.contains(provider)) {
      throw Unavailable("the provider has damaged the memory that it shared before");
    }
  }
  auto link = meeting_.join(provider, client, receiver_.notifier());
  {
    std::lock_guard lock(mutex_);
    std::erase_if(connections_, [](const auto& each) { return each.second.link.expired(); });
    connections_.insert_or_assign(client, Connection{link, provider});
  }
  return std::make_unique<LinkWriter>(client, std::move(link), qos, listener, true);
}

std::unique_ptr<dds::Reader> ClientPort::create_reader(const dds::Topic&, const dds::Qos& qos,
                                                       dds::ReaderListener listener) {
  const Guid client = identity_in(qos.partitions.empty() ? "" : qos.partitions.front());
  auto reader = std::make_unique<ReplyReader>(*this, qos, std::move(listener));
  std::shared_ptr<Link> link;
  {
    std::lock_guard lock(mutex_);
    const auto found = connections_.find(client);
    if (found != connections_.end()) link = found->second.link.lock();
  }
  if (link) reader->read(std::move(link));
  return reader;
}

void ClientPort::note_end(const Link& link) {
  std::lock_guard lock(mutex_);
  const auto ended = connections_.extract(link.own());
  if (ended && link.broken()) distrusted_.insert(ended.mapped().provider);
}

}  // namespace skein::same_host
