#include "rtps_guard.hpp"

#include <cstring>

namespace skein::dds {
namespace {

using namespace rtps_message;

bool is_header(const unsigned char* message, std::size_t size) {
  constexpr unsigned char kNobody[kPrefixSize] = {};
  return size >= kRtpsHeaderSize && std::memcmp(message, "RTPS\x02", 5) == 0 &&
         std::memcmp(message + kPrefix, kNobody, kPrefixSize) != 0;
}

}  // namespace

RtpsGuard::Passed RtpsGuard::pass(unsigned char* message, std::size_t size, std::uint32_t source,
                                  Clock::time_point now) {
  if (!addresses_.sources.allows(source)) {
    refusals_.count(Refusal::Source, 0, source);
    return {};
  }
  if (!is_header(message, size)) {
    refusals_.count(Refusal::Form, 0, source);
    return {};
  }
  const Admission::Origin origin{sender(message), source, now};
  Passed passed;
  for (std::size_t at = kRtpsHeaderSize; at < size;) {
    const auto submessage = submessage_at(message, size, at);
    if (!submessage || submessage->size % 4 != 0) {
      refusals_.count(Refusal::Form, 0, source);
      break;
    }
    at += kSubmessageHeaderSize + submessage->size;
    // Vendors' own, which others pass over. Each message of Debian's Fast DDS ends with one.
    const bool passed_over = submessage->kind() >= kFirstOfVendors;
    const Verdict verdict = passed_over ? Verdict() : judge(*submessage, origin);
    if (!passed_over && !verdict) {
      passed.size = at;
      passed.announces |= is_announcement(*submessage);
      passed.acknowledges |= submessage->kind() == kAckNack;
      continue;
    }
    if (verdict) refusals_.count(*verdict, submessage->kind(), source);
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

void RtpsGuard::sent(const Submessage& submessage, Guid& receiver) {
  const unsigned char* body = submessage.body();
  if (submessage.kind() == kInfoDestination && submessage.size >= kPrefixSize) {
    std::memcpy(receiver.bytes.data(), body, kPrefixSize);
  }
  if (submessage.kind() != kAckNack || submessage.size < 16) return;
  const std::int64_t base = get_sequence_number(body + 8, submessage.little());
  const std::lock_guard lock(mutex_);
  admission_.acknowledged(receiver, get32(body + 4, false), get32(body, false), base - 1);
}

RtpsGuard::Verdict RtpsGuard::judge(const Submessage& submessage, const Admission::Origin& origin) {
  if (const auto verdict = SubmessageJudge::judge_form(submessage)) return *verdict;
  const std::lock_guard lock(mutex_);
  return judge_.judge(submessage, origin);
}

}  // namespace skein::dds
