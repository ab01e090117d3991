#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "dds/port/allowed_sources.hpp"
#include "packet_admission.hpp"
#include "refusals.hpp"
#include "rtps_message.hpp"
#include "submessage_judge.hpp"

namespace skein::dds {

/// Stands before a vendor's parser, and passes on of what comes from the network only what is well
/// formed by the RTPS specification, of a kind that Skein's vendors use, and admitted by what was
/// received of its sender before. GUARD.md says which of the vendors' known holes that closes.
/// Thread-safe.
class RtpsGuard {
 public:
  using Clock = Admission::Clock;

  /// `place` is the log's word for the source of lines about refusals.
  RtpsGuard(Addresses addresses, std::string place, SkippedNumbers skipped)
      : addresses_(std::move(addresses)), refusals_(std::move(place)), admission_(skipped) {}

  /// What may be handed on of a message, and what that holds.
  struct Passed {
    std::size_t size = 0;       ///< In bytes from its beginning; 0: nothing.
    bool announces = false;     ///< A participant, or its end.
    bool acknowledges = false;  ///< By an ACKNACK.
  };

  /// Looks at a message from that address (IPv4, in host order). What is refused within it becomes
  /// padding, or it is cut there.
  Passed pass(unsigned char* message, std::size_t size, std::uint32_t source,
              Clock::time_point now);

  /// The vendor has found a participant, or has removed it.
  void found(const Guid& participant);
  void removed(const Guid& participant);
  /// It has found a participant's endpoint, or has removed it.
  void endpoint_found(const Guid& endpoint);
  void endpoint_removed(const Guid& endpoint);

  /// A reader of this participant has been matched with a remote writer, or is no longer. `reader`
  /// is its entity id, or what else tells it from others.
  void matched(const Guid& writer, std::uint32_t reader, bool now);
  void reader_gone(std::uint32_t reader);

  /// Samples in fragments of which nothing came for some seconds. Each is to be dropped from the
  /// vendor's memory, and `dropped` to be told then.
  std::vector<Admission::Incomplete> give_up(Clock::time_point now);
  void dropped(const Admission::Incomplete& sample);

  /// Looks at each submessage of a message that the vendor sends: what its readers acknowledge,
  /// they hold no longer. `receiver`, at first of nobody, is whom the message goes to so far.
  void sent(const rtps_message::Submessage& submessage, Guid& receiver);

  /// How many participants it knows.
  std::size_t participants() const;

  /// How many messages or submessages were refused, since creation.
  std::uint64_t refused(Refusal kind) const { return refusals_.counted(kind); }

 private:
  using Verdict = Admission::Verdict;

  Verdict judge(const rtps_message::Submessage& submessage, const Admission::Origin& origin);

  const Addresses addresses_;
  Refusals refusals_;
  mutable std::mutex mutex_;
  Admission admission_;                            // under mutex_
  SubmessageJudge judge_{addresses_, admission_};  // under mutex_
};

}  // namespace skein::dds
