#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/core/guid.hpp"

/// The port to DDS: participants, writers and readers of opaque CDR samples, with the QoS that
/// Skein uses and no vendor's name. Each implementation passes the conformance suite in
/// test/conformance.
namespace skein::dds {

/// An instance's identity: MD5 of the key's big-endian CDR, or that CDR itself, zero-padded, where
/// it never exceeds 16 bytes (RTPS 9.6.4.8). All zero for keyless topics.
using KeyHash = Guid;

struct Topic {
  /// Letters, digits, `_` and `/`; not beginning with a digit or `DCPS`.
  std::string name;
  std::string type_name;
  bool keyed = false;

  bool operator==(const Topic&) const = default;
};

/// What writers and readers must agree upon, and what they keep. XCDR1 always.
struct Qos {
  /// A reliable reader matches reliable writers only.
  bool reliable = true;
  /// Late joiners get the writer's history. A transient-local reader matches such writers only;
  /// whether a volatile reader of one is sent its past is not promised.
  bool transient_local = false;
  /// Samples kept per instance, disposals among them, by a writer and by a reader that does not
  /// take; nothing means all.
  std::optional<std::uint32_t> history_depth;
  /// With "all": how many samples may wait for acknowledgment before a reliable writer blocks; 0
  /// means no limit on their number (Cyclone DDS still bounds their bytes, at 4 MiB). Readers have
  /// no limit: a full one would stop a participant's reception, and its leases with it.
  std::uint32_t max_samples = 0;
  /// A reader's: how many samples may wait to be taken; one more takes the oldest one's place. 0:
  /// no limit.
  std::uint32_t max_waiting = 0;
  /// How long a write may wait for room before it throws Overloaded.
  std::chrono::milliseconds max_blocking{100};
  /// Automatic liveliness: a writer not heard of for so long is reported as not alive. Nothing:
  /// never. Give both sides the same: a reader's must not be shorter than a writer's.
  std::optional<std::chrono::milliseconds> liveliness_lease;
  /// A sample of each instance, once begun and not disposed, is promised by a writer and expected
  /// by a reader at least so often; each period without one is told on either side. Nothing: never.
  /// A reader's must not be shorter than a writer's.
  std::optional<std::chrono::milliseconds> deadline;
  /// A writer's: what is older than this, counted from the moment it was written, no reader is
  /// given. Between hosts it is only as good as their clocks agree. Nothing: samples never expire.
  std::optional<std::chrono::milliseconds> lifespan;
  /// Each instance is owned by the strongest living writer (of equals by the lesser GUID), and
  /// readers are given its samples only. It passes on when that one is unmatched, silent for its
  /// lease, or misses the reader's deadline. Both sides must agree.
  bool exclusive = false;
  /// A writer's, with `exclusive`; 0 or more.
  std::int32_t strength = 0;
  /// Only endpoints that share a partition match. Exact names, no wildcards (vendors differ); empty
  /// means the default partition, which is called "". Fixed at creation.
  std::vector<std::string> partitions;
};

enum class InstanceState { Alive, Disposed };

/// Who owns a sample's bytes; the back end's side of Sample::keep().
class SampleOwner {
 public:
  virtual ~SampleOwner() = default;
  virtual std::shared_ptr<const void> keep() = 0;
};

/// A received sample; `cdr` is valid only during the call that delivers it, or as long as kept.
struct Sample {
  /// With the 4-byte encapsulation header, as long as it was written (from foreign writers up to 3
  /// bytes longer: RTPS pads to 4); empty when disposed.
  std::span<const std::byte> cdr;
  InstanceState state = InstanceState::Alive;
  KeyHash key;
  Guid writer;
  SampleOwner* owner = nullptr;

  /// Keeps `cdr` valid for as long as the result lives, without a copy: for those who hand a sample
  /// to another thread. Once, and during the call only.
  std::shared_ptr<const void> keep() const { return owner->keep(); }
};

/// Why a writer and a reader of one topic, type and partition do not match: what is offered is less
/// than what is requested.
struct Incompatibility {
  Guid peer;
  /// `reliability`, `durability`, `deadline`, `liveliness` or `ownership`.
  std::string policy;
  /// The writer's and the reader's value.
  std::string offered;
  std::string requested;
  /// All of it, and what to do, in a sentence.
  std::string explanation;
};

class Reader;

/// Called on the vendor's threads; on_data also inside write(), where writer and reader are of one
/// participant (Cyclone DDS) or on loopback: hold no lock there that it takes. Listeners must
/// return soon (others take the participant for dead while one keeps its thread for long), must not
/// write, create or destroy entities, nor wait for who does. Taking samples is allowed. Calls of
/// one listener function do not overlap. Matches and data come in no promised order.
struct ReaderListener {
  /// There are new samples; take all: it is not called again for those that were left.
  std::function<void(Reader&)> on_data;
  /// A writer was matched (true) or is gone (false). One that comes back after its lease had
  /// expired may not know that it was gone: what it writes once may be lost, what it repeats
  /// arrives.
  std::function<void(const Guid& writer, bool matched)> on_matched;
  /// A matched writer's lease expired (false) or it was heard of again (true).
  std::function<void(const Guid& writer, bool alive)> on_liveliness;
  /// The key of a sample that came without its hash, as some foreign peers send them; nothing where
  /// it is malformed. Without this function all such samples are malformed.
  std::function<std::optional<KeyHash>(std::span<const std::byte> cdr)> find_key{};
  /// No sample of the instance came for the reader's deadline; again after each further one.
  std::function<void(const KeyHash& key)> on_deadline_missed{};
  /// A writer was found that cannot be matched; once for each.
  std::function<void(const Incompatibility&)> on_incompatible{};
};

struct WriterListener {
  std::function<void(const Guid& reader, bool matched)> on_matched;
  /// No sample of the instance was written for the writer's deadline; again after each further one.
  std::function<void(const KeyHash& key)> on_deadline_missed{};
  /// A reader was found that cannot be matched; once for each.
  std::function<void(const Incompatibility&)> on_incompatible{};
};

/// All members are thread-safe. Destroying it waits until no listener runs; not from a listener.
class Writer {
 public:
  virtual ~Writer() = default;

  /// Writes one sample; `cdr` starts with the encapsulation header, whose options must be zero.
  /// Throws InvalidArgument where that is missing, Overloaded where there was no room within
  /// max_blocking, Internal with the vendor's reason otherwise.
  virtual void write(std::span<const std::byte> cdr, const KeyHash& key = {}) = 0;

  /// Tells the readers that the instance has ended, also those that never knew it; late joiners are
  /// told that or nothing. Keyed topics only. Without it an instance outlives its writer.
  virtual void dispose(const KeyHash& key) = 0;

  /// Waits until every matched reliable reader has acknowledged everything, or `timeout`; false
  /// then.
  virtual bool wait_for_acknowledgments(std::chrono::milliseconds timeout) = 0;

  virtual Guid guid() const = 0;
  virtual std::vector<Guid> matched_readers() const = 0;
};

/// All members are thread-safe. Destroying it waits until no listener runs; not from a listener.
class Reader {
 public:
  virtual ~Reader() = default;

  /// Hands at most `limit` waiting samples to `consumer`, oldest first, and forgets them; returns
  /// how many. Samples that are no PLAIN_CDR little- or big-endian, or shorter than the header, are
  /// counted and dropped.
  virtual std::size_t take(const std::function<void(const Sample&)>& consumer,
                           std::size_t limit = SIZE_MAX) = 0;

  virtual Guid guid() const = 0;
  virtual std::vector<Guid> matched_writers() const = 0;

  /// Samples dropped because they were malformed, since creation.
  virtual std::uint64_t malformed() const = 0;

  /// Samples dropped because their lifespan was over, since creation.
  virtual std::uint64_t expired() const = 0;

  /// Samples whose place newer ones took before they were taken, since creation.
  virtual std::uint64_t replaced() const = 0;
};

/// Where a participant speaks.
struct Network {
  /// Interface names or addresses; empty means 127.0.0.1 alone, by unicast.
  std::vector<std::string> interfaces;
  /// On a named interface: find participants by multicast (data is unicast always).
  bool multicast_discovery = false;
  /// On a named interface without multicast: the hosts to ask.
  std::vector<std::string> peers;
  /// Greatest number of participants on each host that unicast discovery looks for.
  std::uint32_t max_participants = 120;
  /// Samples between two participants of this host that both want it go by the vendor's shared
  /// memory; discovery, and all else, does not. Fast DDS alone has it: others throw
  /// InvalidArgument. Who is killed leaves its segments in /dev/shm.
  bool shared_memory = false;
  /// From which IPv4 addresses packets are taken, this host's own ones among them always: addresses
  /// (`10.0.0.7`) and prefixes (`10.0.0.0/24`). Empty: from all. The sender's address is forged
  /// easily on a shared network. Shared memory is not looked at.
  std::vector<std::string> allowed_sources;
};

struct ParticipantOptions {
  /// 0 to 232.
  std::uint32_t domain = 0;
  std::string name;
  Network network;
  /// How long a participant that is not heard of stays known.
  std::chrono::milliseconds lease{1000};
  /// Called when another participant is found (true), or has left or its lease has expired (false);
  /// on a vendor's thread, with the GUID's participant() part.
  std::function<void(const Guid& participant, bool present)> on_participant;
};

/// Must outlive its writers and readers.
class Participant {
 public:
  virtual ~Participant() = default;

  /// Throw InvalidArgument for a topic name that is in use with another type, Internal otherwise.
  virtual std::unique_ptr<Writer> create_writer(const Topic& topic, const Qos& qos,
                                                WriterListener listener = {}) = 0;
  virtual std::unique_ptr<Reader> create_reader(const Topic& topic, const Qos& qos,
                                                ReaderListener listener = {}) = 0;

  virtual Guid guid() const = 0;
};

/// One DDS implementation.
class Vendor {
 public:
  virtual ~Vendor() = default;

  /// `fastdds`, `cyclonedds` or `loopback`.
  virtual std::string name() const = 0;

  /// Throws InvalidArgument for a domain out of range or an unknown interface; Unavailable where
  /// the ports are taken.
  virtual std::unique_ptr<Participant> create_participant(const ParticipantOptions& options) = 0;
};

/// Loads the vendor's module (once; it is never unloaded). Throws InvalidArgument with the known
/// names for an unknown one, Unavailable with the file looked for, the places and the package to
/// install where the module or the vendor's library is missing or of another version.
std::shared_ptr<Vendor> load_vendor(const std::string& name);

}  // namespace skein::dds
