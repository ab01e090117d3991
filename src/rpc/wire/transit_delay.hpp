#pragma once

#include <optional>

#include "skein/clock.hpp"

namespace skein::rpc {

/// How much longer than usual one sender's messages were under way. The clocks of two hosts agree
/// on nothing, but from sending (by one) to arrival (by the other) passes a least time, which is
/// their offset and the way; what a message takes beyond it, it has waited: in the socket of a
/// process that was stopped, or to be sent again. Not thread-safe.
///
/// The least of the last two windows counts, so that a clock that jumped is learnt anew. A window
/// ends with a message, not with time: what arrives at once after a long stop is still compared
/// with what came before it. A least value grows by a thousandth of its age: two clocks that are
/// slewed as far as systems do it (500 ppm) drift apart no faster, and nothing is thought late
/// because of that.
class TransitDelay {
 public:
  static constexpr std::chrono::seconds kWindow{10};

  /// Notes a message; `sent` is by the sender's clock, since whenever that began. Never negative;
  /// zero for the first one.
  Duration excess(Duration sent, Instant arrived);

 private:
  struct Least {
    Duration difference;
    Instant at;

    Duration grown(Instant now) const { return difference + (now - at) / 1000; }
  };

  Instant begun_;  // the present window
  std::optional<Least> present_;
  std::optional<Least> last_;
};

}  // namespace skein::rpc
