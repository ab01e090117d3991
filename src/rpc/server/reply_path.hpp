#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "call_port/call_port.hpp"
#include "rpc/wire/wire.hpp"
#include "skein/clock.hpp"
#include "skein/detail/bytes.hpp"
#include "skein/error.hpp"
#include "skein/executor.hpp"

namespace skein::rpc {

/// What the reply paths of a server share. Thread-safe.
struct ReplyContext {
  /// Octets of replies that wait for room, in all. A client may have no more than are left.
  static constexpr std::size_t kMaxUnsent = 256 << 20;

  void note_lost(std::uint64_t count, const std::string& why);

  Executor& control;
  Clock& clock;
  const calls::Address address;
  std::atomic<std::size_t> unsent{0};
  std::atomic<std::uint64_t> lost{0};  ///< Replies.
};

/// Sends a server's replies to one client. If a reply finds no room, the path keeps it and all
/// later ones, so a client that reads nothing blocks a thread once, not at each reply; `control`
/// sends them within their calls' deadlines. Refusals leave from `control`, too, since a port's
/// threads must not send. Thread-safe.
class ReplyPath : public std::enable_shared_from_this<ReplyPath> {
 public:
  /// The context exists while a function of the path is called.
  explicit ReplyPath(const std::shared_ptr<ReplyContext>& context)
      : context_(*context), weak_context_(context) {}

  void open(std::shared_ptr<calls::Sender> sender);
  /// Replies that wait are dropped, and nothing more is sent. Returns the sender, for a thread that
  /// may destroy it.
  std::shared_ptr<calls::Sender> close();

  /// Null unless it is open.
  std::shared_ptr<calls::Sender> sender() const;
  /// Sends by that sender. Returns false if the reply is lost. Keeps the message's content if there
  /// is no room.
  bool send(const std::shared_ptr<calls::Sender>& sender, Bytes& message, Instant deadline);
  void refuse(const wire::RequestId& id, ErrorCode code, std::string text);

 private:
  struct Refusal {
    wire::RequestId id;
    ErrorCode code;
    std::string text;
  };
  struct Unsent {
    Bytes message;
    Instant deadline;
  };

  void write_refusals();
  bool keep(Bytes& message, Instant deadline);
  void retry_later(Duration after);
  void send_kept();
  std::optional<Unsent> next_kept();
  bool try_to_send(const Unsent& reply, bool await_room);
  void count(std::ptrdiff_t octets);

  ReplyContext& context_;
  const std::weak_ptr<ReplyContext> weak_context_;  // for tasks, which may come after its end
  std::atomic<bool> stalled_{false};                // replies are kept, or about to be
  mutable std::mutex mutex_;
  std::shared_ptr<calls::Sender> sender_;
  std::deque<Refusal> refusals_;
  bool refusing_ = false;  // a task of `control` is about to send them
  std::deque<Unsent> unsent_;
  std::size_t unsent_size_ = 0;
  bool retrying_ = false;  // a task of `control` is about to send them
  TimerId retry_ = 0;
};

}  // namespace skein::rpc
