#include "web_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "test/tools/eventually.hpp"

namespace skein::test {
namespace {

constexpr unsigned kText = 0x1;
constexpr unsigned kClose = 0x8;
constexpr unsigned kPing = 0x9;
constexpr unsigned kPong = 0xA;

std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char byte : bytes) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

}  // namespace

WebClient::WebClient(const std::string& url) {
  const auto host = url.find("//") + 2;
  const auto colon = url.find(':', host);
  const auto slash = url.find('/', host);
  target_ = url.substr(slash);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1, slash - colon - 1))));
  inet_pton(AF_INET, url.substr(host, colon - host).c_str(), &address.sin_addr);
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  // So that little lies in the kernel, and a slow reader is seen to read.
  const int buffer = 64 << 10;
  setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
  const timeval patience{kPatience.count(), 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("no connection to " + url);
  }
}

WebClient::~WebClient() { close(socket_); }

std::string WebClient::ask(const std::string& headers, const std::string& target) {
  send_raw("GET " + (target.empty() ? target_ : target) + " HTTP/1.1\r\n" + headers + "\r\n");
  std::size_t end;
  while ((end = received_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill()) return received_;
  }
  const std::string head = received_.substr(0, end + 4);
  received_.erase(0, end + 4);
  return head;
}

void WebClient::send_raw(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // the server has gone, which the next read tells
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

// Clients mask what they send, with four bytes; these are zero.
void WebClient::send_frame(unsigned operation, std::string_view message) {
  const int octets = message.size() < 126 ? 0 : message.size() < 65536 ? 2 : 8;
  std::string frame(1, static_cast<char>(0x80 | operation));
  frame += static_cast<char>(0x80 | (octets == 0 ? message.size() : octets == 2 ? 126 : 127));
  for (int octet = octets - 1; octet >= 0; --octet) {
    frame += static_cast<char>(std::uint64_t{message.size()} >> (8 * octet) & 0xFF);
  }
  frame.append(4, '\0');
  frame += message;
  send_raw(frame);
}

std::optional<WebClient::Message> WebClient::receive() {
  while (true) {
    const auto head = read(2);
    if (!head) return std::nullopt;
    const unsigned operation = static_cast<unsigned char>((*head)[0]) & 0x0F;
    std::uint64_t size = static_cast<unsigned char>((*head)[1]) & 0x7F;
    if (size >= 126) {
      const auto longer = read(size == 126 ? 2 : 8);
      if (!longer) return std::nullopt;
      size = big_endian(*longer);
    }
    auto bytes = read(size);
    if (!bytes || operation == kClose) return std::nullopt;
    if (operation == kPing) {
      send_frame(kPong, *bytes);
    } else if (operation != kPong) {
      return Message{operation == kText, std::move(*bytes)};
    }
  }
}

bool WebClient::take(std::size_t most) { return fill(most); }

std::string WebClient::await(std::string_view part) {
  while (auto message = receive()) {
    if (message->bytes.find(part) != std::string::npos) return message->bytes;
  }
  return "the connection ended before a message with " + std::string(part);
}

bool WebClient::is_ended() {
  while (receive()) {
  }
  std::array<char, 1> byte{};
  return recv(socket_, byte.data(), 1, 0) == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
}

std::optional<std::string> WebClient::read(std::size_t size) {
  while (received_.size() < size) {
    if (!fill()) return std::nullopt;
  }
  std::string taken = received_.substr(0, size);
  received_.erase(0, size);
  return taken;
}

bool WebClient::fill(std::size_t most) {
  std::array<char, 65536> bytes;
  const auto got = recv(socket_, bytes.data(), std::min(most, bytes.size()), 0);
  if (got <= 0) return false;
  received_.append(bytes.data(), static_cast<std::size_t>(got));
  return true;
}

}  // namespace skein::test
