#include "history_cache.hpp"

#include <chrono>
#include <optional>
#include <span>
#include <utility>

#include "cyclone_identity.hpp"

namespace skein::dds::cyclonedds {
namespace {

constexpr std::uint32_t kDisposed = 1;  // of the RTPS status info

int32_t take_nothing(dds_rhc*, bool, void**, dds_sample_info_t*, uint32_t, uint32_t,
                     dds_instance_handle_t, dds_readcond*) {
  return 0;
}
int32_t no_blobs(dds_rhc*, bool, ddsi_serdata**, dds_sample_info_t*, uint32_t, uint32_t, uint32_t,
                 uint32_t, dds_instance_handle_t) {
  return 0;
}

HistoryCache* to_cache(ddsi_rhc* cache) {
  return static_cast<HistoryCache*>(reinterpret_cast<dds_rhc*>(cache));
}

/// The writer's lifespan, from what Cyclone makes of it: when a sample that arrives now would
/// expire.
std::optional<std::chrono::nanoseconds> lifespan_of(const ddsi_writer_info& writer) {
  if (writer.lifespan_exp.v == DDS_NEVER) return std::nullopt;
  return std::chrono::nanoseconds(writer.lifespan_exp.v) -
         std::chrono::steady_clock::now().time_since_epoch();
}

/// The sample's bytes, where it is more than a key.
Payload payload_of(Blob& blob) {
  if (blob.kind != SDK_DATA) return {};
  // A writer of the same participant hands over what it also sends.
  const bool as_sent = blob.outgoing && blob.length != blob.size;
  BlobReference reference =
      as_sent ? BlobReference::adopt(blob.copy_incoming()) : BlobReference(&blob);
  const std::span<const std::byte> cdr(reference->bytes(), reference->length);
  return {cdr, std::move(reference)};
}

}  // namespace

const dds_rhc_ops& HistoryCache::operations() {
  static const dds_rhc_ops kOperations{
      .rhc_ops = {.store =
                      [](ddsi_rhc* cache, const ddsi_writer_info* writer, ddsi_serdata* data,
                         ddsi_tkmap_instance*) {
                        auto& blob = *static_cast<Blob*>(data);
                        to_cache(cache)->store(*writer, blob);
                        done_with(blob);
                        return true;
                      },
                  // A writer that is unmatched, or silent for its lease.
                  .unregister_wr =
                      [](ddsi_rhc* cache, const ddsi_writer_info* writer) {
                        to_cache(cache)->queue_.writer_not_alive(to_guid(writer->guid));
                      },
                  .relinquish_ownership = [](ddsi_rhc*, std::uint64_t) {},
                  .set_qos = [](ddsi_rhc*, const dds_qos*) {},
                  .free = [](ddsi_rhc*) {}},  // the reader owns the cache
      .read = take_nothing,
      .take = take_nothing,
      .readcdr = no_blobs,
      .takecdr = no_blobs,
      .add_readcondition = [](dds_rhc*, dds_readcond*) { return false; },
      .remove_readcondition = [](dds_rhc*, dds_readcond*) {},
      .lock_samples = [](dds_rhc*) { return std::uint32_t{0}; },
      .associate =
          [](dds_rhc* cache, dds_reader* reader, const ddsi_sertype*, ddsi_tkmap*) {
            static_cast<HistoryCache*>(cache)->reader_ = reader;
            return dds_return_t{DDS_RETCODE_OK};
          },
  };
  return kOperations;
}

HistoryCache::HistoryCache(ReceiveQueue& queue, const std::optional<EndpointWatch>& peers)
    : dds_rhc{}, queue_(queue), peers_(peers) {
  common.ops = &operations();
}

void HistoryCache::store(const ddsi_writer_info& writer, Blob& blob) {
  if (peers_ && peers_->refuses(to_guid(writer.guid))) return;
  const bool disposed = (blob.statusinfo & kDisposed) != 0;
  if (blob.kind != SDK_DATA && !disposed) {
    queue_.instance_unregistered(blob.key_hash, to_guid(writer.guid));
    return;
  }
  const std::int64_t stamp = blob.timestamp.v;
  const bool stored = queue_.store(
      {payload_of(blob), disposed ? InstanceState::Disposed : InstanceState::Alive,
       blob.has_key ? std::optional(blob.key_hash) : std::nullopt, to_guid(writer.guid),
       stamp == DDS_TIME_INVALID ? std::nullopt : std::optional(SourceTime(stamp))},
      {writer.ownership_strength, lifespan_of(writer)});
  if (stored) dds_reader_data_available_cb(reader_);
}

}  // namespace skein::dds::cyclonedds
