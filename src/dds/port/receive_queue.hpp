#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>

#include "dds/port/port.hpp"
#include "deadline_watch.hpp"
#include "keyed_queue.hpp"
#include "ownership.hpp"
#include "payload.hpp"
#include "skein/clock.hpp"

namespace skein::dds {

/// Time since any epoch that samples' source timestamps count from too.
using SourceTime = std::chrono::nanoseconds;

/// What a reader judges a writer's samples by, of the writer's QoS.
struct WriterOffer {
  std::int32_t strength = 0;
  std::optional<std::chrono::nanoseconds> lifespan{};
};

/// A vendor's sample, translated.
struct Arrival {
  /// Without padding. A disposal may have bytes: its key may have to be found in them.
  Payload payload{};
  InstanceState state = InstanceState::Alive;
  /// Nothing where the sample came without its hash.
  std::optional<KeyHash> key{};
  Guid writer{};
  /// The source timestamp; nothing where the peer left it out.
  std::optional<SourceTime> written{};
};

/// All that a reader does with a sample between its arrival and its user's take(), on every back
/// end: it drops what is malformed, has expired (DDS 1.4, 2.2.3.16) or is not the instance owner's
/// (2.2.3.9), lets the oldest give way where a limit is reached (2.2.3.18), and watches the
/// deadline (2.2.3.7). Back ends only translate what their vendors tell.
///
/// All members are thread-safe. It holds no lock while a consumer or one of the functions runs that
/// it was made with.
class ReceiveQueue {
 public:
  using FindKey = decltype(ReaderListener::find_key);
  using Missed = decltype(ReaderListener::on_deadline_missed);

  /// For samples of that topic. Source timestamps are of the hosts' clocks; `missed` is called on a
  /// thread of the process for all deadlines. Either function may be empty.
  ReceiveQueue(std::string topic, const Qos& qos, FindKey find_key, Missed missed);

  /// Source timestamps are of `clock`, which outlives the queue; `missed` is called on its thread.
  ReceiveQueue(std::string topic, const Qos& qos, FindKey find_key, Missed missed, Clock& clock);

  /// Waits until `missed` does not run; not from it. No thread may be in any other member.
  ~ReceiveQueue();

  /// A writer's offer, for vendors that tell it once: ahead of the writer's first sample.
  void writer_matched(const Guid& writer, const WriterOffer& offer);
  void writer_unmatched(const Guid& writer);
  /// The writer was silent for its lease; it may come back.
  void writer_not_alive(const Guid& writer);
  /// The writer lets go of one instance.
  void instance_unregistered(const KeyHash& key, const Guid& writer);

  /// Whether the sample waits to be taken now, or was dropped. This one goes by what
  /// writer_matched() told of the writer; without that no lifespan and no owner is looked at.
  bool store(Arrival arrival);
  /// The same, for vendors that tell the writer's offer with each sample.
  bool store(Arrival arrival, const WriterOffer& offer);

  /// As Reader::take().
  std::size_t take(const std::function<void(const Sample&)>& consumer, std::size_t limit);
  bool empty() const;
  ReceiveCounters counters() const;

 private:
  static constexpr SourceTime kNever = SourceTime::max();

  struct Item {
    Payload payload;
    KeyHash key;
    Guid writer;
    InstanceState state;
    SourceTime expiry;
  };

  ReceiveQueue(std::string topic, const Qos& qos, FindKey find_key, Missed missed, Clock* deadlines,
               std::function<SourceTime()> source_time);

  bool put(Arrival& arrival, const WriterOffer* offer);
  std::optional<KeyHash> key_of(const Arrival& arrival) const;
  std::optional<SourceTime> admit(const Arrival& arrival, const KeyHash& key,
                                  const WriterOffer& offer);
  bool drop_expired(SourceTime expiry);
  void note_expired_on_arrival(const Arrival& arrival, SourceTime lifespan);
  std::optional<Item> pop();

  const std::string topic_;
  const DataRepresentation representation_;
  const bool exclusive_;
  const FindKey find_key_;
  const std::function<SourceTime()> source_time_;
  mutable std::mutex mutex_;
  KeyedQueue<Item> waiting_;
  Ownership ownership_;
  /// Of the matched writers whose samples expire or contend.
  std::unordered_map<Guid, WriterOffer> offers_;
  ReceiveCounters counters_;
  /// How many samples in a row had expired when they came; until that was told.
  std::unordered_map<Guid, unsigned> expired_in_a_row_;
  bool told_of_expired_ = false;
  std::unique_ptr<DeadlineTimer> deadline_;  // goes first: it uses the rest
};

}  // namespace skein::dds
