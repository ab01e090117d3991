#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "call_port/call_port.hpp"
#include "rpc/service/service.hpp"

namespace skein::rpc {

/// Offers a Service to other processes (messages: DDS-RPC, basic mapping). Requests are decoded on
/// the port's thread, executed on the service's executor and answered from there; everything that
/// connects to a client or refuses requests happens on `control`. Each connected client has a
/// sender of its own, so a client that stops reading holds up nobody else. A reply that finds no
/// room there is kept, and sent within its call's deadline.
///
/// Peers (participants) share what a server has: sessions, places in its queues, and the turns of
/// its threads. What one of them asks for beyond its share is refused and counted.
class RemoteServer {
 public:
  struct Options {
    /// Also serve clients that are not built with Skein. Off for managed interfaces.
    bool foreign_clients = true;
    /// What a client that states no deadline gets.
    Duration default_deadline = std::chrono::seconds(60);
    /// Called when a request has come, or has been answered, on the thread that sees it:
    /// Counters::active has changed. May be empty; must return soon.
    std::function<void()> on_load{};
  };

  /// What has happened since the start.
  struct Counters {
    std::uint64_t received = 0;
    std::uint64_t malformed = 0;    ///< Dropped: no request at all, or in another client's name.
    std::uint64_t refused = 0;      ///< Answered with an error before execution.
    std::uint64_t unconnected = 0;  ///< Not executed: from a client that has no session (any more).
    std::uint64_t turned_away = 0;  ///< No session: its peer has its share already.
    std::uint64_t lost = 0;         ///< Replies that found no room before their call's deadline.
    std::size_t clients = 0;        ///< Connected now, foreign ones not counted.
    std::size_t active = 0;         ///< Requests that wait or run now.
  };

  /// `port`, `control` and `clock` outlive the server. Throws what the port throws.
  RemoteServer(calls::ProviderPort& port, Executor& control, Clock& clock,
               std::shared_ptr<Service> service, const Options& options);
  /// Ends all sessions; nothing of the port is in use any more. Not from a task of `control`
  /// or of the service's executor.
  ~RemoteServer();

  Counters counters() const;

  /// Lets a thread that waits for requests take them itself; null if only the port's threads
  /// deliver.
  std::shared_ptr<calls::CallerDelivery> delivery() const;

  /// Call it when the service is about to end and its clients have been told. Refuses requests of
  /// foreign clients, which cannot be told. Waits until no client is connected and no request waits
  /// or runs; returns false at the deadline.
  bool await_clients_gone(Instant deadline);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace skein::rpc
