#include "submessage_judge.hpp"

#include <algorithm>

namespace skein::dds {
namespace {

using namespace rtps_message;

constexpr Admission::Verdict kSound;

Admission::Verdict demand(bool well_formed) {
  return well_formed ? kSound : Admission::Verdict(Refusal::Form);
}

std::uint32_t entity_at(const unsigned char* id) { return get32(id, false); }

}  // namespace

enum class SubmessageJudge::Service { None, Participants, Endpoints, Topics, Liveliness, Security };

SubmessageJudge::Service SubmessageJudge::service_of(const unsigned char* entity) {
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

std::optional<SubmessageJudge::Verdict> SubmessageJudge::judge_form(const Submessage& submessage) {
  switch (submessage.kind()) {
    case kPad:
      return kSound;
    case kInfoTimestamp:
      return demand(submessage.flag(0x02) || submessage.size >= 8);
    case kInfoDestination:
      return demand(submessage.size >= kPrefixSize);
    default:
      return std::nullopt;
  }
}

SubmessageJudge::Verdict SubmessageJudge::judge(const Submessage& submessage,
                                                const Origin& origin) {
  const Verdict verdict = judge_by_kind(submessage, origin);
  if (verdict || is_announcement(submessage) || admission_.knows(origin)) return verdict;
  return Refusal::Stranger;
}

SubmessageJudge::Verdict SubmessageJudge::judge_by_kind(const Submessage& submessage,
                                                        const Origin& origin) {
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

SubmessageJudge::Verdict SubmessageJudge::judge_heartbeat(const Submessage& submessage,
                                                          const Origin& origin) {
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

SubmessageJudge::Verdict SubmessageJudge::judge_gap(const Submessage& submessage,
                                                    const Origin& origin) {
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

SubmessageJudge::Verdict SubmessageJudge::judge_data(const Submessage& submessage,
                                                     const Origin& origin) {
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
  // A farewell may come from a participant that was never found.
  if (service == Service::Participants && !admission_.knows(origin)) return kSound;
  return admission_.sample(origin, entity_at(found->writer), found->number);
}

SubmessageJudge::Verdict SubmessageJudge::judge_discovery(const Submessage& submessage,
                                                          const Data& found, Service service,
                                                          const Origin& origin) {
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

bool SubmessageJudge::check_locators(const Data& found, const Origin& origin) const {
  return keep_locators(found.payload, found.payload_size, [&](std::uint32_t address) {
    return addresses_.may_name(origin.source, address) ||
           admission_.has_announced_from(origin.participant, address);
  });
}

SubmessageJudge::Verdict SubmessageJudge::judge_data_frag(const Submessage& submessage,
                                                          const Origin& origin) {
  Fragments fragments;
  const auto found = data_frag(submessage, fragments);
  if (!found) return Refusal::Form;
  // Discovery in pieces cannot be looked at, and vendors send it whole.
  if (service_of(found->writer) != Service::None) return Refusal::Unused;
  return admission_.fragments(origin, entity_at(found->writer), found->number, fragments);
}

}  // namespace skein::dds
