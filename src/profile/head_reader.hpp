#pragma once

#include <array>

#include "skein/head_options.hpp"
#include "xml_element.hpp"

namespace skein::profile {

/// The XML attributes of a peer that read_head_options() reads.
inline constexpr std::array kHeadAttributes{
    "strategy",  "history",          "decision_log",     "exploration",
    "max_stuck", "quarantine_after", "first_quarantine", "longest_quarantine"};

/// Any word is taken for a strategy: a plugin may bring it.
HeadOptions read_head_options(const XmlElement& element);

/// Warnings of these attributes at a peer that has nothing to choose among.
void warn_of_head_without_csps(const XmlElement& element);

}  // namespace skein::profile
