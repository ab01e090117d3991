#pragma once

#include <vector>

#include "command/look/domain_picture.hpp"
#include "command/look/onlooker.hpp"
#include "command/look/topic_findings.hpp"
#include "command/print/interruption.hpp"
#include "mission/profile/mission_profile.hpp"
#include "symptom.hpp"

namespace skein::command::doctor {

/// Joins the domain with one peer on each of `vendors`, and tells which of them do not find each
/// other; then which peers of the mission (null: of none), whose launcher runs if it `flies`, do
/// not answer. Takes a second, or five
/// if somebody is not found; an interruption ends it sooner.
Symptoms encounter(const Onlooker& place, const std::vector<std::string>& vendors,
                   const profile::MissionProfile* mission, bool flies,
                   const Interruption& interruption);

/// What is odd about peers that are there: those that do not answer, or do not work, or are of
/// another version of Skein, or do not hear each other since types, QoS or names of their topics
/// differ, or provide a service in different versions. `tell_types` is asked as topic_conflicts()
/// does.
Symptoms diagnose_peers(const DomainPicture& picture, const TellTypes& tell_types = {});

}  // namespace skein::command::doctor
