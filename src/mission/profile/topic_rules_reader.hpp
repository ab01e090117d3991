#pragma once

#include <vector>

#include "mission/profile/topic_rules.hpp"
#include "mission/xml/xml_element.hpp"

namespace skein::profile {

/// Of the <topic>s in a <peer>, in their order. Which peers publish a topic, and so whether what is
/// requested is offered, only the running mission knows.
std::vector<TopicRules> read_topic_rules(const XmlElement& peer);

}  // namespace skein::profile
