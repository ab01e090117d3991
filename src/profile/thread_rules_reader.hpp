#pragma once

#include <array>

#include "profile/thread_rules.hpp"
#include "xml_element.hpp"

namespace skein::profile {

/// Of the whole process.
inline constexpr const char* kLockMemoryAttribute = "lock_memory";

/// The XML attributes of a peer or CSP that read_thread_rules() reads.
inline constexpr std::array kThreadAttributes{"thread", "scheduling", "priority",          "nice",
                                              "cpus",   "spin",       kLockMemoryAttribute};

/// The one that it reads of a peer alone: a CSP has one thread.
inline constexpr std::array kThreadCountAttributes{"threads"};

/// Whether a CPU exists is the business of the host that runs it.
ThreadRules read_thread_rules(const XmlElement& element);

}  // namespace skein::profile
