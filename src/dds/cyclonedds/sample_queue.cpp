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
      .rhc_ops = {.store = &SampleQueue::store,
                  .unregister_wr = [](ddsi_rhc*, const ddsi_writer_info*) {},
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

SampleQueue::SampleQueue(std::optional<std::uint32_t> depth) : dds_rhc{}, queue_(depth) {
  common.ops = &operations();
}

bool SampleQueue::store(ddsi_rhc* cache, const ddsi_writer_info* writer, ddsi_serdata* data,
                        ddsi_tkmap_instance*) {
  auto* self = static_cast<SampleQueue*>(reinterpret_cast<dds_rhc*>(cache));
  auto* blob = static_cast<Blob*>(data);
  const bool disposed = (data->statusinfo & kDisposed) != 0;
  if (data->kind != SDK_DATA && !disposed) return true;  // a writer lets go of an instance
  const bool sound = disposed || is_plain_cdr({blob->bytes(), blob->size});
  if (!sound || !blob->has_key) {
    self->malformed_.fetch_add(1, std::memory_order_relaxed);
    return true;
  }
  // A writer of the same participant hands over what it also sends.
  const bool as_sent = blob->outgoing && blob->length != blob->size;
  self->push({as_sent ? BlobReference::adopt(blob->copy_incoming()) : BlobReference(blob),
              to_guid(writer->guid), disposed ? InstanceState::Disposed : InstanceState::Alive});
  dds_reader_data_available_cb(self->reader_);
  return true;
}

void SampleQueue::push(Item item) {
  const KeyHash key = item.blob->key_hash;
  std::lock_guard lock(mutex_);
  queue_.push(key, std::move(item));
}

std::optional<SampleQueue::Item> SampleQueue::pop() {
  std::lock_guard lock(mutex_);
  return queue_.pop();
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
    const KeyHash key = blob.key_hash;
    Owner owner(item->blob);
    consumer({cdr, item->state, key, item->writer, &owner});
  }
  return taken;
}

}  // namespace skein::dds::cyclonedds
