#pragma once

#include <catch2/catch.hpp>

#include "wire.hpp"

namespace skein::dds::conformance {

/// A writer and a reader of one topic that know of each other.
struct Talk : Wire {
  Talk(const Topic& topic, const Qos& qos)
      : outbox(*writing, topic, qos), inbox(*reading, topic, qos) {
    REQUIRE(matched(outbox, inbox));
  }
  Outbox outbox;
  Inbox inbox;
};

struct Matched : Talk {
  Matched() : Talk(keyless(), keep_all()) {}
};
struct MatchedKeyed : Talk {
  MatchedKeyed() : Talk(keyed(), keep_all()) {}
};
struct MatchedState : Talk {
  MatchedState() : Talk(keyed(), last_state()) {}
};
/// Samples arrive, too.
struct Connected : Matched {
  Connected() { REQUIRE(connected(outbox, inbox)); }
};

}  // namespace skein::dds::conformance
