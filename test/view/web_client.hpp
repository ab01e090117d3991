#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace skein::test {

/// A WebSocket client made of a plain socket, so that it can misbehave. Reads give up after
/// kPatience.
class WebClient {
 public:
  struct Message {
    bool text;
    std::string bytes;
  };

  /// Connects to the server of this URL, and says nothing yet.
  explicit WebClient(const std::string& url);
  ~WebClient();

  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  /// Asks for a WebSocket; what the server answers, up to the end of the head. With the URL's
  /// target where none is given.
  std::string ask(const std::string& headers = kHeaders, const std::string& target = "");
  /// As ask(); whether the server agrees.
  bool open() { return ask().starts_with("HTTP/1.1 101"); }

  void send_text(std::string_view message) { send_frame(0x1, message); }
  void send_binary(std::string_view message) { send_frame(0x2, message); }
  void send_raw(std::string_view bytes);

  /// The next message; nothing where the connection has ended.
  std::optional<Message> receive();
  /// The next message that contains `part`; earlier ones are passed over.
  std::string await(std::string_view part);
  /// Reads a piece of what is coming, for a later message; false where it has ended.
  bool take(std::size_t most);
  /// Whether the server ends the connection; what it sends before is passed over.
  bool is_ended();

  static constexpr const char* kHeaders =
      "Host: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
      "Sec-WebSocket-Protocol: other, foxglove.websocket.v1\r\n";

 private:
  void send_frame(unsigned operation, std::string_view message);
  std::optional<std::string> read(std::size_t size);
  bool fill(std::size_t most = SIZE_MAX);

  int socket_ = -1;
  std::string target_;
  std::string received_;
};

}  // namespace skein::test
