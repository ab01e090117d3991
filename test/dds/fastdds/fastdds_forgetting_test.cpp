// Fast DDS forgets a participant while it sends again what that participant asked for.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <set>
#include <thread>

#include "dds/port/port.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/rtps_packet.hpp"

using namespace skein;
using namespace skein::test;
using namespace skein::test::entity_id;
using namespace std::chrono_literals;

namespace {

constexpr std::uint32_t kDomain = 63;
constexpr std::uint16_t kDiscoveryPort = 7410 + 250 * kDomain;  // RTPS 9.6.1, participant 0
constexpr std::uint16_t kUserPort = kDiscoveryPort + 1;
constexpr int kLeavers = 200;
constexpr int kRequested = 240;

/// A list of parameters, with its encapsulation.
class Parameters {
 public:
  Parameters() { list_.u8(0).u8(3).u16(0); }
  Parameters& add(unsigned id, const OctetWriter& value) {
    list_.u16(id).u16(static_cast<unsigned>(value.octets().size())).append(value.octets());
    return *this;
  }
  Parameters& text(unsigned id, std::string text) {
    const auto size = static_cast<std::uint32_t>(text.size() + 1);
    text.resize((size + 3) / 4 * 4);
    OctetWriter value;
    value.u32(size);
    for (const char each : text) value.u8(static_cast<unsigned char>(each));
    return add(id, value);
  }
  Octets end() { return list_.u16(1).u16(0).octets(); }

 private:
  OctetWriter list_;
};

/// A participant made of packets. It acknowledges nothing.
class Leaver {
 public:
  explicit Leaver(unsigned number) : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    guid_.bytes = {1, 15, 9, 9, 9, 9, 9, 9, 9, 9};
    guid_.bytes[10] = static_cast<std::uint8_t>(number >> 8);
    guid_.bytes[11] = static_cast<std::uint8_t>(number);
    sockaddr_in own = loopback(0);
    bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own);
    socklen_t size = sizeof own;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
    port_ = ntohs(own.sin_port);
  }
  ~Leaver() { close(socket_); }

  Guid guid() const { return guid_; }

  void announce() {
    const auto locator = OctetWriter().u32(1).u32(port_).zeros(12).append(
        std::initializer_list<unsigned char>{127, 0, 0, 1});
    const auto payload = Parameters()
                             .add(0x15, OctetWriter().u8(2).u8(3).u16(0))
                             .add(0x16, OctetWriter().u8(1).u8(15).u16(0))
                             .add(0x50, entity(kParticipant))
                             .add(0x32, locator)
                             .add(0x31, locator)
                             .add(0x02, OctetWriter().u32(60).u32(0))
                             .add(0x58, OctetWriter().u32(0x3f))
                             .end();
    send(kDiscoveryPort, 0x15, kHasPayload,
         data(with_entity(guid_, kParticipantAnnouncer), 1, payload,
              with_entity(guid_, kParticipantDetector)));
  }

  void announce_reader(const dds::Topic& topic) {
    const auto payload = Parameters()
                             .add(0x5a, entity(kReader))
                             .add(0x50, entity(kParticipant))
                             .text(0x05, topic.name)
                             .text(0x07, topic.type_name)
                             .add(0x1a, OctetWriter().u32(2).u32(0).u32(0))  // reliable
                             .end();
    send(kDiscoveryPort, 0x15, kHasPayload,
         data(with_entity(guid_, kSubscriptionsAnnouncer), 1, payload,
              with_entity(guid_, kSubscriptionsDetector)));
  }

  /// Asks for kRequested samples of the writer.
  void request(std::uint16_t port, std::uint32_t reader, const Guid& writer, std::int64_t first) {
    auto body = entities(with_entity(guid_, reader), writer).number(first).u32(kRequested);
    for (int i = 0; i < kRequested; i += 32) {
      body.u32(~std::uint32_t{0} << std::max(0, 32 - (kRequested - i)));
    }
    send(port, 0x06, 0x02, body.u32(1));
  }

  void leave() { send(kDiscoveryPort, farewell(guid_, 2)); }

  static constexpr std::uint32_t kReader = 0x104;

 private:
  static sockaddr_in loopback(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    return address;
  }
  OctetWriter entity(std::uint32_t id) const {
    return OctetWriter().append(with_entity(guid_, id).bytes);
  }
  void send(std::uint16_t port, unsigned kind, unsigned flags, const OctetWriter& body) {
    send(port, RtpsPacket(guid_).submessage(kind, flags, body));
  }
  void send(std::uint16_t port, const RtpsPacket& packet) {
    const Octets& message = packet.octets();
    const sockaddr_in to = loopback(port);
    sendto(socket_, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
  }

  int socket_;
  std::uint16_t port_ = 0;
  Guid guid_;
};

/// A participant on Fast DDS, and who is present to it.
class Stage {
 public:
  Stage() : vendor_(dds::load_vendor("fastdds")) {
    // One that hangs could not even be destroyed: a core shows where.
    std::signal(SIGALRM, [](int) { std::abort(); });
    alarm(280);
    dds::ParticipantOptions options;
    options.domain = kDomain;
    options.on_participant = [this](const Guid& guid, bool present) {
      std::lock_guard lock(mutex_);
      present ? void(present_.insert(guid)) : void(present_.erase(guid));
    };
    participant_ = vendor_->create_participant(options);
  }
  ~Stage() {
    participant_.reset();
    alarm(0);
  }

  dds::Participant& participant() { return *participant_; }
  bool knows(const Leaver& leaver) {
    std::lock_guard lock(mutex_);
    return present_.contains(leaver.guid());
  }
  void meet(Leaver& leaver) {
    // A datagram may be lost where the receiver's buffer is full.
    REQUIRE(eventually([&] {
      leaver.announce();
      return eventually([&] { return knows(leaver); }, std::chrono::seconds(1));
    }));
  }
  /// Requests what was sent a while ago: Fast DDS sends nothing again that it has sent just now.
  /// Leaves at some time of the half millisecond in which Fast DDS sends it.
  template <class Request>
  void see_off(Leaver& leaver, int number, Request&& request) {
    std::this_thread::sleep_for(20ms);
    request();
    const auto at = std::chrono::steady_clock::now() + number % 50 * 10us;
    while (std::chrono::steady_clock::now() < at) {
    }
    leaver.leave();
    REQUIRE(eventually([&] { return !knows(leaver); }));
  }

 private:
  std::shared_ptr<dds::Vendor> vendor_;
  std::mutex mutex_;
  std::set<Guid> present_;
  std::unique_ptr<dds::Participant> participant_;
};

}  // namespace

TEST_CASE("who leaves may just have asked again for withdrawals of endpoints") {
  Stage stage;
  const Guid announcer = with_entity(stage.participant().guid(), kSubscriptionsAnnouncer);
  for (int i = 0; i < kLeavers; ++i) {
    Leaver leaver(static_cast<unsigned>(i));
    stage.meet(leaver);
    // Each reader is announced and withdrawn: two numbers.
    for (int reader = 0; reader < kRequested / 2; ++reader) {
      stage.participant().create_reader({"topic", "Type", false}, {}, {});
    }
    stage.see_off(leaver, i, [&] {
      leaver.request(kDiscoveryPort, kSubscriptionsDetector, announcer, i * kRequested + 1);
    });
  }
}

TEST_CASE("who leaves may just have asked again for samples") {
  Stage stage;
  const dds::Topic topic{"topic", "Type", false};
  const auto writer = stage.participant().create_writer(topic, {}, {});
  std::vector<std::byte> sample(1000);
  sample[1] = std::byte{1};
  for (int i = 0; i < kLeavers; ++i) {
    Leaver leaver(static_cast<unsigned>(i));
    stage.meet(leaver);
    leaver.announce_reader(topic);
    REQUIRE(eventually([&] { return !writer->matched_readers().empty(); }));
    for (int number = 0; number < kRequested; ++number) writer->write(sample, {});
    stage.see_off(leaver, i, [&] {
      leaver.request(kUserPort, Leaver::kReader, writer->guid(), i * kRequested + 1);
    });
    REQUIRE(eventually([&] { return writer->matched_readers().empty(); }));
  }
}
