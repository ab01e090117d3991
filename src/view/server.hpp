#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "view/connection_graph.hpp"
#include "view/gate.hpp"

/// Shows a mission to Lichtblick, Foxglove and whoever else speaks foxglove.websocket.v1.
namespace skein::view {

using ChannelId = std::uint32_t;
using ServiceId = std::uint32_t;

struct Options {
  std::string name = "skein";  ///< What clients show.
  std::string address = "127.0.0.1";
  std::uint16_t port = 8765;           ///< 0: any that is free.
  std::string token;                   ///< See Gate. Whoever looks must know it.
  std::vector<std::string> origins{};  ///< See Gate.
  std::size_t max_clients = 16;        ///< More are refused.
  /// Of what waits for one client, in bytes. When it is full, or a sample has waited for a second
  /// and there is a newer one, the oldest samples are dropped; the client is told.
  std::size_t queue = 32 << 20;
  /// Of a client's message, in bytes; who sends a longer one is dropped.
  std::size_t max_message = 1 << 20;
  /// Who has not come in after that is dropped, and earlier if many others wait to come in.
  std::chrono::milliseconds handshake{5000};
  /// So is a client of which nothing is heard, and that takes nothing, for so long.
  std::chrono::milliseconds patience{30'000};
};

/// A topic, whose samples are CDR.
struct Channel {
  std::string topic;   ///< Clients show one channel of each name.
  std::string type;    ///< `skein::introspection::CallEvent`
  std::string schema;  ///< IDL that declares it.
};

/// An operation that clients may call. Requests and responses are JSON, and so are their schemas.
struct Service {
  std::string name;
  std::string type;
  std::string request_schema = R"({"type":"object"})";
  std::string response_schema = R"({"type":"object"})";
};

/// The end of one call. Thread-safe; copies are of the same call. It may outlive the server. A call
/// fails when the last copy goes without an answer, or with what its callback throws.
class Answer {
 public:
  class Call;
  explicit Answer(std::shared_ptr<Call> call) : call_(std::move(call)) {}

  /// The first of these counts.
  void respond(std::string response) const;
  void fail(const std::string& text) const;

 private:
  std::shared_ptr<Call> call_;
};

/// The server. Thread-safe. No function waits for a client.
class Server {
 public:
  /// Whether anybody watches the channel, when that changes.
  using OnWatched = std::function<void(ChannelId channel, bool watched)>;
  using OnCall = std::function<void(std::string_view request, const Answer& answer)>;

  /// Serves from now on. Throws InvalidArgument for an address or a token that is none, Unavailable
  /// where the port cannot be had.
  explicit Server(const Options& options);
  /// As close().
  ~Server();

  /// Ends all connections. When it returns, no callback runs or will run; the other functions have
  /// no effect any more. Not from a callback. Twice is no error.
  void close();

  /// Those that look now.
  std::size_t clients() const;

  /// What to open in a client: `ws://127.0.0.1:8765/?token=...`.
  std::string url() const;

  /// Tells clients of a channel. Callbacks run one at a time, on one thread of the server
  /// (`skein-view-call`), which serves no clients. Text that `on_watched` throws is shown to
  /// clients.
  ChannelId add_channel(Channel channel, OnWatched on_watched = nullptr);
  /// The last that its callback is told is that nobody watches it.
  void remove_channel(ChannelId channel);

  /// Sends a sample, with its encapsulation header, to those who watch the channel; to others it
  /// costs one look-up. `time` is when it was received, in nanoseconds since 1970.
  void send(ChannelId channel, std::uint64_t time, std::span<const std::byte> cdr);

  /// Lets clients call `on_call`, which may answer later, and from elsewhere.
  ServiceId add_service(Service service, OnCall on_call);
  /// Calls that have begun may still be answered.
  void remove_service(ServiceId service);

  /// Clients that look at the graph are told what has changed.
  void set_graph(Graph graph);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace skein::view
