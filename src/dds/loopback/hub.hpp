#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "dds/port/deadline_watch.hpp"
#include "dds/port/keyed_queue.hpp"
#include "dds/port/receive_queue.hpp"
#include "dds/port/topic_table.hpp"
#include "skein/detail/action.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/loopback.hpp"

namespace skein::dds::loopback {

class Hub;

struct Message {
  std::pmr::vector<std::byte> cdr;
  KeyHash key;
  InstanceState state;
  Guid writer;
  SourceTime written;
  std::uint64_t sequence;
};
using MessagePtr = std::shared_ptr<const Message>;

/// What one participant knows of another.
struct View {
  bool heard = false;            // its announcements arrive
  bool known = false;            // found, and its lease has not expired
  std::uint64_t generation = 0;  // outdates the timers of earlier silences
};

struct ParticipantCore {
  Guid guid;
  ParticipantOptions options;
  bool paused = false;
  bool killed = false;
  std::uint32_t last_entity = 0;
  std::map<Guid, View> views;
  TopicTable<int> topics;
};

struct EndpointCore {
  Guid guid;
  std::shared_ptr<ParticipantCore> participant;
  Topic topic;
  Qos qos;
  bool closed = false;
  std::set<Guid> refused;  // whose incompatibility has been told
};

/// Cores belong to one hub, which outlives them.
struct WriterCore final : EndpointCore {
  WriterCore(const Qos& qos, Hub& hub);
  WriterListener listener;
  std::uint64_t last_sequence = 0;
  KeyedQueue<MessagePtr> history;  // for late joiners, where the writer is transient-local
  const std::unique_ptr<DeadlineTimer> deadline;
};

struct ReaderCore final : EndpointCore {
  ReaderCore(const Topic& topic, const Qos& qos, Hub& hub);
  Reader* self = nullptr;
  ReaderListener listener;
  bool told = false;  // an on_data is on its way
  ReceiveQueue queue;
};

struct Unacknowledged {
  MessagePtr message;
  bool arrived = false;
  std::uint32_t in_flight = 0;
  std::uint32_t attempts = 0;
};

/// A matched writer and reader. Either side may know of the match without the other.
struct Match {
  std::shared_ptr<WriterCore> writer;
  std::shared_ptr<ReaderCore> reader;
  bool writer_side = false;
  bool reader_side = false;
  bool alive = true;
  bool repeating = false;  // a timer will repeat what was lost
  std::uint64_t delivered = 0;
  std::pmr::map<std::uint64_t, Unacknowledged> pending{&call_memory()};  // reliable only
};

/// The network's whole state behind one mutex. Listeners run outside it, from one queue, one at a
/// time.
class Hub : public std::enable_shared_from_this<Hub> {
 public:
  explicit Hub(Clock& clock);

  std::shared_ptr<ParticipantCore> join(const ParticipantOptions& options);
  void leave(const std::shared_ptr<ParticipantCore>& participant);
  void add(const std::shared_ptr<WriterCore>& writer);
  void add(const std::shared_ptr<ReaderCore>& reader);
  void remove(const std::shared_ptr<WriterCore>& writer);
  void remove(const std::shared_ptr<ReaderCore>& reader);

  void write(WriterCore& writer, std::span<const std::byte> cdr, const KeyHash& key,
             InstanceState state);
  bool wait_for_acknowledgments(const WriterCore& writer, std::chrono::milliseconds timeout);
  std::vector<Guid> matched_readers(const WriterCore& writer);
  std::vector<Guid> matched_writers(const ReaderCore& reader);

  void judge_transfers(std::function<Fate(const Transfer&)> judge);
  void isolate(const Guid& participant);
  void separate(const Guid& one, const Guid& other);
  void heal();
  void pause(const Guid& participant, bool paused);
  void kill(const Guid& participant);

  Clock& clock() const noexcept { return clock_; }
  /// Tells the endpoint soon, but not now: who destroys it waits for who calls this, perhaps with
  /// the hub locked.
  void deadline_missed(const Guid& endpoint, const KeyHash& key);

 private:
  using Lock = std::unique_lock<std::mutex>;
  using MatchId = std::pair<Guid, Guid>;  // writer, reader

  // Who hears and knows whom (loopback_lease_watch.cpp).
  bool connected(const ParticipantCore& one, const ParticipantCore& other) const;
  void update_presence();
  void hear(ParticipantCore& observer, const std::shared_ptr<ParticipantCore>& observed,
            View& view);
  void lose_sound(ParticipantCore& observer, ParticipantCore& observed, View& view);
  void expire_participant(const Guid& observer, const Guid& observed, std::uint64_t generation);
  void expire_liveliness(const MatchId& id, std::uint64_t generation);
  bool still_silent(const Guid& observer, const Guid& observed, std::uint64_t generation);
  void forget(ParticipantCore& observer, const Guid& observed);
  void tell_presence(ParticipantCore& observer, const Guid& observed, bool present);

  // Which endpoints are matched (matching.cpp).
  bool knows(const ParticipantCore& observer, const ParticipantCore& observed) const;
  void match(const std::shared_ptr<WriterCore>& writer, const std::shared_ptr<ReaderCore>& reader);
  void match_all(const ParticipantCore& one, const ParticipantCore& other);
  void match_writer_side(Match& match);
  void match_reader_side(Match& match);
  void unmatch_writer_side(Match& match);
  void unmatch_reader_side(Match& match);
  void drop_unused_links();
  void replay_history(Match& match);
  void tell_incompatible(const std::shared_ptr<WriterCore>& writer,
                         const std::shared_ptr<ReaderCore>& reader);

  // How samples travel (transfer.cpp).
  bool reliable(const Match& match) const { return match.reader->qos.reliable; }
  bool has_room(const WriterCore& writer) const;
  void wait_for_room(WriterCore& writer, Lock& lock);
  std::chrono::milliseconds patience(std::chrono::milliseconds wanted) const;
  void enqueue(Match& match, const MessagePtr& message);
  void send(Match& match, const MessagePtr& message, std::uint32_t attempt);
  void arrive(const MatchId& id, const MessagePtr& message);
  void deliver_in_order(Match& match);
  void accept(const Match& match, const MessagePtr& message);
  void repeat_later(Match& match);
  void repeat_lost(Match& match);
  void repeat_between(const ParticipantCore& one, const ParticipantCore& other);

  void post(const EndpointCore* target, Action callback);
  void run_callbacks(Lock& lock);
  void wait_until_idle(const void* target, Lock& lock);
  void after(Duration delay, std::function<void(Hub&)> action);

  Clock& clock_;
  const bool may_wait_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<Fate(const Transfer&)> judge_;
  std::uint32_t last_participant_ = 0;
  std::map<Guid, std::shared_ptr<ParticipantCore>> participants_;
  std::map<Guid, std::shared_ptr<WriterCore>> writers_;
  std::map<Guid, std::shared_ptr<ReaderCore>> readers_;
  std::map<MatchId, Match> matches_;
  std::set<Guid> isolated_;
  std::set<std::pair<Guid, Guid>> separated_;

  struct Callback {
    const void* target;
    Action run;
  };
  std::pmr::deque<Callback> callbacks_{&call_memory()};
  const void* running_ = nullptr;
  std::thread::id runner_;
  bool draining_ = false;
};

}  // namespace skein::dds::loopback
