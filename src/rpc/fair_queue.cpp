#include "skein/rpc/fair_queue.hpp"

#include <algorithm>

#include "skein/rpc/service.hpp"

namespace skein::rpc {
namespace {

template <class Lines>
auto find_line(Lines& lines, const Guid& connection) {
  return std::find_if(lines.begin(), lines.end(),
                      [&](const auto& line) { return line.connection == connection; });
}

}  // namespace

FairQueue::~FairQueue() {
  while (pop()) {
  }
}

bool FairQueue::has_room(const Guid& connection) const noexcept {
  const auto line = find_line(lines_, connection);
  return (line == lines_.end() ? 0 : line->size) < capacity_ - std::min(capacity_, size_);
}

void FairQueue::push(std::shared_ptr<Invocation> invocation) {
  Invocation* const last = invocation.get();
  const auto line = find_line(lines_, last->connection);
  if (line == lines_.end()) {
    // Behind all others: just before the one whose turn it is.
    const auto position = lines_.begin() + static_cast<std::ptrdiff_t>(turn_);
    lines_.insert(position, Line{last->connection, std::move(invocation), last, 1});
    if (lines_.size() > 1) turn_ = (turn_ + 1) % lines_.size();
  } else {
    line->last->next = std::move(invocation);
    line->last = last;
    ++line->size;
  }
  ++size_;
}

std::shared_ptr<Invocation> FairQueue::pop() noexcept {
  if (lines_.empty()) return nullptr;
  Line& line = lines_[turn_];
  auto invocation = std::move(line.first);
  line.first = std::move(invocation->next);
  --line.size;
  --size_;
  if (line.first) {
    ++turn_;
  } else {
    lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(turn_));
  }
  if (turn_ >= lines_.size()) turn_ = 0;
  return invocation;
}

}  // namespace skein::rpc
