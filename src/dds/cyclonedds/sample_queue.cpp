#include "sample_queue.hpp"

#include "../sample_format.hpp"
#include "identity.hpp"

namespace skein::dds::cyclonedds {
namespace {

constexpr std::uint32_t kDisposed = 1;  // of the RTPS status info

int32_t no_samples(dds_rhc*, bool, void**, dds_sample_info_t*, uint32_t, uint32_t,
                   dds_instance_handle_t, dds_readcond*) {
  return 0;
}
int32_t no_blobs(dds_rhc*, bool, ddsi_serdata**, dds_sample_info_t*, uint32_t, uint32_t, uint32_t,
                 uint32_t, dds_instance_handle_t) {
  return 0;
}

SampleQueue* to_queue(ddsi_rhc* cache) {
  return static_cast<SampleQueue*>(reinterpret_cast<dds_rhc*>(cache));
}

/// The writer's lifespan, from what Cyclone makes of it: when a sample that arrives now would
/// expire.
std::optional<std::chrono::nanoseconds> lifespan_of(const ddsi_writer_info& writer) {
  if (writer.lifespan_exp.v == DDS_NEVER) return std::nullopt;
  return std::chrono::nanoseconds(writer.lifespan_exp.v) -
         std::chrono::steady_clock::now().time_since_epoch();
}

/// Lends out a queued item's reference.
class Owner final : public SampleOwner {
 public:
  explicit Owner(BlobReference& blob) : blob_(blob) {}
  std::shared_ptr<const void> keep() override {
    return std::make_shared<BlobReference>(std::move(blob_));
  }

 private:
  BlobReference& blob_;
};

}  // namespace

const dds_rhc_ops& SampleQueue::operations() {
  static const dds_rhc_ops kOperations{
      .rhc_ops = {.store =
                      [](ddsi_rhc* cache, const ddsi_writer_info* writer, ddsi_serdata* data,
                         ddsi_tkmap_instance*) {
                        auto& blob = *static_cast<Blob*>(data);
                        to_queue(cache)->store(*writer, blob);
                        done_with(blob);
                        return true;
                      },
                  .unregister_wr = &SampleQueue::writer_gone,
                  .relinquish_ownership = [](ddsi_rhc*, std::uint64_t) {},
                  .set_qos = [](ddsi_rhc*, const dds_qos*) {},
                  .free = [](ddsi_rhc*) {}},  // the reader owns the queue
      .read = no_samples,
      .take = no_samples,
      .readcdr = no_blobs,
      .takecdr = no_blobs,
      .add_readcondition = [](dds_rhc*, dds_readcond*) { return false; },
      .remove_readcondition = [](dds_rhc*, dds_readcond*) {},
      .lock_samples = [](dds_rhc*) { return std::uint32_t{0}; },
      .associate =
          [](dds_rhc* cache, dds_reader* reader, const ddsi_sertype*, ddsi_tkmap*) {
            static_cast<SampleQueue*>(cache)->reader_ = reader;
            return dds_return_t{DDS_RETCODE_OK};
          },
  };
  return kOperations;
}

SampleQueue::SampleQueue(const Qos& qos, const ReaderListener& listener)
    : dds_rhc{},
      find_key_(listener.find_key),
      queue_(qos.history_depth, qos.max_waiting),
      gate_(qos) {
  common.ops = &operations();
  deadline_ =
      make_deadline_timer(qos, [this, missed = listener.on_deadline_missed](const KeyHash& key) {
        {
          std::lock_guard lock(mutex_);
          gate_.release(key);
        }
        if (missed) missed(key);
      });
}

void SampleQueue::store(const ddsi_writer_info& writer, Blob& blob) {
  const bool disposed = (blob.statusinfo & kDisposed) != 0;
  if (blob.kind != SDK_DATA && !disposed) {
    let_go(blob.key_hash, to_guid(writer.guid));
    return;
  }
  const bool sound = disposed || is_plain_cdr({blob.bytes(), blob.size});
  const auto key = sound ? key_of(blob) : std::nullopt;
  if (!key) {
    malformed_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  // A writer of the same participant hands over what it also sends.
  const bool as_sent = blob.outgoing && blob.length != blob.size;
  const bool stored =
      push({as_sent ? BlobReference::adopt(blob.copy_incoming()) : BlobReference(&blob), *key,
            to_guid(writer.guid), disposed ? InstanceState::Disposed : InstanceState::Alive},
           writer);
  if (stored) dds_reader_data_available_cb(reader_);
}

std::optional<KeyHash> SampleQueue::key_of(const Blob& blob) const {
  if (blob.has_key) return blob.key_hash;
  if (!find_key_ || blob.kind != SDK_DATA) return std::nullopt;
  return find_key_({blob.bytes(), blob.length});
}

bool SampleQueue::push(Item item, const ddsi_writer_info& writer) {
  const KeyHash key = item.key;
  const InstanceState state = item.state;
  const SourceTime now = wall_clock_time();
  const std::int64_t stamp = item.blob->timestamp.v;
  {
    std::lock_guard lock(mutex_);
    const auto expiry =
        gate_.admit(key, item.writer, {writer.ownership_strength, lifespan_of(writer)},
                    stamp == DDS_TIME_INVALID ? now : SourceTime(stamp), now);
    if (!expiry) return false;
    item.expiry = *expiry;
    if (queue_.push(key, std::move(item))) ++replaced_;
  }
  if (deadline_) state == InstanceState::Alive ? deadline_->heard(key) : deadline_->ended(key);
  return true;
}

/// A writer that is unmatched, or silent for its lease.
void SampleQueue::writer_gone(ddsi_rhc* cache, const ddsi_writer_info* writer) {
  auto* self = to_queue(cache);
  std::lock_guard lock(self->mutex_);
  self->gate_.release_all(to_guid(writer->guid));
}

/// A writer that unregisters an instance.
void SampleQueue::let_go(const KeyHash& key, const Guid& writer) {
  std::lock_guard lock(mutex_);
  gate_.release(key, writer);
}

std::optional<SampleQueue::Item> SampleQueue::pop() {
  std::lock_guard lock(mutex_);
  auto item = queue_.pop();
  while (item && item->expiry != SampleGate::kNever &&
         !gate_.fresh(item->expiry, wall_clock_time())) {
    item = queue_.pop();
  }
  return item;
}

bool SampleQueue::empty() {
  std::lock_guard lock(mutex_);
  return queue_.empty();
}

std::size_t SampleQueue::take(const std::function<void(const Sample&)>& consumer,
                              std::size_t limit) {
  std::size_t taken = 0;
  for (; taken < limit; ++taken) {
    std::optional<Item> item = pop();
    if (!item) break;
    const Blob& blob = *item->blob;
    std::span<const std::byte> cdr;
    if (item->state == InstanceState::Alive) cdr = {blob.bytes(), blob.length};
    Owner owner(item->blob);
    consumer({cdr, item->state, item->key, item->writer, &owner});
  }
  return taken;
}

}  // namespace skein::dds::cyclonedds
