#include "raw/cyclonedds_sample.hpp"

#include <dds/ddsi/q_radmin.h>

#include <cstdint>
#include <cstring>
#include <new>

namespace skein::benchmarks::raw {
namespace {

Sample* sample_of(const ddsi_serdata* data) {
  return static_cast<Sample*>(const_cast<ddsi_serdata*>(data));
}

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* part,
                             std::size_t size) {
  Sample* sample = Sample::make(type, kind, size);
  for (std::uint32_t copied = 0; part != nullptr; part = part->nextfrag) {
    if (part->maxp1 <= copied) continue;
    const unsigned char* payload = NN_RMSG_PAYLOADOFF(part->rmsg, NN_RDATA_PAYLOAD_OFF(part));
    std::memcpy(sample->bytes() + copied, payload + (copied - part->min), part->maxp1 - copied);
    copied = part->maxp1;
  }
  return sample;
}

ddsi_serdata* from_buffers(const ddsi_sertype* type, ddsi_serdata_kind kind,
                           ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* buffers,
                           std::size_t size) {
  Sample* sample = Sample::make(type, kind, size);
  char* to = sample->bytes();
  for (ddsrt_msg_iovlen_t i = 0; i < count; to += buffers[i++].iov_len) {
    std::memcpy(to, buffers[i].iov_base, buffers[i].iov_len);
  }
  return sample;
}

ddsi_serdata* lend(const ddsi_serdata* data, std::size_t offset, std::size_t size,
                   ddsrt_iovec_t* to) {
  to->iov_base = sample_of(data)->bytes() + offset;
  to->iov_len = size;
  return ddsi_serdata_ref(data);
}

ddsi_serdata* without_key(const ddsi_serdata* data) {
  Sample* sample = Sample::make(data->type, SDK_KEY, 0);
  sample->type = nullptr;
  return sample;
}

const ddsi_serdata_ops kSampleOperations{
    .eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; },
    .get_size =
        [](const ddsi_serdata* data) { return static_cast<std::uint32_t>(sample_of(data)->size); },
    .from_ser = from_fragments,
    .from_ser_iov = from_buffers,
    .from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) -> ddsi_serdata* {
      return Sample::make(type, SDK_KEY, 0);
    },
    .from_sample = [](const ddsi_sertype*, ddsi_serdata_kind, const void*) -> ddsi_serdata* {
      return nullptr;
    },
    .to_ser = [](const ddsi_serdata* data, std::size_t offset, std::size_t size,
                 void* to) { std::memcpy(to, sample_of(data)->bytes() + offset, size); },
    .to_ser_ref = lend,
    .to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); },
    .to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; },
    .to_untyped = without_key,
    .untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**,
                            void*) { return false; },
    .free = [](ddsi_serdata* data) { ::operator delete(sample_of(data)); },
    .print = [](const ddsi_sertype*, const ddsi_serdata*, char*,
                std::size_t) { return std::size_t{0}; },
    .get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash,
                      bool) { std::memset(hash->value, 0, sizeof hash->value); },
    .get_sample_size = nullptr,
    .from_iox_buffer = nullptr,
};

const ddsi_sertype_ops kTypeOperations{
    .version = ddsi_sertype_v0,
    .arg = nullptr,
    .free =
        [](ddsi_sertype* type) {
          ddsi_sertype_fini(type);
          delete type;
        },
    .zero_samples = [](const ddsi_sertype*, void*, std::size_t) {},
    .realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {},
    .free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {},
    .equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; },
    .hash = [](const ddsi_sertype*) { return std::uint32_t{0}; },
    .type_id = nullptr,
    .type_map = nullptr,
    .type_info = nullptr,
    .derive_sertype = nullptr,
    .get_serialized_size = nullptr,
    .serialize_into = nullptr,
};

}  // namespace

Sample* Sample::make(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  const std::size_t padded = (size + 3) / 4 * 4;
  auto* sample = new (::operator new(sizeof(Sample) + padded)) Sample;
  ddsi_serdata_init(sample, type, kind);
  sample->size = padded;
  sample->hash = 0;
  return sample;
}

ddsi_sertype* make_type(const char* name) {
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init_flags(type, name, &kTypeOperations, &kSampleOperations,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

}  // namespace skein::benchmarks::raw
