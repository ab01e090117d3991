#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace skein::view {

/// The protocol that clients must offer in their handshake.
inline constexpr std::string_view kProtocol = "foxglove.websocket.v1";

/// What the first HTTP request of a connection says.
struct Visit {
  std::string_view target;  ///< `/?token=...`
  std::string_view origin;  ///< Of the page that asks; programs that are no browsers leave it out.
  std::string_view protocols;  ///< WebSocket protocols that it offers, separated by commas.
  bool upgrade = false;        ///< It asks for a WebSocket.
};

/// Why a visitor may not come in: an HTTP status and a sentence for people.
struct Refusal {
  unsigned status;
  std::string text;
};

/// Decides who may look. Everybody needs the token: any page that a user opens can reach his
/// loopback, and so can other users of the machine.
class Gate {
 public:
  /// `token`: at least 16 of the characters that a URL takes as they are. `origins`: pages that may
  /// look, by scheme, host and port (`http://localhost:8080`); all where it is empty. Throws
  /// InvalidArgument for another token.
  Gate(std::string token, std::vector<std::string> origins);

  /// Nothing: he may come in.
  std::optional<Refusal> refusal(const Visit& visit) const;

 private:
  const std::string token_;
  const std::vector<std::string> origins_;
};

}  // namespace skein::view
