#include "rpc/wire/wire.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace skein::rpc::wire {
namespace {

static_assert(std::endian::native == std::endian::little,
              "trailers and headers are written as they lie");

constexpr std::uint32_t kTrailerMagic = 0x314E4B53;  // "SKN1"
constexpr std::size_t kOrigin = 4;  // alignment counts from behind the encapsulation
constexpr std::size_t kMaxChain = 64;
constexpr std::chrono::hours kMaxRemaining{24 * 365};
constexpr std::chrono::hours kMaxSent{24 * 365 * 100};  // so that differences can be computed
constexpr std::size_t kMaxText = 64 * 1024;
constexpr std::size_t kMaxStrategy = 256;
constexpr std::size_t kMaxTrailer = kMaxText + 4096;
constexpr std::size_t kIdEnd = kOrigin + 24;

template <class T>
void put(Bytes& message, T value) {
  message.append(std::as_bytes(std::span(&value, 1)));
}

void put_text(Bytes& message, std::string_view text) {
  put(message, static_cast<std::uint32_t>(text.size()));
  message.append(std::as_bytes(std::span(text)));
}

void align(Bytes& message) {
  constexpr std::byte kZeros[4]{};
  const std::size_t past = (message.size() - kOrigin) % 4;
  if (past != 0) message.append(std::span(kZeros).first(4 - past));
}

void begin(Bytes& message, Representation representation, const RequestId& id) {
  message.clear();
  message.append(encapsulation(representation));
  message.append(std::as_bytes(std::span(id.client.bytes)));
  put(message, static_cast<std::int32_t>(id.number >> 32));
  put(message, static_cast<std::uint32_t>(id.number));
}

// Reads what vendors and strangers sent: checks each step against the end.
class Cursor {
 public:
  Cursor(std::span<const std::byte> message, std::size_t offset, bool swap)
      : message_(message), offset_(offset), swap_(swap) {}

  template <class T>
  T get() {
    const auto raw = bytes(sizeof(T));
    std::uint8_t copy[sizeof(T)];
    std::memcpy(copy, raw.data(), sizeof(T));
    if (swap_) std::reverse(copy, copy + sizeof(T));
    return std::bit_cast<T>(copy);
  }

  std::span<const std::byte> bytes(std::size_t count) {
    if (count > message_.size() - offset_) refuse_truncated(count);
    const auto part = message_.subspan(offset_, count);
    offset_ += count;
    return part;
  }

  std::string text(std::size_t limit) {
    const auto length = get<std::uint32_t>();
    if (length > limit) refuse_text(length, limit);
    const auto raw = bytes(length);
    return {reinterpret_cast<const char*>(raw.data()), raw.size()};
  }

  Guid guid() {
    Guid guid;
    std::memcpy(guid.bytes.data(), bytes(16).data(), 16);
    return guid;
  }

  RequestId request_id() {
    RequestId id;
    id.client = guid();
    const auto high = get<std::uint32_t>();
    id.number = (std::uint64_t{high} << 32) | get<std::uint32_t>();
    return id;
  }

  void align() { bytes((4 - (offset_ - kOrigin) % 4) % 4); }
  std::size_t offset() const { return offset_; }
  bool at_end() const { return offset_ == message_.size(); }

 private:
  // Not inlined, so that what reads each field of each message stays small.
  [[noreturn, gnu::noinline]] void refuse_truncated(std::size_t count) const {
    throw InvalidArgument("truncated: " + std::to_string(count) + " bytes wanted at offset " +
                          std::to_string(offset_) + " of " + std::to_string(message_.size()));
  }
  [[noreturn, gnu::noinline]] void refuse_text(std::size_t length, std::size_t limit) const {
    throw InvalidArgument("a text of " + std::to_string(length) + " bytes at offset " +
                          std::to_string(offset_) + "; the limit is " + std::to_string(limit));
  }

  std::span<const std::byte> message_;
  std::size_t offset_;
  bool swap_;
};

// XCDR1 or XCDR2, in which heads and trailers look the same: they have no number of eight bytes.
bool is_plain_cdr(std::span<const std::byte> message) noexcept {
  if (message.size() < kOrigin || message[0] != std::byte{0}) return false;
  const auto kind = std::to_integer<unsigned>(message[1]) & ~1U;
  return kind == 0 || kind == 6;
}

bool is_big_endian(std::span<const std::byte> message) {
  if (!is_plain_cdr(message)) throw InvalidArgument("no PLAIN_CDR encapsulation header");
  return (message[1] & std::byte{1}) == std::byte{0};
}

// A cursor behind the trailer's magic and length, which also bounds it; nothing where none begins.
std::optional<Cursor> find_trailer(std::span<const std::byte> message, std::size_t end) {
  const std::size_t start = end + (4 - (end - kOrigin) % 4) % 4;
  if (start + 8 > message.size()) return std::nullopt;
  Cursor cursor(message, start, false);
  if (cursor.get<std::uint32_t>() != kTrailerMagic) return std::nullopt;
  const auto length = cursor.get<std::uint32_t>();
  cursor.bytes(length);
  return Cursor(message.first(start + 8 + length), start + 8, false);
}

template <class Fill>
void append_trailer_with(Bytes& message, Fill fill) {
  align(message);
  put(message, kTrailerMagic);
  const std::size_t length_at = message.size();
  put(message, std::uint32_t{0});
  fill();
  const auto length = static_cast<std::uint32_t>(message.size() - length_at - 4);
  std::memcpy(message.data() + length_at, &length, 4);
}

}  // namespace

void begin_request(Bytes& message, const RequestId& id, std::uint32_t operation,
                   Representation representation) {
  begin(message, representation, id);
  put(message, std::uint32_t{1});  // the empty instance name: its terminator alone
  put(message, char{0});
  append_discriminator(message, operation);
}

void begin_reply(Bytes& message, const RequestId& related, RemoteException exception,
                 std::uint32_t operation, Representation representation) {
  begin(message, representation, related);
  put(message, exception);
  append_discriminator(message, operation);
}

void append_discriminator(Bytes& message, std::uint32_t value) {
  align(message);
  put(message, value);
}

void append_default_branch(Bytes& message) { put(message, std::uint8_t{0}); }

void append_trailer(Bytes& message, const RequestTrailer& trailer) {
  append_trailer_with(message, [&] {
    put(message, std::int64_t{std::chrono::nanoseconds(trailer.remaining).count()});
    put(message, trailer.target);
    put(message, static_cast<std::uint32_t>(trailer.chain.size()));
    for (const Guid& guid : trailer.chain) message.append(std::as_bytes(std::span(guid.bytes)));
    put_text(message, trailer.strategy);
    put(message, trailer.credit);
    put(message, std::int64_t{std::chrono::nanoseconds(trailer.sent).count()});
  });
}

void append_trailer(Bytes& message, const ReplyTrailer& trailer) {
  append_trailer_with(message, [&] {
    put(message, trailer.code);
    put_text(message, std::string_view(trailer.text).substr(0, kMaxText));
    put(message, trailer.part);
    put(message, trailer.position);
  });
}

std::optional<RequestId> read_request_id(std::span<const std::byte> message) noexcept {
  if (message.size() < kIdEnd || !is_plain_cdr(message)) return std::nullopt;
  Cursor cursor(message, kOrigin, is_big_endian(message));
  return cursor.request_id();
}

bool ends_with_trailer(std::span<const std::byte> message) noexcept {
  constexpr std::size_t kFrame = 8;    // magic and length
  constexpr std::size_t kPadding = 3;  // some vendors pass on what RTPS padded
  if (message.size() < kOrigin + kFrame) return false;
  const std::size_t first = message.size() - std::min(message.size() - kOrigin, kMaxTrailer);
  for (std::size_t at = (message.size() - kFrame) & ~std::size_t{3}; at >= std::max(first, kOrigin);
       at -= 4) {
    std::uint32_t frame[2];
    std::memcpy(frame, message.data() + at, sizeof frame);
    const std::size_t rest = message.size() - at - kFrame;
    if (frame[0] == kTrailerMagic && frame[1] <= rest && rest - frame[1] <= kPadding) return true;
  }
  return false;
}

RequestHead read_request_head(std::span<const std::byte> message) {
  Cursor cursor(message, 0, is_big_endian(message));
  cursor.bytes(kOrigin);
  RequestHead head;
  head.id = cursor.request_id();
  head.instance = cursor.text(256);
  if (head.instance.empty() || head.instance.back() != '\0') {
    throw InvalidArgument("the instance name has no terminator");
  }
  head.instance.pop_back();
  cursor.align();
  head.operation = cursor.get<std::uint32_t>();
  head.body = cursor.offset();
  return head;
}

ReplyHead read_reply_head(std::span<const std::byte> message) {
  Cursor cursor(message, 0, is_big_endian(message));
  cursor.bytes(kOrigin);
  ReplyHead head;
  head.related = cursor.request_id();
  head.exception = cursor.get<RemoteException>();
  head.operation = cursor.get<std::uint32_t>();
  head.result = cursor.offset();
  return head;
}

std::uint32_t read_discriminator(std::span<const std::byte> message, std::size_t& offset) {
  Cursor cursor(message, offset, is_big_endian(message));
  cursor.align();
  const auto value = cursor.get<std::uint32_t>();
  offset = cursor.offset();
  return value;
}

std::optional<RequestTrailer> read_request_trailer(std::span<const std::byte> message,
                                                   std::size_t end) {
  auto cursor = find_trailer(message, end);
  if (!cursor) return std::nullopt;
  RequestTrailer trailer;
  trailer.remaining = std::clamp<Duration>(std::chrono::nanoseconds(cursor->get<std::int64_t>()),
                                           Duration::zero(), kMaxRemaining);
  trailer.target = cursor->get<std::uint64_t>();
  const auto count = cursor->get<std::uint32_t>();
  if (count > kMaxChain) {
    throw InvalidArgument("a call chain of " + std::to_string(count) + " services; the limit is " +
                          std::to_string(kMaxChain));
  }
  for (std::uint32_t i = 0; i < count; ++i) trailer.chain.push_back(cursor->guid());
  trailer.strategy = cursor->text(kMaxStrategy);
  if (!cursor->at_end()) trailer.credit = cursor->get<std::uint32_t>();
  if (!cursor->at_end()) {
    trailer.sent = std::clamp<Duration>(std::chrono::nanoseconds(cursor->get<std::int64_t>()),
                                        Duration::zero(), kMaxSent);
  }
  return trailer;
}

std::optional<ReplyTrailer> read_reply_trailer(std::span<const std::byte> message,
                                               std::size_t end) {
  auto cursor = find_trailer(message, end);
  if (!cursor) return std::nullopt;
  ReplyTrailer trailer;
  trailer.code = cursor->get<ErrorCode>();
  trailer.text = cursor->text(kMaxText);
  if (cursor->at_end()) return trailer;
  trailer.part = cursor->get<StreamPart>();
  if (trailer.part > StreamPart::End) {
    throw InvalidArgument("no part of a stream: " +
                          std::to_string(static_cast<std::uint32_t>(trailer.part)));
  }
  trailer.position = cursor->get<std::uint64_t>();
  return trailer;
}

RemoteException remote_exception_of(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::Unimplemented:
      return RemoteException::Unsupported;
    case ErrorCode::InvalidArgument:
      return RemoteException::InvalidArgument;
    case ErrorCode::Overloaded:
      return RemoteException::OutOfResources;
    default:
      return RemoteException::UnknownException;
  }
}

ErrorCode error_code_of(RemoteException exception) noexcept {
  switch (exception) {
    case RemoteException::Unsupported:
    case RemoteException::UnknownOperation:
      return ErrorCode::Unimplemented;
    case RemoteException::InvalidArgument:
      return ErrorCode::InvalidArgument;
    case RemoteException::OutOfResources:
      return ErrorCode::Overloaded;
    default:
      return ErrorCode::Internal;
  }
}

}  // namespace skein::rpc::wire
