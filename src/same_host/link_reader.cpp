#include "link_reader.hpp"

#include <utility>

namespace skein::same_host {
namespace {

// A message that needed more is not kept for the next one.
constexpr std::size_t kKeptCapacity = 4 << 20;

}  // namespace

std::optional<std::span<const std::byte>> LinkReader::receive(Bytes& spare) {
  if (message_.empty()) message_.swap(spare);
  try {
    if (ring_.take(message_)) {
      if (!ring_.lends()) return std::span<const std::byte>(message_);
      lent_ = borrow();
      if (lent_)
        return std::span<const std::byte>(message_).first(message_.size() - sizeof(LoanNote));
      message_.clear();
    }
  } catch (const BrokenRing&) {
    state_.break_off();
    throw;
  }
  if (message_.empty()) message_.swap(spare);
  if (unfinished_ != message_.size()) unfinished_ = message_.size();
  return std::nullopt;
}

// Returns nullopt if the message only tells that a memory is gone.
std::optional<calls::LentValue> LinkReader::borrow() {
  if (state_.side() != LinkState::Side::Provider) throw BrokenRing("a reply that lends");
  if (!borrower_) borrower_.emplace(state_.socket(), &state_.loans(), state_.memory());
  return borrower_->borrow(message_);
}

void LinkReader::release(Bytes& spare) {
  message_.clear();
  lent_.reset();
  if (unfinished_ != 0) unfinished_ = 0;
  if (message_.capacity() > kKeptCapacity) message_ = Bytes();
  spare = std::move(message_);
}

}  // namespace skein::same_host
