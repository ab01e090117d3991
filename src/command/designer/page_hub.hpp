#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "skein/executor.hpp"
#include "view/web_socket.hpp"

namespace skein::command::designer {

/// Sends each client of the page the newest state of each kind, as fast as the client takes it, and
/// the answers to its requests. Thread-safe; no function waits for a client.
class PageHub : public std::enable_shared_from_this<PageHub> {
 public:
  /// Carries out a request and returns the answer; the text of an exception is the answer, too.
  /// Called on threads of the hub: those of one kind one after the other, unless they may wait for
  /// others.
  struct Obey {
    std::function<std::string(std::string_view request)> obey;
    std::function<bool(std::string_view request)> may_wait;
  };

  /// A client that has so many requests without an answer has to wait.
  static constexpr std::size_t kRequests = 16;

  explicit PageHub(Obey obey) : obey_(std::move(obey)) {}
  ~PageHub();

  enum class Kind { Domain, Design };

  /// Null: there is none any more.
  void publish(Kind kind, std::shared_ptr<const std::string> state);

  /// The newest state of that kind; somebody wants to see it.
  std::shared_ptr<const std::string> look(Kind kind = Kind::Domain);
  /// Whether there is a client, or somebody has looked some seconds ago.
  bool is_watched() const;

  /// A new client.
  std::unique_ptr<view::Session> open(view::Connection& connection);

  /// No request is carried out any more when it returns.
  void close();

 private:
  class Client;
  struct Place {
    view::Connection* connection;
    std::array<std::uint64_t, 2> seen{};  // which states it was sent
    std::size_t requests = 0;
    std::vector<std::string> answers{};
  };

  struct State {
    std::shared_ptr<const std::string> text;
    std::uint64_t number = 0;
  };

  void take(std::uint64_t client, std::string request);
  void answer(std::uint64_t client, std::string text);
  std::optional<view::Frame> next(std::uint64_t client);
  void leave(std::uint64_t client);

  const Obey obey_;
  mutable std::mutex mutex_;  // of all members below, but the executor
  std::map<std::uint64_t, Place> clients_;
  std::uint64_t last_client_ = 0;
  std::array<State, 2> states_;  // by kind
  std::chrono::steady_clock::time_point looked_{};
  // Both are bounded by kRequests.
  ThreadExecutor quick_{"skein-view-call", 1, SIZE_MAX};
  ThreadExecutor waiting_{"skein-view-call", 4, SIZE_MAX};
};

}  // namespace skein::command::designer
