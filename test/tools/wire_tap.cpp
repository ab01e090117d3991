#include "wire_tap.hpp"

#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace skein::test {
namespace {

constexpr int kRoom = 64 << 20;
constexpr std::size_t kIpHeader = 20;
constexpr std::size_t kUdpHeader = 8;
constexpr std::size_t kMessageHeader = 20;

std::uint16_t big16(const std::byte* at) {
  return static_cast<std::uint16_t>(std::to_integer<int>(at[0]) << 8 | std::to_integer<int>(at[1]));
}

std::uint32_t big32(const std::byte* at) {
  return static_cast<std::uint32_t>(big16(at)) << 16 | big16(at + 2);
}

Packet parse(const std::vector<std::byte>& bytes, std::size_t size) {
  Packet packet;
  packet.protocol = std::to_integer<std::uint8_t>(bytes[9]);
  packet.source = big32(&bytes[12]);
  packet.destination = big32(&bytes[16]);
  const std::size_t header = (std::to_integer<std::size_t>(bytes[0]) & 0x0F) * 4;
  std::size_t content = std::min(header, size);
  if (packet.protocol == IPPROTO_UDP && size >= header + kUdpHeader) {
    packet.source_port = big16(&bytes[header]);
    packet.destination_port = big16(&bytes[header + 2]);
    content = header + kUdpHeader;
  }
  packet.content.assign(bytes.begin() + static_cast<std::ptrdiff_t>(content),
                        bytes.begin() + static_cast<std::ptrdiff_t>(size));
  return packet;
}

// Builtin endpoints have the two highest bits of their kind set, vendors' own the second highest.
bool is_user_endpoint(std::byte kind) { return (kind & std::byte{0xC0}) == std::byte{0}; }

struct UdpSocket {
  std::uint16_t port;
  std::size_t unread;  // bytes, with what the kernel keeps beside them
  std::string inode;
};

/// Those of the network namespace of a process, whose folder in /proc `process` is.
std::vector<UdpSocket> udp_sockets(const std::string& process) {
  const auto behind_colon = [](const std::string& field) {
    return std::stoul(field.substr(field.find(':') + 1), nullptr, 16);
  };
  std::vector<UdpSocket> sockets;
  std::ifstream table(process + "/net/udp");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string skipped, local, queues, inode;
    fields >> skipped >> local >> skipped >> skipped >> queues;
    for (int i = 0; i < 4; ++i) fields >> skipped;
    fields >> inode;
    sockets.push_back(
        {static_cast<std::uint16_t>(behind_colon(local)), behind_colon(queues), inode});
  }
  return sockets;
}

}  // namespace

WireTap::WireTap()
    : socket_(socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
      wake_(eventfd(0, EFD_CLOEXEC)) {
  if (socket_ < 0) {
    std::fprintf(stderr, "skipped: packets may not be captured here\n");
    std::_Exit(77);
  }
  setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &kRoom, sizeof kRoom);
  // Only now: what comes before there is room would be lost.
  sockaddr_ll all{};
  all.sll_family = AF_PACKET;
  all.sll_protocol = htons(ETH_P_ALL);
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&all), sizeof all) != 0) {
    throw std::runtime_error(std::string("packets cannot be captured: ") + std::strerror(errno));
  }
  thread_ = std::thread([this] { run(); });
}

WireTap::~WireTap() {
  end();
  close(socket_);
  close(wake_);
}

void WireTap::end() {
  if (!thread_.joinable()) return;
  eventfd_write(wake_, 1);
  thread_.join();
}

void WireTap::run() {
  std::vector<std::byte> buffer(1 << 17);
  while (true) {
    pollfd waited[] = {{socket_, POLLIN, 0}, {wake_, POLLIN, 0}};
    poll(waited, 2, -1);
    sockaddr_ll from{};
    socklen_t length = sizeof from;
    ssize_t size;
    while ((size = recvfrom(socket_, buffer.data(), buffer.size(), 0,
                            reinterpret_cast<sockaddr*>(&from), &length)) >= 0) {
      // What stays on the machine is seen leaving and arriving: only the former counts.
      const bool counts =
          from.sll_pkttype == PACKET_OUTGOING && ntohs(from.sll_protocol) == ETH_P_IP;
      if (counts && size >= static_cast<ssize_t>(kIpHeader)) {
        std::lock_guard lock(mutex_);
        packets_.push_back(parse(buffer, static_cast<std::size_t>(size)));
      }
    }
    if (waited[1].revents != 0) return;
  }
}

int WireTap::count(const std::function<bool(const Packet&)>& such) const {
  std::lock_guard lock(mutex_);
  return static_cast<int>(std::ranges::count_if(packets_, such));
}

std::vector<Packet> WireTap::stop() {
  end();
  tpacket_stats statistics{};
  socklen_t length = sizeof statistics;
  getsockopt(socket_, SOL_PACKET, PACKET_STATISTICS, &statistics, &length);
  if (statistics.tp_drops > 0) {
    int room = 0;
    socklen_t room_size = sizeof room;
    getsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &room, &room_size);
    throw std::runtime_error("the capture is not complete: " + std::to_string(statistics.tp_drops) +
                             " packets lost beside " + std::to_string(packets_.size()) +
                             " written down, with room for " + std::to_string(room) + " bytes");
  }
  return std::move(packets_);
}

std::vector<DataSubmessage> user_data(const Packet& packet) {
  const auto& bytes = packet.content;
  if (bytes.size() < kMessageHeader || std::memcmp(bytes.data(), "RTPS", 4) != 0) return {};
  std::vector<DataSubmessage> found;
  for (std::size_t at = kMessageHeader; at + 4 <= bytes.size();) {
    const std::byte kind = bytes[at];
    const bool little = (bytes[at + 1] & std::byte{1}) != std::byte{0};
    const std::size_t written = little ? std::to_integer<std::size_t>(bytes[at + 3]) << 8 |
                                             std::to_integer<std::size_t>(bytes[at + 2])
                                       : big16(&bytes[at + 2]);
    const std::size_t left = bytes.size() - at - 4;
    const std::size_t size = written == 0 || written > left ? left : written;
    const bool data = kind == std::byte{0x15} || kind == std::byte{0x16};
    if (data && size >= 12 && is_user_endpoint(bytes[at + 4 + 11])) {
      DataSubmessage submessage;
      std::memcpy(submessage.writer.bytes.data(), &bytes[8], 12);
      std::memcpy(submessage.writer.bytes.data() + 12, &bytes[at + 4 + 8], 4);
      submessage.fragment = kind == std::byte{0x16};
      submessage.payload = {reinterpret_cast<const char*>(&bytes[at + 4]), size};
      found.push_back(submessage);
    }
    at += 4 + size;
  }
  return found;
}

std::set<std::uint16_t> udp_ports_of(pid_t process) {
  const std::string place = "/proc/" + std::to_string(process);
  std::set<std::string> sockets;
  for (const auto& entry : std::filesystem::directory_iterator(place + "/fd")) {
    std::error_code ignored;
    const std::string target = std::filesystem::read_symlink(entry.path(), ignored).string();
    if (target.starts_with("socket:[")) sockets.insert(target.substr(8, target.size() - 9));
  }
  std::set<std::uint16_t> ports;
  for (const UdpSocket& socket : udp_sockets(place)) {
    if (sockets.contains(socket.inode)) ports.insert(socket.port);
  }
  return ports;
}

std::size_t unread_bytes(const std::set<std::uint16_t>& ports) {
  std::size_t bytes = 0;
  for (const UdpSocket& socket : udp_sockets("/proc/self")) {
    if (ports.contains(socket.port)) bytes += socket.unread;
  }
  return bytes;
}

}  // namespace skein::test
