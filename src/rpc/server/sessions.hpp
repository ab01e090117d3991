#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "active_requests.hpp"
#include "admissions.hpp"
#include "core/recent_set.hpp"
#include "reply_path.hpp"
#include "rpc/wire/shared_use.hpp"
#include "rpc/wire/transit_delay.hpp"

namespace skein::rpc {

class Service;

/// A client of a server: it has a session, or is told why not.
struct RemoteClient {
  explicit RemoteClient(const std::shared_ptr<ReplyContext>& context)
      : replies(std::make_shared<ReplyPath>(context)) {}

  const std::shared_ptr<ReplyPath> replies;
  std::shared_ptr<Session> session;
  std::exception_ptr refusal;     ///< What the Head threw instead of making a session.
  TransitDelay transit;           ///< For the thread that receives its requests.
  std::atomic<bool> gone{false};  ///< Its session has ended: nothing of it is executed any more.

  // For Sessions.
  wire::RequestId open{};
  bool found = false;  // it would receive what is sent
  TimerId patience = 0;
};

/// The clients of a server and their sessions, which come and go on `control`. Peers (participants)
/// share the places. Thread-safe.
class Sessions : public std::enable_shared_from_this<Sessions> {
 public:
  /// Sessions in all. A peer may have no more than are left, so that there is one for a newcomer.
  static constexpr std::size_t kMost = 1024;
  static constexpr std::size_t kMostOfPeer = 128;

  struct Counts {
    std::size_t connected = 0;
    std::uint64_t turned_away = 0;
    std::uint64_t lost = 0;  ///< Replies.
  };

  /// All of these exist until end() has returned. `on_left` is called when a session has ended; it
  /// must return soon.
  Sessions(calls::ProviderPort& port, Service& service, ActiveRequests& active, Executor& control,
           Clock& clock, std::function<void()> on_left);

  /// The client for all that are not built with Skein.
  std::shared_ptr<RemoteClient> open_foreign();
  /// Null if it is not known.
  std::shared_ptr<RemoteClient> find(const Guid& client) const;
  /// A client wants a session, or calls without one.
  void announce(Newcomer newcomer);
  /// A client's sender was found or is gone.
  void on_sender(const Guid& client, bool found);
  Counts counts() const;
  /// Ends all sessions; nothing of the port is in use any more. Once; not from `control`.
  void end();

 private:
  using Client = std::shared_ptr<RemoteClient>;

  Client make_client();
  void open(const Newcomer& newcomer);
  void dismiss(const wire::RequestId& id);
  void turn_away(const Guid& client);
  void admit(const wire::RequestId& id, const Client& client);
  bool answer_open(const Guid& key);
  void on_receiver(const Guid& key, const Client& client, bool found);
  void remind(const Guid& key, const std::weak_ptr<RemoteClient>& dismissed,
              std::chrono::milliseconds after);
  void drop(const Guid& key, bool even_if_found);

  calls::ProviderPort& port_;
  Service& service_;
  ActiveRequests& active_;
  const std::function<void()> on_left_;
  ReplyContext context_;
  SharedUse senders_;
  mutable std::mutex mutex_;
  std::unordered_map<Guid, Client> clients_;
  Client foreign_;
  /// Clients whose sessions have ended, in case that one of them comes back.
  RecentSet<Guid> forgotten_{1024};
  std::uint64_t turned_away_ = 0;
  std::atomic<bool> ended_{false};  // changed under the lock
  const std::shared_ptr<Admissions> admissions_;
};

}  // namespace skein::rpc
