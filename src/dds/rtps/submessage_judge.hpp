#pragma once

#include <optional>

#include "dds/port/allowed_sources.hpp"
#include "packet_admission.hpp"
#include "rtps_message.hpp"

namespace skein::dds {

/// Decides whether a submessage may be handed on: by its form, its kind, and earlier messages of
/// its sender. May replace a statement of the submessage by one that is as true and claims less.
/// Reads no clock and takes no lock. Not thread-safe.
class SubmessageJudge {
 public:
  using Origin = Admission::Origin;
  using Verdict = Admission::Verdict;

  /// Both outlive the judge.
  SubmessageJudge(const Addresses& addresses, Admission& admission)
      : addresses_(addresses), admission_(admission) {}

  /// The verdict on a kind for which the sender does not matter (PAD, INFO_TS, INFO_DST). Returns
  /// nullopt for other kinds, which judge() takes.
  static std::optional<Verdict> judge_form(const rtps_message::Submessage& submessage);

  /// The verdict on a submessage of any other kind.
  Verdict judge(const rtps_message::Submessage& submessage, const Origin& origin);

 private:
  /// DDS's own services.
  enum class Service;
  static Service service_of(const unsigned char* entity);

  Verdict judge_by_kind(const rtps_message::Submessage& submessage, const Origin& origin);
  Verdict judge_data(const rtps_message::Submessage& submessage, const Origin& origin);
  Verdict judge_discovery(const rtps_message::Submessage& submessage,
                          const rtps_message::Data& found, Service service, const Origin& origin);
  bool check_locators(const rtps_message::Data& found, const Origin& origin) const;
  Verdict judge_data_frag(const rtps_message::Submessage& submessage, const Origin& origin);
  Verdict judge_heartbeat(const rtps_message::Submessage& submessage, const Origin& origin);
  Verdict judge_gap(const rtps_message::Submessage& submessage, const Origin& origin);

  const Addresses& addresses_;
  Admission& admission_;
};

}  // namespace skein::dds
