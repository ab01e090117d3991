#pragma once

#include <atomic>
#include <optional>
#include <span>

#include "call_port/call_port.hpp"
#include "dds/port/largest_sample.hpp"
#include "link_state.hpp"
#include "loans.hpp"
#include "ring.hpp"

namespace skein::same_host {

/// The half of a link that receives. Messages are for one thread at a time; unfinished() and, of
/// ring(), all but take() are thread-safe.
class LinkReader {
 public:
  /// `state` is that of the link to which this half belongs.
  explicit LinkReader(LinkState& state)
      : state_(state), ring_(state.incoming(), dds::kLargestSample) {}

  /// The next whole message, which is valid until release(), after which the next one may be asked
  /// for; or nothing. `spare` is memory that links of one thread lend each other: only a message
  /// that has not come to its end keeps some. Throws BrokenRing; the link has ended then.
  std::optional<std::span<const std::byte>> receive(Bytes& spare);
  void release(Bytes& spare);
  /// The value that the message has left out, valid as long as the message; or null.
  const calls::LentValue* lent_value() const noexcept { return lent_ ? &*lent_ : nullptr; }
  /// Octets that have come of a message without its end.
  std::size_t unfinished() const noexcept { return unfinished_; }

  RingReader& ring() noexcept { return ring_; }

 private:
  std::optional<calls::LentValue> borrow();

  LinkState& state_;
  RingReader ring_;
  Bytes message_;
  std::optional<Borrower> borrower_;
  std::optional<calls::LentValue> lent_;
  std::atomic<std::size_t> unfinished_{0};
};

}  // namespace skein::same_host
