#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "dds/allowed_sources.hpp"
#include "rtps_message.hpp"
#include "writer_ledger.hpp"

namespace skein::dds {

/// Stands before a vendor's parser, and passes on of what comes from the network only what is well
/// formed by the RTPS specification, of a kind that Skein's vendors use, and plausible against what
/// was announced. GUARD.md says which of the vendors' known holes that closes. Thread-safe.
class RtpsGuard {
 public:
  using Clock = WriterLedger::Clock;

  enum class Refusal {
    Source,      ///< The address is not among those allowed.
    Form,        ///< Not as the specification says; what follows in the message is dropped, too.
    Unused,      ///< A kind that nobody here uses.
    Leap,        ///< Sequence numbers far beyond what the writer announced.
    Fragment,    ///< A fragment that contradicts others of its sample, or is too small.
    Room,        ///< A sample in fragments that is too large, or one too many.
    Parameters,  ///< Discovery whose parameters do not lie within it.
    Lease,       ///< A participant that does not say when it counts as gone.
  };
  static constexpr std::size_t kRefusals = 8;

  /// `place` is where the log says that something was refused: the first of each kind, the tenth,
  /// the hundredth and so on.
  RtpsGuard(AllowedSources sources, std::string place)
      : sources_(std::move(sources)), place_(std::move(place)) {}

  /// What may be handed on of a message, and what that holds.
  struct Passed {
    std::size_t size = 0;             ///< In bytes from its beginning; 0: nothing.
    bool announces = false;           ///< A participant, or its end.
    bool acknowledges = false;        ///< By an ACKNACK.
    bool asserts_liveliness = false;  ///< Of a participant's writers, or may lead to such.
  };

  /// Looks at a message from that address (IPv4, in host order). What is refused within it becomes
  /// padding, or it is cut there.
  Passed pass(unsigned char* message, std::size_t size, std::uint32_t source,
              Clock::time_point now);

  /// How many messages or submessages were refused, since creation.
  std::uint64_t refused(Refusal kind) const {
    return counts_[static_cast<std::size_t>(kind)].load(std::memory_order_relaxed);
  }

 private:
  /// Nothing: good.
  using Verdict = std::optional<Refusal>;

  Verdict judge(const rtps_message::Submessage& submessage, const unsigned char* prefix,
                Clock::time_point now);
  Verdict judge_data(const rtps_message::Submessage& submessage, const unsigned char* prefix,
                     Clock::time_point now);
  Verdict judge_data_frag(const rtps_message::Submessage& submessage, const unsigned char* prefix,
                          Clock::time_point now);
  Verdict judge_heartbeat(const rtps_message::Submessage& submessage, const unsigned char* prefix,
                          Clock::time_point now);
  Verdict judge_gap(const rtps_message::Submessage& submessage, const unsigned char* prefix,
                    Clock::time_point now);
  bool announce(const unsigned char* prefix, const unsigned char* writer, std::int64_t number,
                Clock::time_point now);
  void count(Refusal why, unsigned char kind, std::uint32_t source);

  const AllowedSources sources_;
  const std::string place_;
  std::mutex mutex_;
  WriterLedger ledger_;
  std::array<std::atomic<std::uint64_t>, kRefusals> counts_{};
};

}  // namespace skein::dds
