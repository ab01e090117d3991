#pragma once

#include <cstddef>
#include <span>

#include "skein/detail/codec.hpp"
#include "skein/guid.hpp"

namespace skein::idl {

/// The MD5 digest (RFC 1321). For identities, not for security.
Guid md5(std::span<const std::byte> content) noexcept;

/// The DDS key hash of a key; `message` holds its big-endian CDR after an encapsulation header.
/// With `short_key`, where the type never takes more than 16 bytes, it is the key itself, padded
/// with zeros; otherwise its MD5.
Guid key_hash_of(std::span<const std::byte> message, bool short_key);

/// As key_hash_of(), for what `write(CdrWriter&)` writes. Used by generated code.
template <std::invocable<CdrWriter&> Write>
Guid make_key_hash(bool short_key, const Write& write,
                   Representation representation = Representation::Xcdr1) {
  Bytes message{std::span<const std::byte>(encapsulation(representation))};
  append_cdr(message, write, ByteOrder::Big);
  return key_hash_of(message, short_key);
}

}  // namespace skein::idl
