#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "skein/clock.hpp"
#include "skein/detail/qos.hpp"
#include "skein/guid.hpp"
#include "skein/vendor.hpp"

namespace skein::dds {

namespace loopback {
class Hub;
}

/// One sample on its way from a writer to a reader.
struct Transfer {
  Guid writer;
  Guid reader;
  std::string_view topic;
  /// The number of the writer's sample, from 1.
  std::uint64_t sequence = 0;
  /// 1 for the first transmission; retransmissions of a reliable writer count up.
  std::uint32_t attempt = 1;
  /// Bytes of the sample with its header; 0 for a disposal.
  std::size_t size = 0;
  InstanceState state = InstanceState::Alive;
};

/// What the network does with a transfer.
struct Fate {
  /// How often it arrives: 0 loses it, 2 duplicates it.
  std::uint32_t copies = 1;
  /// Delay of its arrival. Later transfers may overtake it.
  Duration delay{};

  static Fate deliver() { return {}; }
  static Fate drop() { return {0, {}}; }
  static Fate late(Duration by) { return {1, by}; }
  static Fate twice() { return {2, {}}; }
};

/// A complete DDS network inside the process, for tests and for systems of one process. It behaves
/// like a real one (matching, history, reliability, leases). It also loses, delays and cuts on
/// demand, and repeats a run exactly.
///
/// Time comes from the given clock alone, which must outlive the network and everything that its
/// vendor made. With a ManualClock there is no thread: samples are delivered and listeners run
/// inside the call that causes them, delayed ones inside ManualClock::advance(). Calls that a
/// listener makes into the network take effect at once; the callbacks that they cause run after it.
/// If several threads use one network, a callback may run on any of them; no two callbacks of a
/// network run at once.
///
/// GUIDs count up from the network's first participant: the same program sees the same GUIDs.
///
/// All members are thread-safe. pause(), resume() and kill() ignore unknown participants; isolate()
/// and separate() also apply to one that joins later.
class LoopbackNetwork {
 public:
  /// Time after which a reliable writer retransmits a lost sample.
  static constexpr Duration kRepeatAfter = std::chrono::milliseconds(100);

  explicit LoopbackNetwork(Clock& clock);
  ~LoopbackNetwork();
  LoopbackNetwork(const LoopbackNetwork&) = delete;
  LoopbackNetwork& operator=(const LoopbackNetwork&) = delete;

  /// The vendor of this network. Its participants keep the network alive. A write that finds no
  /// room waits for room if the clock is a SystemClock. With any other clock, and in a listener, it
  /// throws Overloaded at once, since nobody could make room meanwhile.
  std::shared_ptr<Vendor> vendor();

  /// Asks `judge` about every transfer from now on; nullptr: all arrive. It is called with the
  /// network locked, so it must not call the network.
  ///
  /// A reliable reader still gets every sample once and in order: lost samples are retransmitted,
  /// early ones are held back, duplicates dropped. A best-effort reader loses samples that were
  /// overtaken.
  void judge_transfers(std::function<Fate(const Transfer&)> judge);

  /// Cuts a participant off from all others: each side sees the other's lease expire.
  void isolate(const Guid& participant);

  /// Cuts two participants off from each other.
  void separate(const Guid& one, const Guid& other);

  /// Ends all isolate() and separate(). A participant that others have forgotten is discovered
  /// again. If they have not, communication continues, and reliable readers lose nothing.
  void heal();

  /// Stops a participant as SIGSTOP does. The others see its lease expire; it does not see theirs
  /// expire. Reliable samples from or for it wait as long as its lease lasts; best-effort ones are
  /// lost.
  void pause(const Guid& participant);
  void resume(const Guid& participant);

  /// Ends a participant as SIGKILL does, without a goodbye. Its objects stay usable, but reach
  /// nobody.
  void kill(const Guid& participant);

 private:
  std::shared_ptr<loopback::Hub> hub_;
};

}  // namespace skein::dds
