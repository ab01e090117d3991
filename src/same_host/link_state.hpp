#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "core/system/file_descriptor.hpp"
#include "loans.hpp"
#include "ring.hpp"
#include "shared_memory.hpp"

namespace skein::same_host {

/// The state that both halves of a link share: the memory, the socket, and whether the link has
/// ended. The kernel hangs up the socket when the other process ends, even by a crash. Thread-safe.
class LinkState : public std::enable_shared_from_this<LinkState> {
 public:
  enum class Side { Provider, Client };

  /// Octets of each ring.
  static constexpr std::size_t kCapacity = 256 << 10;
  /// Of the memory of both, which the provider makes.
  static constexpr std::size_t kMemory = 4096 + 2 * kCapacity;

  struct DoorbellPair {
    FileDescriptor out;  ///< This side's; it wakes the other side's reader.
    FileDescriptor in;   ///< The other side's; it wakes this side's.
  };

  /// `on_end` is called once, when the link ends, from any thread.
  LinkState(Side side, std::shared_ptr<const FileDescriptor> socket, SharedMemory memory,
            DoorbellPair doorbells, std::function<void()> on_end);
  LinkState(const LinkState&) = delete;
  LinkState& operator=(const LinkState&) = delete;

  const DoorbellPair& doorbells() const noexcept { return doorbells_; }
  const std::shared_ptr<const FileDescriptor>& socket() const noexcept { return socket_; }

  /// This side takes no more messages. The other side's next send() sees that, without a thread
  /// that tells it.
  void stop_taking();
  /// Both sides learn of the end. Nothing more is sent; messages that the other side sent before
  /// can still be received. Twice is no error.
  void close();
  bool ended() const noexcept { return ended_; }
  /// The other side was found to damage the link.
  void break_off();
  bool broken() const noexcept { return broken_; }

  // For the halves.
  Side side() const noexcept { return side_; }
  RingPlace outgoing() const;
  RingPlace incoming() const;
  LoanCounts& loans() const;
  const std::shared_ptr<const SharedMemory>& memory() const noexcept { return memory_; }

 protected:
  ~LinkState() = default;

 private:
  const Side side_;
  const std::shared_ptr<const FileDescriptor> socket_;
  const std::shared_ptr<const SharedMemory> memory_;
  const DoorbellPair doorbells_;
  std::atomic<bool> ended_{false};
  std::atomic<bool> broken_{false};
  const std::function<void()> on_end_;
};

}  // namespace skein::same_host
