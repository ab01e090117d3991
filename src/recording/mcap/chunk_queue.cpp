#include "recording/mcap/chunk_queue.hpp"

namespace skein::recording {
namespace {

constexpr std::size_t kSpareChunks = 4;

}  // namespace

bool ChunkQueue::has_room(std::size_t size) const {
  return waiting_ == 0 || (size <= limits_.capacity && waiting_ <= limits_.capacity - size);
}

bool ChunkQueue::add(const Message& message) {
  const std::size_t size = record_size(message);
  std::unique_lock lock(mutex_);
  if (!has_room(size) && !filling_.empty()) hand_on();
  if (limits_.waits) room_.wait(lock, [&] { return closed_ || has_room(size); });
  if (closed_ || !has_room(size)) return false;
  if (!filling_.empty() && filling_.records().size() + size > limits_.chunk_size) hand_on();
  const bool first = filling_.empty();
  if (first) filling_.began = std::chrono::steady_clock::now();
  filling_.add(message);
  waiting_ += size;
  const bool full = filling_.records().size() >= limits_.chunk_size;
  if (full) hand_on();
  if (first && !full) work_.notify_one();  // it has an age from now on
  return true;
}

void ChunkQueue::hand_on() {
  ready_.push_back(std::move(filling_));
  filling_ = Chunk();
  if (!spare_.empty()) {
    filling_ = std::move(spare_.back());
    spare_.pop_back();
  }
  work_.notify_one();
}

std::optional<Chunk> ChunkQueue::take() {
  std::unique_lock lock(mutex_);
  const auto is_due = [this] { return !ready_.empty() || woken_ || closed_; };
  while (!is_due()) {
    if (filling_.empty()) {
      work_.wait(lock, [&] { return is_due() || !filling_.empty(); });
    } else if (const auto due = filling_.began + limits_.longest;
               work_.wait_until(lock, due) == std::cv_status::timeout && !filling_.empty() &&
               filling_.began + limits_.longest <= std::chrono::steady_clock::now()) {
      hand_on();
    }
  }
  woken_ = false;
  if (ready_.empty() && closed_ && !filling_.empty()) hand_on();
  if (ready_.empty()) return std::nullopt;
  Chunk chunk = std::move(ready_.front());
  ready_.pop_front();
  return chunk;
}

void ChunkQueue::give_back(Chunk chunk) {
  const std::lock_guard lock(mutex_);
  waiting_ -= chunk.records().size();
  chunk.clear();
  const bool usual = chunk.records().capacity() <= 2 * limits_.chunk_size;
  if (usual && spare_.size() < kSpareChunks) spare_.push_back(std::move(chunk));
  room_.notify_all();
}

void ChunkQueue::wake() {
  const std::lock_guard lock(mutex_);
  woken_ = true;
  work_.notify_one();
}

void ChunkQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  work_.notify_one();
  room_.notify_all();
}

bool ChunkQueue::is_drained() const {
  const std::lock_guard lock(mutex_);
  return closed_ && ready_.empty() && filling_.empty();
}

}  // namespace skein::recording
