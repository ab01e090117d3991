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

#include "skein/clock.hpp"
#include "skein/detail/qos.hpp"
#include "skein/guid.hpp"
#include "skein/vendor.hpp"

/// The port to DDS: participants, writers and readers of opaque CDR samples, with the QoS that
/// Skein uses and no vendor's name. Each implementation passes the conformance suite in
/// test/dds.
namespace skein::dds {

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

/// Why a writer and a reader of one topic and partition do not match: their types differ, or what
/// is offered is less than what is requested.
struct Incompatibility {
  Guid peer;
  /// `reliability`, `durability`, `deadline`, `liveliness`, `ownership`, `data representation` or
  /// `type`.
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

/// Samples that a reader dropped, by the reason.
struct ReceiveCounters {
  /// No PLAIN_CDR, shorter than its header, or without a key.
  std::uint64_t malformed = 0;
  /// Their lifespan was over when they came, or when they were to be taken.
  std::uint64_t expired = 0;
  /// Newer ones took their place before they were taken.
  std::uint64_t replaced = 0;
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

  /// Since creation.
  virtual ReceiveCounters counters() const = 0;
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

}  // namespace skein::dds
