#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "skein/core/clock.hpp"
#include "skein/core/guid.hpp"
#include "skein/dds/port.hpp"

namespace skein::dds {

namespace loopback {
class Hub;
}

/// One sample on its way from one writer to one reader.
struct Transfer {
  Guid writer;
  Guid reader;
  std::string_view topic;
  /// The writer's samples are numbered from 1.
  std::uint64_t sequence = 0;
  /// 1 for the first transmission; repetitions of a reliable writer count on.
  std::uint32_t attempt = 1;
  /// Of the sample with its header; 0 for a disposal.
  std::size_t size = 0;
  InstanceState state = InstanceState::Alive;
};

/// What the network does with a transfer.
struct Fate {
  /// How often it arrives: 0 loses it, 2 duplicates it.
  std::uint32_t copies = 1;
  /// How much later it arrives. Later transfers may overtake it.
  Duration delay{};

  static Fate deliver() { return {}; }
  static Fate drop() { return {0, {}}; }
  static Fate late(Duration by) { return {1, by}; }
  static Fate twice() { return {2, {}}; }
};

/// A complete DDS network inside the process, for tests and for systems of one process. It behaves
/// as a real one does (matching, history, reliability, leases), and in ways that a real one can
/// only be hoped to: it loses, delays and cuts on demand, and it repeats a run exactly.
///
/// Time comes from the given clock alone, which must outlive the network and all that its vendor
/// made. With a ManualClock there is no thread: samples are delivered and listeners run inside the
/// call that causes them, delayed ones inside ManualClock::advance(). A listener's own calls into
/// the network take effect at once, and the callbacks they cause run after it. When several threads
/// use one network, a callback runs on whichever of them is at it; no two callbacks of a network
/// run at once.
///
/// GUIDs count up from the network's first participant: the same program sees the same GUIDs.
///
/// All members are thread-safe. Hooks that name an unknown participant do nothing.
class LoopbackNetwork {
 public:
  /// How soon a reliable writer repeats what was lost.
  static constexpr Duration kRepeatAfter = std::chrono::milliseconds(100);

  explicit LoopbackNetwork(Clock& clock);
  ~LoopbackNetwork();
  LoopbackNetwork(const LoopbackNetwork&) = delete;
  LoopbackNetwork& operator=(const LoopbackNetwork&) = delete;

  /// The way in. Its participants keep the network alive. A write that finds no room waits for it
  /// with a SystemClock; with any other clock it throws Overloaded at once, as nobody could make
  /// room.
  std::shared_ptr<Vendor> vendor();

  /// Asks `judge` about every transfer from now on; nothing means that all arrive. It is called
  /// with the network locked: it must not call back into it.
  ///
  /// A reliable reader still gets everything, in order and once: what is lost is repeated, what
  /// comes early is held back, what comes twice is dropped. A best-effort reader loses what comes
  /// late.
  void judge_transfers(std::function<Fate(const Transfer&)> judge);

  /// Cuts a participant off from all others: each side finds the other's leases expired.
  void isolate(const Guid& participant);

  /// Cuts two participants off from each other.
  void separate(const Guid& one, const Guid& other);

  /// Ends every isolate() and separate(); who has been forgotten is found anew, who has not goes on
  /// where he was, with nothing lost to reliable readers.
  void heal();

  /// Stops a participant as SIGSTOP does: the others' leases expire, its own do not; what is sent
  /// to it waits.
  void pause(const Guid& participant);
  void resume(const Guid& participant);

  /// Ends a participant as SIGKILL does: without a goodbye. Its objects stay usable, and reach
  /// nobody.
  void kill(const Guid& participant);

 private:
  std::shared_ptr<loopback::Hub> hub_;
};

}  // namespace skein::dds
