#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "allowance.hpp"
#include "dds/port/largest_sample.hpp"
#include "rtps_message.hpp"
#include "skein/guid.hpp"

namespace skein::dds {

/// Why something that was received is not handed on.
enum class Refusal {
  Source,      ///< The address is not among those allowed.
  Form,        ///< Not as the specification says; what follows in the message is dropped, too.
  Unused,      ///< A kind that nobody here uses.
  Stranger,    ///< Its participant has not announced itself.
  Unmatched,   ///< A sample in fragments of a writer that no reader here is matched with.
  Leap,        ///< Sequence numbers far beyond what was received of the writer.
  Fragment,    ///< A fragment that contradicts others of its sample, or is too small.
  Room,        ///< A sample in fragments that is too large, or one too many.
  Parameters,  ///< Discovery whose parameters do not lie within it.
  Lease,       ///< A participant that does not say when it counts as gone.
  Foreign,     ///< Discovery of another participant, or of its endpoints.
  Crowd,       ///< One participant too many, of its address or in all, or too soon.
  Announced,   ///< A participant or an endpoint whose announcement takes more than is left.
  Locator,     ///< A participant that can only be reached where it may not send others.
};

/// What a vendor's reader does with numbers that its writer skips: it looks at each of them (Fast
/// DDS), or notes where they begin and end (Cyclone DDS).
enum class SkippedNumbers { Counted, Noted };

/// What may be handed on of what remote participants send, by what was received of each before:
/// every participant, and every address that participants send from, has a budget. Nothing is kept
/// of who has not announced itself. Pure: time is an argument. Not thread-safe.
class Admission {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  /// A writer that is new here, as to a late joiner, may have written so many samples.
  static constexpr std::int64_t kMaxBefore = std::int64_t{1} << 32;
  /// Afterwards it may be ahead of what was heard of it by this, and by one for each microsecond
  /// since, up to the second number.
  static constexpr std::int64_t kLeap = std::int64_t{1} << 20;
  static constexpr std::int64_t kGreatestLeap = std::int64_t{1} << 30;
  /// Of a participant, of whom no reader here need read, and of all; no more than are left.
  static constexpr std::size_t kMaxWriters = 4096;
  static constexpr std::size_t kMaxWritersInAll = 16384;

  static constexpr std::size_t kMaxParticipants = 1024;
  /// Of them at an address: twice as many as find ports there. And how soon they may come.
  static constexpr std::size_t kMaxParticipantsOfSource = 256;
  static constexpr Allowance::Rate kNewcomersOfSource{128, 16};

  /// Octets that a vendor keeps of what is announced: so much for each participant and endpoint,
  /// and the announcement itself. Of one participant, of all at an address, and in all. A
  /// participant with 1,000 services of eight clients each announces 9,000 endpoints: 25 MiB.
  static constexpr std::size_t kKeptOfEach = 2560;
  static constexpr std::size_t kMaxAnnounced = 32 << 20;
  static constexpr std::size_t kMaxAnnouncedAtSource = 128 << 20;
  static constexpr std::size_t kMaxAnnouncedInAll = 256 << 20;
  /// Announcements of one writer that a vendor which counts numbers may hold behind one that it
  /// lacks: it looks through all of them for each that comes. They count as announced until then.
  static constexpr std::int64_t kMaxWaiting = 4096;

  /// Skipped numbers that a reader counts, 0.22 us each: of a participant, and beyond that of all
  /// participants at an address, and of all addresses.
  static constexpr Allowance::Rate kCountedOfParticipant{1 << 14, 1 << 12};
  static constexpr Allowance::Rate kCountedOfSource{1 << 18, 1 << 19};
  static constexpr Allowance::Rate kCountedInAll{1 << 19, 1 << 20};
  /// A GAP may skip so many numbers behind those that were acknowledged; and, as a reader keeps
  /// each number behind one that it lacks, must end so near behind them where it lacks one.
  static constexpr std::int64_t kLongestGap = 1 << 16;
  static constexpr std::int64_t kGapAhead = 1 << 12;

  /// Of one sample that comes in fragments, of all such that are not complete, and how many. A
  /// participant may have no more of both than are left for others.
  static constexpr std::uint32_t kLargestSample = dds::kLargestSample;
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;
  static constexpr std::size_t kMaxSamples = 4096;
  /// Fast DDS takes memory for all of a sample when its first fragment comes. So who has sent so
  /// little in fragments may not begin a sample that is more than so many times as large, beyond
  /// what all participants at an address may begin at the start.
  static constexpr std::int64_t kAhead = 16;
  static constexpr Allowance::Rate kBegunAtSource{32 << 20, 2 << 20};
  /// A sample of which nothing came for so long is given up.
  static constexpr std::chrono::seconds kPatience{5};
  /// RTPS asks for 1024. Fast DDS keeps a list in the fragments that are missing, which smaller
  /// ones than 8 bytes would break.
  static constexpr std::uint16_t kSmallestFragment = 256;

  /// Nothing: it may be handed on.
  using Verdict = std::optional<Refusal>;

  /// Who sent a message, from where (IPv4, in host order), and when it came.
  struct Origin {
    Guid participant;
    std::uint32_t source = 0;
    Time now;
  };

  explicit Admission(SkippedNumbers skipped) : skipped_(skipped) {}

  /// A participant announces itself.
  Verdict announced(const Origin& origin);
  /// Whether the sender has announced itself from that address.
  bool has_announced_from(const Guid& participant, std::uint32_t source) const;
  /// The vendor has found a participant, or has removed it. One that it never finds is forgotten
  /// when it has been silent for kUnconfirmed.
  void found(const Guid& participant);
  void removed(const Guid& participant);
  static constexpr std::chrono::seconds kUnconfirmed{10};

  /// A participant that is known announces itself or one of its endpoints, in so many octets.
  Verdict announced(const Origin& origin, std::uint32_t entity, std::size_t size);
  /// The announcement has that number, of a reliable writer: whether it may wait for those before.
  Verdict may_wait(const Origin& origin, std::uint32_t writer, std::int64_t number);
  /// The vendor has found an endpoint, or has removed it: only then is its room free again, as a
  /// withdrawal may be one that the vendor does not take.
  void endpoint_found(const Guid& participant, std::uint32_t entity);
  void endpoint_removed(const Guid& participant, std::uint32_t entity);

  std::size_t participants() const { return participants_.size(); }

  /// Whether the sender has announced itself; notes that it was heard of.
  bool knows(const Origin& origin);

  /// A sender that is known says that its writer's sample `number` exists, or existed.
  Verdict sample(const Origin& origin, std::uint32_t writer, std::int64_t number);

  /// It says that its writer has the samples from `first` to `last`, and none before them. Where
  /// more numbers are skipped than may be, they are changed into what is as true: that it has none
  /// before an earlier one.
  Verdict heartbeat(const Origin& origin, std::uint32_t writer, std::int64_t& first,
                    std::int64_t& last);

  /// It says that samples from `start` to `last` do not exist. Where more are skipped than may be,
  /// `last` is an earlier one; the reader asks for the rest.
  Verdict gap(const Origin& origin, std::uint32_t writer, std::int64_t start, std::int64_t& last);

  /// A reader of this participant has been matched with a remote writer, or is no longer.
  void matched(const Guid& participant, std::uint32_t writer, std::uint32_t reader, bool now);
  /// A reader of this participant has gone.
  void reader_gone(std::uint32_t reader);

  /// A reader of this participant has acknowledged what a writer wrote up to `number`: it holds
  /// nothing up to there, and has no need to count it.
  void acknowledged(const Guid& participant, std::uint32_t writer, std::uint32_t reader,
                    std::int64_t number);

  /// Fragments of the sample `number` came. All must agree on its size and theirs.
  Verdict fragments(const Origin& origin, std::uint32_t writer, std::int64_t number,
                    const rtps_message::Fragments& fragments);

  /// A sample that is not complete.
  struct Incomplete {
    Guid participant;
    std::uint32_t writer;
    std::int64_t number;
  };
  /// Samples to be given up. Their fragments are refused until the vendor has dropped them.
  std::vector<Incomplete> give_up(Time now);
  /// The vendor holds nothing of it any more: it may begin anew.
  void dropped(const Incomplete& sample);

 private:
  struct Reader {
    std::uint32_t entity;
    std::int64_t acknowledged;
  };
  struct Sample {
    std::uint32_t size;
    std::uint16_t fragment_size;
    std::uint32_t missing;
    std::vector<bool> received;
    Time last;
    bool open = true;       // it counts
    bool given_up = false;  // until the vendor has dropped it
  };
  struct Writer {
    std::int64_t highest = 0;
    std::int64_t allowance = kLeap;
    Time advanced{};
    std::int64_t counted = 0;  // skipped numbers up to here have been paid for
    std::int64_t waiting = 0;  // announcements, no fewer than the vendor holds
    bool heard = false;
    std::vector<Reader> readers{};             // here
    std::map<std::int64_t, Sample> samples{};  // those that came in fragments; the latest ones

    std::int64_t held_up_to() const;
  };
  struct Source {
    Allowance numbers{kCountedOfSource};
    Allowance begun{kBegunAtSource};
    Allowance newcomers{kNewcomersOfSource};
    std::size_t participants = 0;
    std::size_t announced = 0;  // octets, as of each participant
  };
  struct Participant {
    bool found = false;   // by the vendor
    bool placed = false;  // it has announced itself, from `source`
    std::uint32_t source = 0;
    std::vector<std::uint32_t> sources{};  // from which it has announced itself of late
    Time heard{};
    Allowance numbers{kCountedOfParticipant};
    std::int64_t earned = 0;  // bytes that it may begin, by what was received of it
    std::uint64_t open_bytes = 0;
    std::size_t open_samples = 0;
    Time closed_stale{};
    std::unordered_map<std::uint32_t, Writer> writers{};
    std::unordered_map<std::uint32_t, std::size_t> announced{};  // octets of each entity
    std::size_t announced_size = 0;                              // of all of them
  };
  Participant* find(const Guid& participant);
  Writer* find(const Guid& participant, std::uint32_t writer);
  Source& source_at(std::uint32_t address);
  void place(Participant& participant, std::uint32_t source);
  void unplace(Participant& participant);
  bool has_room(const Participant& participant, std::size_t before, std::size_t now) const;
  void change_announced(Participant& participant, std::size_t before, std::size_t now);
  void change_waiting(Participant& participant, Writer& writer, std::int64_t now);
  void forget(std::unordered_map<Guid, Participant>::iterator participant);
  void forget_unconfirmed(Time now);
  Verdict announce(Participant& participant, std::uint32_t writer, std::int64_t number, Time now,
                   Writer*& found);
  std::int64_t let_skip(Participant& participant, Writer& writer, std::int64_t up_to, Time now);
  bool begin(Participant& participant, std::uint32_t size, Time now);
  void close(Participant& participant, Sample& sample);
  void close_stale(Participant& participant, Time now);

  const SkippedNumbers skipped_;
  std::unordered_map<Guid, Participant> participants_;
  std::unordered_map<std::uint32_t, Source> sources_;
  Allowance numbers_{kCountedInAll};
  std::size_t writers_ = 0;    // of all participants
  std::size_t announced_ = 0;  // octets, of all participants
  std::uint64_t open_bytes_ = 0;
  std::size_t open_samples_ = 0;
};

}  // namespace skein::dds
