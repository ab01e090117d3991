#pragma once

#include <catch2/catch.hpp>

#include "skein/detail/codec.hpp"
#include "skein/detail/type_support.hpp"

/// A value comes back from CDR of both byte orders, from JSON, and through its type support.
template <class T>
void check_round_trips(const T& value) {
  using namespace skein::idl;
  CHECK(decode_message<T>(encode_message(value)) == value);
  CHECK(from_json<T>(to_json(value)) == value);

  skein::Bytes big{std::span<const std::byte>(encapsulation(kRepresentation<T>))};
  append_cdr(
      big, [&](CdrWriter& writer) { encode(writer, value); }, ByteOrder::Big);
  big.data()[1] = static_cast<std::byte>(std::to_integer<unsigned>(big.data()[1]) - 1);
  CHECK(decode_message<T>(big) == value);

  const skein::TypeSupport& support = type_support<T>();
  void* copy = support.make();
  support.assign(copy, &value);
  CHECK(*static_cast<T*>(copy) == value);
  support.destroy(copy);
}

/// Why a message is no such value.
template <class T>
std::string refusal(std::span<const std::byte> message) {
  try {
    skein::idl::decode_message<T>(message);
  } catch (const skein::idl::MalformedSample& error) {
    return error.what();
  }
  return "accepted";
}
