#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>

#include "recording/mcap/chunk.hpp"

namespace skein::recording {

/// From those who record to the thread that writes: messages are gathered in a chunk, which is
/// handed on when it is full or old. Bounded. All functions are thread-safe.
class ChunkQueue {
 public:
  struct Limits {
    std::size_t chunk_size;            ///< A chunk that has it is full.
    std::chrono::nanoseconds longest;  ///< A chunk is handed on at this age.
    std::size_t capacity;              ///< Bytes that wait, in all chunks.
    bool waits;                        ///< add() waits for room, instead of refusing.
  };

  explicit ChunkQueue(const Limits& limits) : limits_(limits) {}

  /// False if there is no room, and after close(). A message that is larger than the whole queue
  /// has room when nothing else waits.
  bool add(const Message& message);

  /// The next chunk, for which it waits. Nothing if wake() was called, and after close(), when
  /// all are taken.
  std::optional<Chunk> take();
  /// Gives a chunk from take() back: its room and its memory.
  void give_back(Chunk chunk);

  /// Lets take() return.
  void wake();
  /// Nothing is added any more; what waits is still taken.
  void close();
  /// Closed, and all is taken.
  bool is_drained() const;

 private:
  bool has_room(std::size_t size) const;
  void hand_on();

  const Limits limits_;
  mutable std::mutex mutex_;
  std::condition_variable work_;
  std::condition_variable room_;
  Chunk filling_;
  std::deque<Chunk> ready_;
  std::vector<Chunk> spare_;
  std::size_t waiting_ = 0;  // bytes
  bool woken_ = false;
  bool closed_ = false;
};

}  // namespace skein::recording
