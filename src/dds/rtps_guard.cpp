#include "rtps_guard.hpp"

#include <cstdio>
#include <cstring>

#include "core/log.hpp"
#include "repeated_messages.hpp"

namespace skein::dds {
namespace {

using namespace rtps_message;

constexpr std::optional<RtpsGuard::Refusal> kGood;

/// A reader takes memory and time for each number of a GAP.
constexpr std::int64_t kLongestGap = 1 << 16;

Guid guid_of(const unsigned char* prefix, const unsigned char* entity) {
  Guid guid;
  std::memcpy(guid.bytes.data(), prefix, kPrefixSize);
  std::memcpy(guid.bytes.data() + kPrefixSize, entity, 4);
  return guid;
}

enum class Builtin { None, Participants, Endpoints, Liveliness, Security };

/// To which of DDS's own services an entity id belongs.
Builtin builtin(const unsigned char* entity) {
  if ((entity[3] & 0xc0) != 0xc0) return Builtin::None;
  if (entity[0] == 0xff) return Builtin::Security;
  const unsigned number = entity[0] << 16 | entity[1] << 8 | entity[2];
  switch (number) {
    case 0x000100:
      return Builtin::Participants;
    case 0x000002:
    case 0x000003:
    case 0x000004:
      return Builtin::Endpoints;
    case 0x000200:
      return Builtin::Liveliness;
    case 0x000201:
      return Builtin::Security;
    default:
      return Builtin::None;
  }
}

const char* describe(RtpsGuard::Refusal why) {
  switch (why) {
    case RtpsGuard::Refusal::Source:
      return "its address is not among the allowed sources";
    case RtpsGuard::Refusal::Form:
      return "it is not formed as RTPS says";
    case RtpsGuard::Refusal::Unused:
      return "nobody here uses its kind";
    case RtpsGuard::Refusal::Leap:
      return "its sequence numbers are far beyond those announced";
    case RtpsGuard::Refusal::Fragment:
      return "its fragments are too small, or contradict earlier ones";
    case RtpsGuard::Refusal::Room:
      return "its sample in fragments is too large, or one too many";
    case RtpsGuard::Refusal::Parameters:
      return "its discovery parameters reach beyond it";
    case RtpsGuard::Refusal::Lease:
      return "it announces a participant without its lease (PID_PARTICIPANT_LEASE_DURATION)";
  }
  return "";
}

std::string to_text(std::uint32_t address) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    text += (text.empty() ? "" : ".") + std::to_string(address >> shift & 0xff);
  }
  return text;
}

bool is_header(const unsigned char* message, std::size_t size) {
  constexpr unsigned char kNobody[kPrefixSize] = {};
  return size >= kHeaderSize && std::memcmp(message, "RTPS\x02", 5) == 0 &&
         std::memcmp(message + kPrefix, kNobody, kPrefixSize) != 0;
}

}  // namespace

RtpsGuard::Passed RtpsGuard::pass(unsigned char* message, std::size_t size, std::uint32_t source,
                                  Clock::time_point now) {
  if (!sources_.allows(source)) {
    count(Refusal::Source, 0, source);
    return {};
  }
  if (!is_header(message, size)) {
    count(Refusal::Form, 0, source);
    return {};
  }
  Passed passed;
  for (std::size_t at = kHeaderSize; at < size;) {
    const auto submessage = submessage_at(message, size, at);
    if (!submessage || submessage->size % 4 != 0) {
      count(Refusal::Form, 0, source);
      break;
    }
    at += kSubmessageHeaderSize + submessage->size;
    // Vendors' own, which others pass over. Each message of Debian's Fast DDS ends with one.
    const bool passed_over = submessage->kind() >= kFirstOfVendors;
    const Verdict verdict = passed_over ? kGood : judge(*submessage, message + kPrefix, now);
    if (!passed_over && !verdict) {
      passed.size = at;
      passed.announces |= is_announcement(*submessage);
      passed.acknowledges |= submessage->kind() == kAckNack;
      passed.asserts_liveliness |= is_of_liveliness_writer(*submessage);
      continue;
    }
    if (verdict) count(*verdict, submessage->kind(), source);
    // What follows INFO_SRC would be taken for another sender's.
    if (verdict == Refusal::Form || submessage->kind() == kInfoSource || submessage->last) break;
    submessage->header[0] = kPad;
  }
  return passed;
}

RtpsGuard::Verdict RtpsGuard::judge(const Submessage& submessage, const unsigned char* prefix,
                                    Clock::time_point now) {
  const auto demand = [](bool well_formed) { return well_formed ? kGood : Verdict(Refusal::Form); };
  switch (submessage.kind()) {
    case kPad:
      return kGood;
    case kInfoTimestamp:
      return demand(submessage.flag(0x02) || submessage.size >= 8);
    case kInfoDestination:
      return demand(submessage.size >= kPrefixSize);
    case kAckNack: {
      const auto set = sequence_number_set(submessage, 8);
      return demand(set && submessage.size >= set->end + 4);
    }
    case kNackFrag: {
      if (submessage.size < 16) return Refusal::Form;
      const auto set = fragment_number_set(submessage, 16);
      const auto sample = get_sequence_number(submessage.body() + 8, submessage.little());
      return demand(set && sample >= 1 && submessage.size >= set->end + 4);
    }
    case kHeartbeatFrag:
      return demand(submessage.size >= 24 &&
                    get_sequence_number(submessage.body() + 8, submessage.little()) >= 1 &&
                    get32(submessage.body() + 16, submessage.little()) >= 1);
    case kHeartbeat:
      return judge_heartbeat(submessage, prefix, now);
    case kGap:
      return judge_gap(submessage, prefix, now);
    case kData:
      return judge_data(submessage, prefix, now);
    case kDataFrag:
      return judge_data_frag(submessage, prefix, now);
    default:
      return Refusal::Unused;
  }
}

RtpsGuard::Verdict RtpsGuard::judge_heartbeat(const Submessage& submessage,
                                              const unsigned char* prefix, Clock::time_point now) {
  if (submessage.size < 28) return Refusal::Form;
  const unsigned char* body = submessage.body();
  const std::int64_t first = get_sequence_number(body + 8, submessage.little());
  const std::int64_t last = get_sequence_number(body + 16, submessage.little());
  if (first < 1 || last < first - 1) return Refusal::Form;
  return announce(prefix, body + 4, last, now) ? kGood : Verdict(Refusal::Leap);
}

RtpsGuard::Verdict RtpsGuard::judge_gap(const Submessage& submessage, const unsigned char* prefix,
                                        Clock::time_point now) {
  const auto set = sequence_number_set(submessage, 16);
  if (!set) return Refusal::Form;
  unsigned char* body = submessage.body();
  const std::int64_t start = get_sequence_number(body + 8, submessage.little());
  if (start < 1 || set->base < start) return Refusal::Form;
  if (!announce(prefix, body + 4, set->base - 1 + set->bits, now)) return Refusal::Leap;
  if (set->base - start > kLongestGap) {
    // A part of it is as true; the reader asks for the rest.
    put_sequence_number(body + 16, start + kLongestGap, submessage.little());
    put32(body + 24, 0, submessage.little());
  }
  return kGood;
}

RtpsGuard::Verdict RtpsGuard::judge_data(const Submessage& submessage, const unsigned char* prefix,
                                         Clock::time_point now) {
  const auto found = data(submessage);
  if (!found) return Refusal::Form;
  const Builtin service = builtin(found->writer);
  if (service == Builtin::Security) return Refusal::Unused;
  if (submessage.flag(kHasData) && service != Builtin::None) {
    const bool good = service == Builtin::Liveliness
                          ? check_liveliness(found->payload, found->payload_size)
                          : check_discovery(found->payload, found->payload_size);
    if (!good) return Refusal::Parameters;
    if (service == Builtin::Participants && !names_lease(found->payload, found->payload_size)) {
      return Refusal::Lease;
    }
  }
  return announce(prefix, found->writer, found->number, now) ? kGood : Verdict(Refusal::Leap);
}

RtpsGuard::Verdict RtpsGuard::judge_data_frag(const Submessage& submessage,
                                              const unsigned char* prefix, Clock::time_point now) {
  Fragments fragments;
  const auto found = data_frag(submessage, fragments);
  if (!found) return Refusal::Form;
  // Discovery in pieces cannot be looked at, and vendors send it whole.
  if (builtin(found->writer) != Builtin::None) return Refusal::Unused;
  const std::lock_guard lock(mutex_);
  const Guid writer = guid_of(prefix, found->writer);
  if (!ledger_.announce(writer, found->number, now)) return Refusal::Leap;
  switch (ledger_.fragments(writer, found->number, fragments, now)) {
    case WriterLedger::Verdict::Good:
      return kGood;
    case WriterLedger::Verdict::Contradiction:
      return Refusal::Fragment;
    case WriterLedger::Verdict::NoRoom:
      return Refusal::Room;
  }
  return Refusal::Form;
}

bool RtpsGuard::announce(const unsigned char* prefix, const unsigned char* writer,
                         std::int64_t number, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  return ledger_.announce(guid_of(prefix, writer), number, now);
}

void RtpsGuard::count(Refusal why, unsigned char kind, std::uint32_t source) {
  const auto so_far =
      counts_[static_cast<std::size_t>(why)].fetch_add(1, std::memory_order_relaxed) + 1;
  if (!is_told(so_far)) return;
  char what[32] = "message";
  if (kind != 0) std::snprintf(what, sizeof what, "submessage (0x%02x)", kind);
  log(LogLevel::Warning, place_,
      std::string("refused a ") + what + " from " + to_text(source) + ": " + describe(why) +
          " (refused so far for this reason: " + std::to_string(so_far) + ")");
}

}  // namespace skein::dds
