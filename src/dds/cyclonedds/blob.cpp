#include "blob.hpp"

#include <dds/ddsi/q_radmin.h>

#include <array>
#include <cstring>
#include <new>
#include <random>

#include "blob_memory.hpp"
#include "dds/port/sample_format.hpp"

namespace skein::dds::cyclonedds {
namespace {

Blob* as_blob(ddsi_serdata* data) { return static_cast<Blob*>(data); }
const Blob* as_blob(const ddsi_serdata* data) { return static_cast<const Blob*>(data); }

bool equal_keys(const ddsi_serdata* left, const ddsi_serdata* right) {
  return as_blob(left)->key_hash == as_blob(right)->key_hash;
}

std::uint32_t size_of(const ddsi_serdata* data) { return as_blob(data)->size; }

KeyHash to_key(const ddsi_keyhash* hash) {
  KeyHash key;
  std::memcpy(key.bytes.data(), hash->value, key.bytes.size());
  return key;
}

/// Cyclone's table of instances grows without end where some 32 of one hash stand in it, and
/// anybody may choose his keys; so nobody may know beforehand which keys have equal hashes.
/// Multilinear hashing with random factors: of any two keys with a probability of 2^-32 (Lemire and
/// Kaser, "Strongly universal string hashing is fast", 2014).
std::uint32_t instance_hash(const KeyHash& key) noexcept {
  static const std::array<std::uint64_t, 5> kFactors = [] {
    std::array<std::uint64_t, 5> factors;
    std::random_device random;
    for (std::uint64_t& factor : factors) factor = std::uint64_t{random()} << 32 | random();
    return factors;
  }();
  std::array<std::uint32_t, 4> words;
  std::memcpy(words.data(), key.bytes.data(), sizeof words);
  std::uint64_t sum = kFactors[4];
  for (std::size_t i = 0; i < words.size(); ++i) sum += kFactors[i] * words[i];
  return static_cast<std::uint32_t>(sum >> 32);
}

/// Puts a received sample together. Fragments come in order and may overlap.
void copy_fragments(const nn_rdata* fragment, Blob* blob, std::size_t size) {
  std::uint32_t copied = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= copied || fragment->maxp1 > size) continue;
    const unsigned char* payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(blob->bytes() + copied, payload + (copied - fragment->min),
                fragment->maxp1 - copied);
    copied = fragment->maxp1;
  }
}

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragments, std::size_t size) {
  // A malformed sample passes here and is counted by the reader's queue: only that knows the
  // reader.
  Blob* blob = Blob::make(type, kind, size);
  copy_fragments(fragments, blob, size);
  if (kind == SDK_DATA && size >= kHeaderSize) {
    blob->length = static_cast<std::uint32_t>(without_padding(blob->bytes(), size).size());
  }
  const ddsi_keyhash* hash = ddsi_serdata_keyhash_from_fragchain(fragments);
  blob->set_key(hash != nullptr && type->typekind_no_key == 0 ? to_key(hash) : KeyHash{});
  blob->has_key = hash != nullptr || type->typekind_no_key != 0;
  return blob;
}

ddsi_serdata* from_buffers(const ddsi_sertype* type, ddsi_serdata_kind kind,
                           ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* buffers,
                           std::size_t size) {
  Blob* blob = Blob::make(type, kind, size);
  std::size_t copied = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count && copied < size; ++i) {
    const std::size_t part = std::min<std::size_t>(buffers[i].iov_len, size - copied);
    std::memcpy(blob->bytes() + copied, buffers[i].iov_base, part);
    copied += part;
  }
  blob->set_key({});
  blob->has_key = type->typekind_no_key != 0;
  return blob;
}

ddsi_serdata* from_key_hash(const ddsi_sertype* type, const ddsi_keyhash* hash) {
  Blob* blob = Blob::make(type, SDK_KEY, 0);
  blob->set_key(to_key(hash));
  return blob;
}

ddsi_serdata* from_sample(const ddsi_sertype*, ddsi_serdata_kind, const void*) {
  return nullptr;  // there is no sample but the bytes
}

void copy_out(const ddsi_serdata* data, std::size_t offset, std::size_t size, void* buffer) {
  std::memcpy(buffer, as_blob(data)->bytes() + offset, size);
}

ddsi_serdata* lend_out(const ddsi_serdata* data, std::size_t offset, std::size_t size,
                       ddsrt_iovec_t* reference) {
  reference->iov_base = const_cast<std::byte*>(as_blob(data)->bytes() + offset);
  reference->iov_len = size;
  return ddsi_serdata_ref(data);
}

void take_back(ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); }

bool to_sample(const ddsi_serdata*, void*, void**, void*) { return false; }

bool untyped_to_sample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
  return false;
}

ddsi_serdata* key_alone(const ddsi_serdata* data) {
  Blob* blob = Blob::make(data->type, SDK_KEY, 0);
  blob->set_key(as_blob(data)->key_hash);
  blob->type = nullptr;  // what Cyclone's instance table holds is shared between topics
  return blob;
}

void free_blob(ddsi_serdata* data) {
  Blob* blob = as_blob(data);
  all_are_done_with(*blob);
  const std::size_t size = sizeof(Blob) + padded(blob->size);
  blob->~Blob();
  free_blob_memory(blob, size);
}

std::size_t print(const ddsi_sertype*, const ddsi_serdata* data, char* buffer, std::size_t size) {
  const int length = snprintf(buffer, size, "blob of %u bytes", as_blob(data)->size);
  return static_cast<std::size_t>(length);
}

void get_key_hash(const ddsi_serdata* data, ddsi_keyhash* hash, bool) {
  std::memcpy(hash->value, as_blob(data)->key_hash.bytes.data(), sizeof hash->value);
}

const ddsi_serdata_ops kBlobOperations{
    .eqkey = equal_keys,
    .get_size = size_of,
    .from_ser = from_fragments,
    .from_ser_iov = from_buffers,
    .from_keyhash = from_key_hash,
    .from_sample = from_sample,
    .to_ser = copy_out,
    .to_ser_ref = lend_out,
    .to_ser_unref = take_back,
    .to_sample = to_sample,
    .to_untyped = key_alone,
    .untyped_to_sample = untyped_to_sample,
    .free = free_blob,
    .print = print,
    .get_keyhash = get_key_hash,
    .get_sample_size = nullptr,
    .from_iox_buffer = nullptr,
};

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete type;
}

void no_samples(const ddsi_sertype*, void*, std::size_t) {}
void no_new_samples(void** samples, const ddsi_sertype*, void*, std::size_t, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) samples[i] = nullptr;
}
void no_old_samples(const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {}
bool same_type(const ddsi_sertype*, const ddsi_sertype*) { return true; }
std::uint32_t type_hash(const ddsi_sertype*) { return 0; }

// No type information: Fast DDS and Cyclone refuse each other's (PID 75).
const ddsi_sertype_ops kTypeOperations{
    .version = ddsi_sertype_v0,
    .arg = nullptr,
    .free = free_type,
    .zero_samples = no_samples,
    .realloc_samples = no_new_samples,
    .free_samples = no_old_samples,
    .equal = same_type,
    .hash = type_hash,
    .type_id = nullptr,
    .type_map = nullptr,
    .type_info = nullptr,
    .derive_sertype = nullptr,
    .get_serialized_size = nullptr,
    .serialize_into = nullptr,
};

}  // namespace

Blob* Blob::make(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  void* memory = allocate_blob(sizeof(Blob) + padded(size));
  Blob* blob = new (memory) Blob;
  ddsi_serdata_init(blob, type, kind);
  blob->size = static_cast<std::uint32_t>(size);
  blob->length = blob->size;
  blob->has_key = true;
  blob->outgoing = false;
  return blob;
}

Blob* Blob::make_outgoing(const ddsi_sertype* type, std::span<const std::byte> cdr,
                          const KeyHash& key) {
  Blob* blob = make(type, SDK_DATA, padded(cdr.size()));
  copy_padded(cdr, blob->bytes());
  blob->length = static_cast<std::uint32_t>(cdr.size());
  blob->outgoing = true;
  blob->set_key(key);
  return blob;
}

Blob* Blob::copy_incoming() const {
  Blob* blob = make(type, SDK_DATA, size);
  std::memcpy(blob->bytes(), bytes(), size);
  blob->length = static_cast<std::uint32_t>(without_padding(blob->bytes(), size).size());
  blob->set_key(key_hash);
  return blob;
}

void Blob::set_key(const KeyHash& key) noexcept {
  key_hash = key;
  hash = instance_hash(key);
}

ddsi_sertype* make_blob_type(const Topic& topic) {
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init_flags(
      type, topic.type_name.c_str(), &kTypeOperations, &kBlobOperations,
      topic.keyed ? DDSI_SERTYPE_FLAG_REQUEST_KEYHASH : DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation =
      DDS_DATA_REPRESENTATION_FLAG_XCDR1 | DDS_DATA_REPRESENTATION_FLAG_XCDR2;
  return type;
}

}  // namespace skein::dds::cyclonedds
