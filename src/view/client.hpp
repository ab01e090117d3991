#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string_view>

#include "view/client_messages.hpp"
#include "view/outbox.hpp"
#include "view/server_state.hpp"
#include "view/web_socket.hpp"

namespace skein::view {

/// One client of the server, from its handshake to its end.
class Client final : public Session {
 public:
  /// Calls of one client that are not answered yet.
  static constexpr std::size_t kMaxCalls = 64;

  Client(std::shared_ptr<ServerState> state, Connection& connection);
  ~Client() override;

  void on_text(std::string_view message) override;
  void on_binary(std::string_view message) override;
  std::optional<Frame> next() override;

  // For the server, under its state's lock:
  void push(Frame message);
  void push_sample(std::uint32_t subscription, Frame sample);
  /// The samples of a channel that is gone.
  void forget(std::uint32_t subscription) { outbox_.forget(subscription); }
  void end_call() { --calls_; }
  bool looks_at_graph() const { return looks_at_graph_; }

 private:
  template <class Decode>
  void obey(std::string_view message, const Decode& decode);
  void obey(const Subscribe& message);
  void obey(const Unsubscribe& message);
  void obey(SubscribeGraph message);
  void obey(UnsubscribeGraph message);
  void obey(CallService& message);
  void subscribe(std::uint32_t subscription, ChannelId channel);
  void complain(const std::string& text);
  bool is_to_be_told_of_dropped() const;

  const std::shared_ptr<ServerState> state_;
  Connection& connection_;
  std::uint64_t number_ = 0;
  Outbox outbox_;
  std::uint64_t told_dropped_ = 0;
  std::map<std::uint32_t, ChannelId> subscriptions_;  // also to channels that have gone since
  bool looks_at_graph_ = false;
  std::size_t calls_ = 0;
};

}  // namespace skein::view
