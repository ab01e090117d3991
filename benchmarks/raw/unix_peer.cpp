// The floor: a stream socket of the Unix domain, two threads that do nothing else, no encoding. A
// server's WAY is how many octets of it are to be resident: what the kernel does when it ends
// depends on that.

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <thread>

#include "raw/main.hpp"

namespace skein::benchmarks::raw {
namespace {

sockaddr_un address_of(std::uint32_t domain, socklen_t& size) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "skein-benchmark-" + std::to_string(domain);
  std::memcpy(address.sun_path + 1, name.data(), name.size());  // abstract: vanishes with its owner
  size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return address;
}

bool send_all(int socket, const void* data, std::size_t size) {
  for (auto at = static_cast<const char*>(data); size > 0;) {
    const ssize_t sent = ::send(socket, at, size, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
  for (auto at = static_cast<char*>(data); size > 0;) {
    const ssize_t received = ::recv(socket, at, size, 0);
    if (received <= 0) return false;
    at += received;
    size -= static_cast<std::size_t>(received);
  }
  return true;
}

bool send_content(int socket, const Content& content) {
  const std::uint64_t size = content.size();
  return send_all(socket, &size, sizeof size) && send_all(socket, content.data(), content.size());
}

std::optional<Content> receive_content(int socket) {
  std::uint64_t size = 0;
  if (!receive_all(socket, &size, sizeof size)) return std::nullopt;
  Content content(size);
  if (!receive_all(socket, content.data(), content.size())) return std::nullopt;
  return content;
}

void serve(int listening) {
  const int client = accept(listening, nullptr, nullptr);
  while (const auto request = receive_content(client)) {
    if (!send_content(client, echo(*request))) break;
  }
  close(client);
}

Content filled_up_to(std::uint64_t resident) {
  const std::uint64_t own = memory_octets("Rss:");
  return Content(resident > own ? resident - own : 0, std::uint8_t{1});
}

void server(const RawOptions& options, const std::function<void()>& meanwhile) {
  const Content fill = options.way.empty() ? Content() : filled_up_to(std::stoull(options.way));
  socklen_t size = 0;
  const sockaddr_un address = address_of(options.domain, size);
  const int listening = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (bind(listening, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(listening, 1) != 0) {
    throw Internal("the Unix socket cannot be had");
  }
  std::thread(serve, listening).detach();
  meanwhile();
}

void client(const RawOptions& options) {
  socklen_t size = 0;
  const sockaddr_un address = address_of(options.domain, size);
  const int server = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (connect(server, reinterpret_cast<const sockaddr*>(&address), size) != 0) {
    throw Internal("the Unix socket's server is not there");
  }
  run_raw_client(
      [server](const Content& content, std::chrono::milliseconds) -> std::optional<Content> {
        if (!send_content(server, content)) return std::nullopt;
        return receive_content(server);
      },
      {{"hold", [](const std::string&) { return "holding"; }},
       {"told", [server](const std::string&) {
          receive_content(server);  // comes never: the socket ends
          const std::string ended = now_text();
          return "told " + ended + " " + ended;
        }}});
}

}  // namespace
}  // namespace skein::benchmarks::raw

int main(int argc, char** argv) {
  using namespace skein::benchmarks::raw;
  return raw_main(argc, argv, server, client);
}
