#include "transport.hpp"

#include <algorithm>
#include <cstring>

namespace skein::dds::fastdds {
namespace {

constexpr std::size_t kMessageHeader = 20;
constexpr std::size_t kPrefix = 8;  // of the sender's GUID, in the header
constexpr std::size_t kPrefixSize = 12;
constexpr std::size_t kSubmessageHeader = 4;
constexpr unsigned char kAckNack = 0x06;
constexpr unsigned char kIgnored = 0x80;  // a submessage of Cyclone's own, which others pass over
constexpr unsigned char kLittleEndian = 0x01;
constexpr unsigned char kFinal = 0x02;

std::uint32_t get(const unsigned char* at, bool little) {
  return little ? at[0] | at[1] << 8 | at[2] << 16 | static_cast<std::uint32_t>(at[3]) << 24
                : at[3] | at[2] << 8 | at[1] << 16 | static_cast<std::uint32_t>(at[0]) << 24;
}

void put(unsigned char* at, std::uint32_t value, bool little) {
  for (int i = 0; i < 4; ++i) at[little ? i : 3 - i] = static_cast<unsigned char>(value >> (8 * i));
}

class StartupTransport final : public eprosima::fastdds::rtps::ChainingTransport {
 public:
  explicit StartupTransport(const StartupTransportDescriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  eprosima::fastdds::rtps::TransportDescriptorInterface* get_configuration() override {
    return &descriptor_;
  }

  bool OpenInputChannel(const rtps::Locator_t& locator,
                        eprosima::fastdds::rtps::TransportReceiverInterface* receiver,
                        std::uint32_t max_size) override {
    const bool opened = ChainingTransport::OpenInputChannel(locator, receiver, max_size);
    // It also says "opened" when asked a second time for a port that was taken.
    if (opened && IsInputChannelOpen(locator)) ++descriptor_.state->ports;
    return opened;
  }

  bool send(rtps::SenderResource* sender, const rtps::octet* message, std::uint32_t size,
            rtps::LocatorsIterator* first, rtps::LocatorsIterator* last,
            const std::chrono::steady_clock::time_point& limit) override {
    // "Sent" although dropped: a failure would only be logged.
    if (!descriptor_.state->open.load(std::memory_order_relaxed)) return true;
    if (!descriptor_.state->watch.may_pass()) return true;
    return sender->send(message, size, first, last, limit);
  }

  void receive(eprosima::fastdds::rtps::TransportReceiverInterface* next,
               const rtps::octet* message, std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    if (!descriptor_.state->watch.may_pass()) return;
    const bool just_returned = descriptor_.state->signs.heard(message, size);
    // The buffer is the receiving socket's own, which nobody reads before `next`.
    repair_.repair(const_cast<rtps::octet*>(message), size, just_returned);
    next->OnDataReceived(message, size, local, remote);
  }

 private:
  StartupTransportDescriptor descriptor_;
  AckNackRepair repair_;
};

}  // namespace

void AckNackRepair::repair(unsigned char* message, std::size_t size, bool just_returned) {
  constexpr unsigned char kCyclone[] = {0x01, 0x10};
  if (size < kMessageHeader || std::memcmp(message, "RTPS", 4) != 0) return;
  if (std::memcmp(message + 6, kCyclone, sizeof kCyclone) != 0) return;
  for (std::size_t at = kMessageHeader; at + kSubmessageHeader <= size;) {
    unsigned char* submessage = message + at;
    const bool little = (submessage[1] & kLittleEndian) != 0;
    std::size_t body =
        little ? submessage[2] | submessage[3] << 8 : submessage[3] | submessage[2] << 8;
    const std::size_t left = size - at - kSubmessageHeader;
    if (body == 0 || body > left) body = left;  // the last submessage may leave its length out
    if (submessage[0] == kAckNack)
      repair_submessage(message + kPrefix, submessage, body, just_returned);
    at += kSubmessageHeader + body;
  }
}

/// Body: reader and writer id, base (high, low), number of bits, bits, count.
void AckNackRepair::repair_submessage(const unsigned char* sender, unsigned char* submessage,
                                      std::size_t body_size, bool just_returned) {
  unsigned char& flags = submessage[1];
  const bool little = (flags & kLittleEndian) != 0;
  unsigned char* body = submessage + kSubmessageHeader;
  if (body_size < 24) return;
  const bool acknowledges = get(body + 8, little) != 0 || get(body + 12, little) > 1;
  if (just_returned && acknowledges) {
    submessage[0] = kIgnored;
    return;
  }
  const std::uint32_t bits = get(body + 16, little);
  if (bits > 256) return;
  const std::size_t count_at = 20 + (bits + 31) / 32 * 4;
  if (count_at + 4 > body_size) return;
  const std::uint32_t count = get(body + count_at, little);
  const bool first =
      count == 0 && bits == 0 && get(body + 8, little) == 0 && get(body + 12, little) == 1;
  std::string endpoints(reinterpret_cast<const char*>(sender), kPrefixSize);
  endpoints.append(reinterpret_cast<const char*>(body), 8);
  put(body + count_at, next_count(endpoints, count, first), little);
  if (!first) return;
  put(body + 12, 0, little);
  flags &= static_cast<unsigned char>(~kFinal);
}

std::uint32_t AckNackRepair::next_count(const std::string& endpoints, std::uint32_t count,
                                        bool first) {
  constexpr std::size_t kMany = 65536;  // endpoints that came and went
  std::lock_guard lock(mutex_);
  if (counts_.size() > kMany) counts_.clear();
  Counts& counts = counts_[endpoints];
  if (first) counts.offset = counts.last + 1;
  const std::uint32_t result = count + counts.offset;
  counts.last = std::max(counts.last, result);
  return result;
}

bool WakeWatch::may_pass() {
  constexpr std::chrono::nanoseconds kSilence = std::chrono::milliseconds(100);
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  const auto last = last_.exchange(now, std::memory_order_relaxed);
  if (last != 0 && now - last > longest_pause_.count()) silent_until_ = now + kSilence.count();
  return now >= silent_until_.load(std::memory_order_relaxed);
}

eprosima::fastdds::rtps::TransportInterface* StartupTransportDescriptor::create_transport() const {
  return new StartupTransport(*this);
}

}  // namespace skein::dds::fastdds
