#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// What clients send, by the protocol foxglove.websocket.v1.
namespace skein::view {

struct Subscribe {
  struct Subscription {
    std::uint32_t id;  ///< Chosen by the client.
    std::uint32_t channel;
  };
  std::vector<Subscription> subscriptions;
};

struct Unsubscribe {
  std::vector<std::uint32_t> subscriptions;
};

struct SubscribeGraph {};
struct UnsubscribeGraph {};

struct CallService {
  std::uint32_t service = 0;
  std::uint32_t call = 0;  ///< Chosen by the client.
  std::string encoding;
  std::string request;
};

using ClientMessage =
    std::variant<Subscribe, Unsubscribe, SubscribeGraph, UnsubscribeGraph, CallService>;

/// Throw InvalidArgument for everything that is none of these, with what is wrong.
ClientMessage decode_text(std::string_view text);
ClientMessage decode_binary(std::string_view bytes);

}  // namespace skein::view
