#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "view/socket_frame.hpp"
#include "view/visit.hpp"

/// WebSockets, without the library that makes them.
namespace skein::view {

/// What is said on one connection, as long as it stands. Its functions are called on the listener's
/// thread, one at a time.
class Session {
 public:
  virtual ~Session() = default;

  virtual void on_text(std::string_view message) = 0;
  virtual void on_binary(std::string_view message) = 0;

  /// What is to be sent now. After nothing, it is asked again when a message has come, and after
  /// Connection::wake().
  virtual std::optional<Frame> next() = 0;
};

/// A session's connection. It lives as long as the session. Thread-safe; never blocks.
class Connection {
 public:
  virtual ~Connection() = default;

  /// Session::next() has something.
  virtual void wake() = 0;
  /// Ends the connection, and with it the session.
  virtual void drop() = 0;
};

struct WebSocketOptions {
  std::string protocol;  ///< That is spoken; empty: one that has no name.
  std::string address;
  std::uint16_t port = 0;       ///< 0: any that is free.
  std::size_t max_clients = 0;  ///< More are refused.
  std::size_t max_message = 0;  ///< Bytes; a client that sends a longer message is dropped.
  /// A connection that is not open after that is dropped. So is the one that has waited longest of
  /// the address that has most of them, if there are many.
  std::chrono::milliseconds handshake{};
  /// So is a client that sent nothing for so long, asked or not, and takes no more of a message.
  std::chrono::milliseconds patience{};
};

/// Takes connections on a thread of its own (`skein-view`).
class WebSocketListener {
 public:
  /// What a visitor gets; nothing: a WebSocket, for which he must have asked.
  using Judge = std::function<std::optional<Reply>(const Visit&)>;
  using Open = std::function<std::unique_ptr<Session>(Connection&)>;

  /// `judge` and `open` are called on its thread. Throws InvalidArgument for an address that is
  /// none, Unavailable where the port cannot be had.
  WebSocketListener(const WebSocketOptions& options, Judge judge, Open open);
  /// Ends all connections. When it returns, there are no sessions. Not from its thread.
  ~WebSocketListener();

  std::uint16_t port() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skein::view
