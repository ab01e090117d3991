#pragma once

#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>

#include "doorbell.hpp"
#include "pass_descriptor.hpp"
#include "skein/error.hpp"
#include "skein/guid.hpp"

/// The handshake of a new connection: a Hello from the client, a JoinAnswer from the provider. Each
/// is a packet that carries its sender's doorbell; a refusal carries none.
namespace skein::same_host {

// A change of the memory's layout is another version.
inline constexpr char kVersion[8] = "skein4";

struct Hello {
  char version[8];
  Guid client;
};

struct JoinAnswer {
  char version[8];
  Guid server;
  char refusal[104];  // empty if the memory comes with it, before the doorbell
};

/// The abstract socket at which the provider's clients come.
inline std::string address_of(const Guid& provider) { return "skein-call/" + provider.hex(); }

template <class Packet>
Packet make_packet() {
  Packet packet{};
  std::memcpy(packet.version, kVersion, sizeof kVersion);
  return packet;
}

template <class Packet>
bool has_our_version(const Packet& packet) {
  return std::memcmp(packet.version, kVersion, sizeof kVersion) == 0;
}

template <class Packet>
bool send_packet(int socket, const Packet& packet, std::initializer_list<int> descriptors = {}) {
  return pass(socket, std::as_bytes(std::span(&packet, 1)), descriptors);
}

template <class Packet>
bool receive_packet(int socket, Packet& packet, std::span<HandedOver> descriptors) {
  return receive_passed(socket, std::as_writable_bytes(std::span(&packet, 1)), descriptors);
}

inline void send_refusal(int socket, JoinAnswer answer, const char* why) {
  std::strncpy(answer.refusal, why, sizeof answer.refusal - 1);
  send_packet(socket, answer);
}

/// Throws Unavailable if none can be made.
inline FileDescriptor new_doorbell() {
  FileDescriptor doorbell = make_doorbell();
  if (!doorbell) throw Unavailable(std::string("no doorbell can be made: ") + std::strerror(errno));
  return doorbell;
}

}  // namespace skein::same_host
