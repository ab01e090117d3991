#pragma once

#include <cstddef>
#include <span>

#include "skein/core/guid.hpp"
#include "skein/idl/codec.hpp"

namespace skein::idl {

/// The MD5 digest (RFC 1321). For identities, not for security.
Guid md5(std::span<const std::byte> content) noexcept;

/// The DDS key hash of a key whose big-endian CDR is `message` after the encapsulation header: the
/// key itself, padded with zeros, where its type never takes more than 16 bytes, else its MD5.
Guid key_hash_of(std::span<const std::byte> message, bool short_key);

/// The same, of what `write(CdrWriter&)` writes. Used by generated code.
template <std::invocable<CdrWriter&> Write>
Guid make_key_hash(bool short_key, const Write& write) {
  Bytes message{std::span<const std::byte>(kEncapsulation)};
  append_cdr(message, write, ByteOrder::Big);
  return key_hash_of(message, short_key);
}

}  // namespace skein::idl
