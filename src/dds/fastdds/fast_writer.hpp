#pragma once

#include <atomic>
#include <condition_variable>
#include <unordered_map>

#include "dds/port/deadline_watch.hpp"
#include "fast_participant.hpp"

namespace skein::dds::fastdds {

/// A writer on Fast DDS's RTPS layer, with the history that our QoS promises: its content is
/// guarded by the RTPS writer's own mutex, under which Fast DDS also reports acknowledgments.
class FastWriter final : public Writer, private FastWriterListener {
 public:
  FastWriter(FastParticipant& participant, const Topic& topic, const Qos& qos,
             dds::WriterListener listener);
  ~FastWriter() override;

  void write(std::span<const std::byte> cdr, const KeyHash& key) override;
  void dispose(const KeyHash& key) override;
  bool wait_for_acknowledgments(std::chrono::milliseconds timeout) override;
  Guid guid() const override { return guid_; }
  std::vector<Guid> matched_readers() const override { return events_->peers(); }

 private:
  using Lock = std::unique_lock<RecursiveTimedMutex>;
  using Changes = std::vector<rtps::CacheChange_t*>;

  void on_matched(const Guid& reader, bool now) override;
  void on_reader(const Guid& reader, const AnnouncedReader* found) override;
  void on_acknowledged_by_all(rtps::CacheChange_t& change) override;

  /// What is not acknowledged is all that the history holds, or its number is limited.
  bool bounded() const noexcept {
    return qos_.reliable && !qos_.history_depth && (qos_.max_samples > 0 || !qos_.transient_local);
  }
  bool has_room();
  rtps::CacheChange_t* make_change(std::size_t size, rtps::ChangeKind_t kind, const KeyHash& key);
  void wait_for_room(Lock& lock);
  void announce_position();
  void ask_for_acknowledgment();
  void remember(rtps::CacheChange_t* change, const KeyHash& key);
  void send(rtps::CacheChange_t* change);
  void drop(rtps::CacheChange_t* change);
  void remove(rtps::CacheChange_t* change);
  void drop_acknowledged();
  void drop_all(const KeyHash& key);
  void drop_expired(const KeyHash& key);

  FastParticipant& participant_;
  const Topic topic_;
  const TopicUse<FastParticipant> use_;
  const Qos qos_;
  const std::shared_ptr<EndpointEvents> events_;
  std::optional<EndpointWatch> peers_;
  SentSamples history_;
  /// Of each instance, oldest first, where a depth bounds them or late joiners get them.
  std::unordered_map<Guid, Changes> instances_;
  /// What is acknowledged by all and could not be dropped at once.
  std::vector<rtps::SequenceNumber_t> acknowledged_;
  std::condition_variable_any room_;
  std::atomic<std::int64_t> last_sent_{0};
  /// What had been sent when the last reader was matched; -1 once a later sample was acknowledged
  /// by all.
  std::atomic<std::int64_t> new_reader_at_{-1};
  std::size_t held_bytes_ = 0;     // of samples in the history
  std::size_t unasked_bytes_ = 0;  // sent since readers were last asked for an acknowledgment
  rtps::RTPSWriter* writer_ = nullptr;
  Guid guid_;
  std::unique_ptr<DeadlineTimer> deadline_;
  std::unique_ptr<DeadlineTimer> lifespan_;  // of instances whose past late joiners would get
};

}  // namespace skein::dds::fastdds
