#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "dds/port/allowed_sources.hpp"
#include "packet_admission.hpp"
#include "rtps_message.hpp"

namespace skein::dds {

/// Stands before a vendor's parser, and passes on of what comes from the network only what is well
/// formed by the RTPS specification, of a kind that Skein's vendors use, and admitted by what was
/// received of its sender before. GUARD.md says which of the vendors' known holes that closes.
/// Thread-safe.
class RtpsGuard {
 public:
  using Clock = Admission::Clock;

  using Refusal = dds::Refusal;
  static constexpr std::size_t kRefusals = static_cast<std::size_t>(Refusal::Locator) + 1;

  /// `place` is where the log says that something was refused: the first of each kind, the tenth,
  /// the hundredth and so on.
  RtpsGuard(Addresses addresses, std::string place, SkippedNumbers skipped)
      : addresses_(std::move(addresses)), place_(std::move(place)), admission_(skipped) {}

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

  /// Looks at a message that the vendor sends: what its readers acknowledge, they hold no longer.
  void sent(const unsigned char* message, std::size_t size);

  /// How many participants it knows.
  std::size_t participants() const;

  /// How many messages or submessages were refused, since creation.
  std::uint64_t refused(Refusal kind) const {
    return counts_[static_cast<std::size_t>(kind)].load(std::memory_order_relaxed);
  }

 private:
  using Origin = Admission::Origin;
  using Verdict = Admission::Verdict;

  /// DDS's own services.
  enum class Service;
  static Service service_of(const unsigned char* entity);

  Verdict judge(const rtps_message::Submessage& submessage, const Origin& origin);
  // Under the lock:
  Verdict judge_by_kind(const rtps_message::Submessage& submessage, const Origin& origin);
  Verdict judge_data(const rtps_message::Submessage& submessage, const Origin& origin);
  Verdict judge_discovery(const rtps_message::Submessage& submessage,
                          const rtps_message::Data& found, Service service, const Origin& origin);
  bool check_locators(const rtps_message::Data& found, const Origin& origin) const;
  Verdict judge_data_frag(const rtps_message::Submessage& submessage, const Origin& origin);
  Verdict judge_heartbeat(const rtps_message::Submessage& submessage, const Origin& origin);
  Verdict judge_gap(const rtps_message::Submessage& submessage, const Origin& origin);

  void count(Refusal why, unsigned char kind, std::uint32_t source);

  const Addresses addresses_;
  const std::string place_;
  mutable std::mutex mutex_;
  Admission admission_;
  std::array<std::atomic<std::uint64_t>, kRefusals> counts_{};
};

}  // namespace skein::dds
