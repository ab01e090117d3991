#include "rtps_guard.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "core/log.hpp"
#include "repeated_messages.hpp"

namespace skein::dds {
namespace {

using namespace rtps_message;

constexpr Admission::Verdict kSound;

std::uint32_t entity_at(const unsigned char* id) { return get32(id, false); }

const char* describe(Refusal why) {
  switch (why) {
    case Refusal::Source:
      return "its address is not among the allowed sources";
    case Refusal::Form:
      return "it is not formed as RTPS says";
    case Refusal::Unused:
      return "nobody here uses its kind";
    case Refusal::Stranger:
      return "its participant has not announced itself";
    case Refusal::Unmatched:
      return "it is a fragment of a writer that nobody here reads";
    case Refusal::Leap:
      return "its sequence numbers are far beyond what was received of its writer";
    case Refusal::Fragment:
      return "its fragments are too small, or contradict earlier ones";
    case Refusal::Room:
      return "its sample in fragments is too large, or one too many";
    case Refusal::Parameters:
      return "its discovery parameters reach beyond it";
    case Refusal::Foreign:
      return "it speaks of another participant, or of another's endpoints";
    case Refusal::Crowd:
      return "it is of one participant too many, of its address or in all, or too soon";
    case Refusal::Announced:
      return "its participant, its address or all together have announced too many endpoints, or "
             "too large ones";
    case Refusal::Locator:
      return "its participant names only addresses that are not its own, and not in the profile "
             "(peers, allowed_sources)";
    case Refusal::Lease:
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
  return size >= kRtpsHeaderSize && std::memcmp(message, "RTPS\x02", 5) == 0 &&
         std::memcmp(message + kPrefix, kNobody, kPrefixSize) != 0;
}

}  // namespace

enum class RtpsGuard::Service { None, Participants, Endpoints, Topics, Liveliness, Security };

RtpsGuard::Service RtpsGuard::service_of(const unsigned char* entity) {
  if ((entity[3] & 0xc0) != 0xc0) return Service::None;
  if (entity[0] == 0xff) return Service::Security;
  const unsigned number = entity[0] << 16 | entity[1] << 8 | entity[2];
  switch (number) {
    case 0x000100:
      return Service::Participants;
    case 0x000002:
      return Service::Topics;
    case 0x000003:
    case 0x000004:
      return Service::Endpoints;
    case 0x000200:
      return Service::Liveliness;
    case 0x000201:
      return Service::Security;
    default:
      return Service::None;
  }
}

RtpsGuard::Passed RtpsGuard::pass(unsigned char* message, std::size_t size, std::uint32_t source,
                                  Clock::time_point now) {
  if (!addresses_.sources.allows(source)) {
    count(Refusal::Source, 0, source);
    return {};
  }
  if (!is_header(message, size)) {
    count(Refusal::Form, 0, source);
    return {};
  }
  const Origin origin{sender(message), source, now};
  Passed passed;
  for (std::size_t at = kRtpsHeaderSize; at < size;) {
    const auto submessage = submessage_at(message, size, at);
    if (!submessage || submessage->size % 4 != 0) {
      count(Refusal::Form, 0, source);
      break;
    }
    at += kSubmessageHeaderSize + submessage->size;
    // Vendors' own, which others pass over. Each message of Debian's Fast DDS ends with one.
    const bool passed_over = submessage->kind() >= kFirstOfVendors;
    const Verdict verdict = passed_over ? kSound : judge(*submessage, origin);
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

void RtpsGuard::found(const Guid& participant) {
  const std::lock_guard lock(mutex_);
  admission_.found(participant);
}

void RtpsGuard::removed(const Guid& participant) {
  const std::lock_guard lock(mutex_);
  admission_.removed(participant);
}

void RtpsGuard::endpoint_found(const Guid& endpoint) {
  const std::lock_guard lock(mutex_);
  admission_.endpoint_found(endpoint.participant(), entity_of(endpoint));
}

void RtpsGuard::endpoint_removed(const Guid& endpoint) {
  const std::lock_guard lock(mutex_);
  admission_.endpoint_removed(endpoint.participant(), entity_of(endpoint));
}

void RtpsGuard::matched(const Guid& writer, std::uint32_t reader, bool now) {
  const std::lock_guard lock(mutex_);
  admission_.matched(writer.participant(), entity_of(writer), reader, now);
}

void RtpsGuard::reader_gone(std::uint32_t reader) {
  const std::lock_guard lock(mutex_);
  admission_.reader_gone(reader);
}

std::vector<Admission::Incomplete> RtpsGuard::give_up(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  return admission_.give_up(now);
}

void RtpsGuard::dropped(const Admission::Incomplete& sample) {
  const std::lock_guard lock(mutex_);
  admission_.dropped(sample);
}

std::size_t RtpsGuard::participants() const {
  const std::lock_guard lock(mutex_);
  return admission_.participants();
}

void RtpsGuard::sent(const unsigned char* message, std::size_t size) {
  Guid receiver;
  // It only reads them.
  for_each_submessage(const_cast<unsigned char*>(message), size, [&](const Submessage& submessage) {
    const unsigned char* body = submessage.body();
    if (submessage.kind() == kInfoDestination && submessage.size >= kPrefixSize) {
      std::memcpy(receiver.bytes.data(), body, kPrefixSize);
    }
    if (submessage.kind() != kAckNack || submessage.size < 16) return;
    const std::int64_t base = get_sequence_number(body + 8, submessage.little());
    const std::lock_guard lock(mutex_);
    admission_.acknowledged(receiver, entity_at(body + 4), entity_at(body), base - 1);
  });
}

RtpsGuard::Verdict RtpsGuard::judge(const Submessage& submessage, const Origin& origin) {
  const auto demand = [](bool well_formed) {
    return well_formed ? kSound : Verdict(Refusal::Form);
  };
  switch (submessage.kind()) {
    case kPad:
      return kSound;
    case kInfoTimestamp:
      return demand(submessage.flag(0x02) || submessage.size >= 8);
    case kInfoDestination:
      return demand(submessage.size >= kPrefixSize);
    default:
      break;
  }
  const std::lock_guard lock(mutex_);
  const Verdict verdict = judge_by_kind(submessage, origin);
  if (verdict || is_announcement(submessage) || admission_.knows(origin)) return verdict;
  return Refusal::Stranger;
}

RtpsGuard::Verdict RtpsGuard::judge_by_kind(const Submessage& submessage, const Origin& origin) {
  const auto demand = [](bool well_formed) {
    return well_formed ? kSound : Verdict(Refusal::Form);
  };
  switch (submessage.kind()) {
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
      return judge_heartbeat(submessage, origin);
    case kGap:
      return judge_gap(submessage, origin);
    case kData:
      return judge_data(submessage, origin);
    case kDataFrag:
      return judge_data_frag(submessage, origin);
    default:
      return Refusal::Unused;
  }
}

RtpsGuard::Verdict RtpsGuard::judge_heartbeat(const Submessage& submessage, const Origin& origin) {
  if (submessage.size < 28) return Refusal::Form;
  unsigned char* body = submessage.body();
  std::int64_t first = get_sequence_number(body + 8, submessage.little());
  std::int64_t last = get_sequence_number(body + 16, submessage.little());
  if (first < 1 || last < first - 1) return Refusal::Form;
  const Verdict verdict = admission_.heartbeat(origin, entity_at(body + 4), first, last);
  put_sequence_number(body + 8, first, submessage.little());
  put_sequence_number(body + 16, last, submessage.little());
  return verdict;
}

RtpsGuard::Verdict RtpsGuard::judge_gap(const Submessage& submessage, const Origin& origin) {
  const auto set = sequence_number_set(submessage, 16);
  if (!set) return Refusal::Form;
  unsigned char* body = submessage.body();
  const std::int64_t start = get_sequence_number(body + 8, submessage.little());
  if (start < 1 || set->base < start) return Refusal::Form;
  const std::int64_t said = std::max(start, set->base - 1 + set->bits);
  std::int64_t last = said;
  if (const auto verdict = admission_.gap(origin, entity_at(body + 4), start, last)) return verdict;
  if (last < said) {
    // A part of it is as true.
    put_sequence_number(body + 16, std::min(set->base, last + 1), submessage.little());
    put32(body + 24, 0, submessage.little());
  }
  return kSound;
}

RtpsGuard::Verdict RtpsGuard::judge_data(const Submessage& submessage, const Origin& origin) {
  const auto found = data(submessage);
  if (!found) return Refusal::Form;
  const Service service = service_of(found->writer);
  // Nobody here asks for topics.
  if (service == Service::Security || service == Service::Topics) return Refusal::Unused;
  if (service != Service::None) {
    if (const auto verdict = judge_discovery(submessage, *found, service, origin)) return verdict;
  }
  if (service == Service::Endpoints) {
    const std::uint32_t writer = entity_at(found->writer);
    if (const auto verdict = admission_.may_wait(origin, writer, found->number)) return verdict;
  }
  // A farewell may come from who was never found.
  if (service == Service::Participants && !admission_.knows(origin)) return kSound;
  return admission_.sample(origin, entity_at(found->writer), found->number);
}

RtpsGuard::Verdict RtpsGuard::judge_discovery(const Submessage& submessage, const Data& found,
                                              Service service, const Origin& origin) {
  const unsigned char* prefix = origin.participant.bytes.data();
  const bool has_payload = submessage.flag(kHasData) || submessage.flag(kHasKey);
  if (service == Service::Liveliness) {
    if (!has_payload) return kSound;
    if (submessage.flag(kHasData) && !check_liveliness(found.payload, found.payload_size)) {
      return Refusal::Parameters;
    }
    const bool own = is_liveliness_of(found.payload, found.payload_size, prefix);
    return own ? kSound : Verdict(Refusal::Foreign);
  }
  if (has_payload && !check_discovery(found.payload, found.payload_size)) {
    return Refusal::Parameters;
  }
  if (!is_of_sender(submessage, prefix)) return Refusal::Foreign;
  if (!submessage.flag(kHasData)) return kSound;
  if (service == Service::Participants) {
    constexpr std::uint32_t kLongestLease = 100;  // RTPS's default, in seconds
    if (!names_lease(found.payload, found.payload_size, kLongestLease)) return Refusal::Lease;
    if (!check_locators(found, origin)) return Refusal::Locator;
    if (const auto verdict = admission_.announced(origin)) return verdict;
  } else {
    check_locators(found, origin);
  }
  const auto whose = announced_entity(found.payload, found.payload_size);
  if (!whose) return Refusal::Parameters;
  return admission_.announced(origin, *whose, found.payload_size);
}

bool RtpsGuard::check_locators(const Data& found, const Origin& origin) const {
  return keep_locators(found.payload, found.payload_size, [&](std::uint32_t address) {
    return addresses_.may_name(origin.source, address) ||
           admission_.has_announced_from(origin.participant, address);
  });
}

RtpsGuard::Verdict RtpsGuard::judge_data_frag(const Submessage& submessage, const Origin& origin) {
  Fragments fragments;
  const auto found = data_frag(submessage, fragments);
  if (!found) return Refusal::Form;
  // Discovery in pieces cannot be looked at, and vendors send it whole.
  if (service_of(found->writer) != Service::None) return Refusal::Unused;
  return admission_.fragments(origin, entity_at(found->writer), found->number, fragments);
}

void RtpsGuard::count(Refusal why, unsigned char kind, std::uint32_t source) {
  const auto so_far =
      counts_[static_cast<std::size_t>(why)].fetch_add(1, std::memory_order_relaxed) + 1;
  // Who has just found somebody speaks to him before the announcement has come.
  if (why == Refusal::Stranger || !is_told(so_far)) return;
  char what[32] = "message";
  if (kind != 0) std::snprintf(what, sizeof what, "submessage (0x%02x)", kind);
  log(LogLevel::Warning, place_,
      std::string("refused a ") + what + " from " + to_text(source) + ": " + describe(why) +
          " (refused so far for this reason: " + std::to_string(so_far) + ")");
}

}  // namespace skein::dds
