#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include "link_reader.hpp"
#include "link_state.hpp"
#include "link_writer.hpp"
#include "skein/guid.hpp"

namespace skein::same_host {

/// Runs an action once, when something ends. Thread-safe.
class Ending {
 public:
  /// False where it is over already: the action will not run.
  bool set(std::function<void()> action);
  /// The action is not running, and will not run. Not from the action.
  void forget();
  void run();

 private:
  std::mutex mutex_;  // held while the action runs
  bool over_ = false;
  std::function<void()> action_;
};

/// One connection as one side sees it: a half that writes to one ring, a half that reads from the
/// other, and the state that both share.
class Link : public LinkState {
 public:
  /// `own` and `peer` are the endpoints' identities on this side and the other. `notify` is called
  /// when the link has ended, from any thread: there may be something to be received, and then
  /// nothing any more.
  Link(Side side, std::shared_ptr<const FileDescriptor> socket, SharedMemory memory,
       DoorbellPair doorbells, const Guid& own, const Guid& peer, std::function<void()> notify);
  ~Link() { close(); }

  const Guid& own() const noexcept { return own_; }
  const Guid& peer() const noexcept { return peer_; }

  LinkReader& in() noexcept { return in_; }
  LinkWriter& out() noexcept { return out_; }

  /// For who writes: runs once the reader's thread has taken what had come before the end.
  Ending& ending() noexcept { return ending_; }

 private:
  const Guid own_;
  const Guid peer_;
  LinkReader in_{*this};
  LinkWriter out_{*this};
  Ending ending_;
};

}  // namespace skein::same_host
