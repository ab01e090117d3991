#pragma once

#include <string>
#include <vector>

#include "command/print/interruption.hpp"
#include "skein/inspector.hpp"
#include "topic_findings.hpp"

namespace skein::command {

/// How long entities that are known have to answer; those that hang are left out.
inline constexpr std::chrono::seconds kAnswerPatience{2};

/// The topic of that name, once an entity has it. Throws Unavailable with the most similar name
/// if none has it after `seconds`, InvalidArgument if there are two of that name, and
/// Interrupted.
KnownTopic await_topic(Inspector& inspector, const std::string& name, double seconds,
                       const Interruption& interruption);

/// The types that a topic's type names, as its publishers tell them if there are any, or its
/// subscriptions; the other way round if not `publishers`.
types::TypeSystem types_of(Inspector& inspector, const KnownTopic& topic, bool publishers = true);

/// Asks entities for the types of their topics, and none again that did not answer. `inspector`
/// must outlive it.
TellTypes types_told_by(Inspector& inspector);

/// On stderr: who does not hear whom there, because their types or their QoS differ.
void tell_conflicts(Inspector& inspector, const KnownTopic& topic);

}  // namespace skein::command
