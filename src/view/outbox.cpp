#include "view/outbox.hpp"

#include <algorithm>
#include <utility>

namespace skein::view {
namespace {

/// A small message takes this much beside its bytes.
constexpr std::size_t kOverhead = 128;

std::size_t weight(const Frame& frame) { return frame.size() + kOverhead; }

}  // namespace

bool Outbox::push(Frame message) {
  if (message_bytes_ + weight(message) > capacity_) return false;
  message_bytes_ += weight(message);
  messages_.push_back(std::move(message));
  return true;
}

void Outbox::push_sample(std::uint32_t subscription, Frame sample) {
  while (!samples_.empty() && sample_bytes_ + weight(sample) > capacity_) {
    sample_bytes_ -= weight(samples_.front().frame);
    samples_.pop_front();
    ++dropped_;
  }
  sample_bytes_ += weight(sample);
  samples_.push_back({subscription, std::move(sample)});
}

void Outbox::forget(std::uint32_t subscription) {
  std::erase_if(samples_, [&](const Sample& sample) {
    if (sample.subscription != subscription) return false;
    sample_bytes_ -= weight(sample.frame);
    return true;
  });
}

std::optional<Frame> Outbox::pop() {
  std::optional<Frame> next;
  if (!messages_.empty()) {
    next = std::move(messages_.front());
    messages_.pop_front();
    message_bytes_ -= weight(*next);
  } else if (!samples_.empty()) {
    next = std::move(samples_.front().frame);
    samples_.pop_front();
    sample_bytes_ -= weight(*next);
  }
  return next;
}

}  // namespace skein::view
