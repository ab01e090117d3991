#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "dds/port/port.hpp"

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace skein::dds::cyclonedds {

/// An opaque sample in Cyclone's terms: bytes as they travel, and a key hash as the instance's
/// whole identity. Cyclone counts references to it; the bytes follow the object in the same
/// allocation.
struct Blob : ddsi_serdata {
  KeyHash key_hash;
  std::uint32_t size;    // as on the wire: what we write is a multiple of 4
  std::uint32_t length;  // without padding
  bool has_key;
  bool outgoing;  // its header carries the mark of its padding

  std::byte* bytes() noexcept { return reinterpret_cast<std::byte*>(this + 1); }
  const std::byte* bytes() const noexcept { return reinterpret_cast<const std::byte*>(this + 1); }

  /// With one reference, which the caller owns, and its bytes not yet set.
  static Blob* make(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size);

  /// A sample to be written.
  static Blob* make_outgoing(const ddsi_sertype* type, std::span<const std::byte> cdr,
                             const KeyHash& key);

  /// The same sample as a remote reader would receive it.
  Blob* copy_incoming() const;

  /// The key decides the hash that Cyclone looks instances up by: it must be set before use.
  void set_key(const KeyHash& key) noexcept;
};

/// TSan does not see Cyclone count references. Without these two it takes the last use of a blob by
/// one thread and its end in another for a race: who was lent a blob says when it is done with it.
inline void done_with([[maybe_unused]] Blob& blob) noexcept {
#ifdef __SANITIZE_THREAD__
  __tsan_release(&blob);
#endif
}
inline void all_are_done_with([[maybe_unused]] Blob& blob) noexcept {
#ifdef __SANITIZE_THREAD__
  __tsan_acquire(&blob);
#endif
}

/// One reference to a blob.
class BlobReference {
 public:
  /// Takes over one that the caller owns.
  static BlobReference adopt(Blob* blob) noexcept { return BlobReference(blob, nullptr); }
  /// Adds one.
  explicit BlobReference(Blob* blob) noexcept : blob_(static_cast<Blob*>(ddsi_serdata_ref(blob))) {}
  BlobReference(BlobReference&& other) noexcept : blob_(std::exchange(other.blob_, nullptr)) {}
  BlobReference& operator=(BlobReference&& other) noexcept {
    std::swap(blob_, other.blob_);
    return *this;
  }
  ~BlobReference() {
    if (blob_ == nullptr) return;
    done_with(*blob_);
    ddsi_serdata_unref(blob_);
  }
  /// Hands the reference over.
  std::shared_ptr<const void> keep() { return std::make_shared<BlobReference>(std::move(*this)); }
  Blob& operator*() const noexcept { return *blob_; }
  Blob* operator->() const noexcept { return blob_; }

 private:
  BlobReference(Blob* blob, std::nullptr_t) noexcept : blob_(blob) {}
  Blob* blob_;
};

/// The only type of this back end: named as the topic says, without description. Ownership
/// goes to Cyclone with dds_create_topic_sertype().
ddsi_sertype* make_blob_type(const Topic& topic);

}  // namespace skein::dds::cyclonedds
