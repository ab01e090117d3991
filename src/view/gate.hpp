#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "view/visit.hpp"

namespace skein::view {

/// The protocol that clients must offer in their handshake.
inline constexpr std::string_view kProtocol = "foxglove.websocket.v1";

/// A token that nobody can guess.
std::string random_token();

/// Throws InvalidArgument unless it has at least 16 of the characters that a URL takes as they are.
void demand_token(std::string_view token);

/// Whether `given` is the secret. How long it takes tells nothing of it but its size.
bool is_secret(std::string_view secret, std::string_view given);

/// Decides who may look. Everybody needs the token: any page that a user opens can reach his
/// loopback, and so can other users of the machine.
class Gate {
 public:
  /// `origins`: pages that may look, by scheme, host and port (`http://localhost:8080`); all where
  /// it is empty. Throws as demand_token().
  Gate(std::string token, std::vector<std::string> origins);

  /// Nothing: he may come in.
  std::optional<Reply> refusal(const Visit& visit) const;

 private:
  const std::string token_;
  const std::vector<std::string> origins_;
};

}  // namespace skein::view
