#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "packet_admission.hpp"

namespace skein::dds {

/// How often something was refused, by the reason. The first of each but Stranger, the tenth, the
/// hundredth and so on is a warning in the log. Thread-safe.
class Refusals {
 public:
  /// `place` is the log's word for the source of its lines.
  explicit Refusals(std::string place) : place_(std::move(place)) {}

  /// A message from that address (IPv4, in host order), or its submessage of that `kind`; 0: the
  /// message as a whole.
  void count(Refusal why, unsigned char kind, std::uint32_t source);

  std::uint64_t counted(Refusal why) const {
    return counts_[static_cast<std::size_t>(why)].load(std::memory_order_relaxed);
  }

 private:
  static constexpr std::size_t kRefusals = static_cast<std::size_t>(Refusal::Locator) + 1;

  const std::string place_;
  std::array<std::atomic<std::uint64_t>, kRefusals> counts_{};
};

}  // namespace skein::dds
