#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "link.hpp"
#include "skein/guid.hpp"

namespace skein::same_host {

/// How processes of one host come together: a provider listens on an abstract Unix socket whose
/// name carries its identity; a client connects, and is handed the memory of a new Link. The socket
/// stays open: it tells either side of the other one's end, whatever ended it. One thread,
/// `skein-meeting`. Thread-safe.
///
/// The kernel says who is at the other end, and the rules whether that user is spoken to; anybody
/// may take any name. A user who is turned away, and the first process that wants more than its
/// share, are told of in the log, once each.
class Meeting {
 public:
  struct Rules {
    /// Who is let in, and whom one connects to; never users that this namespace does not map.
    std::vector<uid_t> users{geteuid(), 0};
    /// Connections from others at a time, and from one of their processes. Each takes four
    /// descriptors and Link::kMemory.
    std::size_t guests = 1024;
    std::size_t guests_of_process = 128;
    /// Of those that have not said yet who they are.
    std::size_t newcomers = 64;
    /// How long they may take for it, and how long a client waits for the answer: on a busy machine
    /// a sound provider can take seconds.
    std::chrono::milliseconds patience{5000};
  };

  /// Given a new link on the meeting's thread; must return soon.
  using Welcome = std::function<void(std::shared_ptr<Link>)>;

  /// Throws Unavailable where the kernel gives no descriptor.
  explicit Meeting(Rules rules);
  Meeting() : Meeting(Rules()) {}
  /// Nobody is let in any more; links that are left hear of no end.
  ~Meeting();

  /// Lets clients in to `provider`, whose endpoint is `server`, of the same participant; the links
  /// notify by `notify`.
  /// Throws as the constructor.
  void offer(const Guid& provider, const Guid& server, std::function<void()> notify,
             Welcome welcome);
  /// `welcome` is not running, and will not run. Not from it.
  void withdraw(const Guid& provider);

  /// A link to `provider` for the endpoint `client`. Blocks for Rules::patience at most. Throws
  /// Unavailable with the reason why there is none, also where somebody else than the provider's
  /// participant answers under its name.
  std::shared_ptr<Link> join(const Guid& provider, const Guid& client,
                             std::function<void()> notify);

  struct Counters {
    std::size_t guests = 0;      ///< Connections from others, now.
    std::size_t newcomers = 0;   ///< Those that have not said who they are, now.
    std::uint64_t refused = 0;   ///< Connections turned away, since the start.
    std::uint64_t wake_ups = 0;  ///< Of the thread, since the start.
  };
  Counters counters() const;

 private:
  struct State;
  const std::unique_ptr<State> state_;
};

}  // namespace skein::same_host
