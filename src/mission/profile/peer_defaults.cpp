#include "peer_defaults.hpp"

#include <algorithm>
#include <iterator>

#include "mission/xml/notation.hpp"
#include "repeated.hpp"
#include "value_readers.hpp"

namespace skein::profile {
namespace {

class Completion {
 public:
  Completion(XmlNode& mission, const Variables& variables, FindingList& findings)
      : mission_(mission), variables_(variables), findings_(findings) {}

  void run() {
    auto children = std::move(mission_.children);
    mission_.children.clear();
    expand(mission_, std::nullopt);
    of_mission_ = shared_in(children);
    for (auto& child : children) {
      if (child.name == "peer") add_peer(child, nullptr);
      if (child.name == "group") add_group(child);
    }
  }

 private:
  using Instance = std::optional<std::string>;

  void expand(XmlNode& node, const Instance& instance) const {
    for (auto& attribute : node.attributes) variables_.expand(attribute, instance, findings_);
    for (auto& child : node.children) expand(child, instance);
  }

  static bool is_shared(const XmlNode& node) {
    return node.name == "environment" || node.name == "topic";
  }

  static std::vector<XmlNode> shared_in(const std::vector<XmlNode>& children) {
    std::vector<XmlNode> found;
    std::ranges::copy_if(children, std::back_inserter(found), is_shared);
    return found;
  }

  void add_group(XmlNode& group) {
    of_group_ = shared_in(group.children);
    auto name = XmlElement(group, findings_).attribute("name");
    variables_.expand(name, std::nullopt, findings_);
    groups_.add(name.value, group.where, findings_);
    name.name = kGroupAttribute;
    for (auto& child : group.children) {
      if (child.name != "peer") continue;
      child.attributes.push_back(name);
      add_peer(child, &group);
    }
    of_group_.clear();
  }

  void add_peer(const XmlNode& peer, const XmlNode* group) {
    const auto* written = peer.find_attribute("count");
    if (written == nullptr) return add(peer, group, std::nullopt);
    XmlNode counted{peer.name, peer.where, {*written}, {}, {}};
    expand(counted, std::nullopt);
    const int count = read_count(XmlElement(counted, findings_), "count", 1);
    for (int number = 1; number <= count; ++number) {
      add(peer, group, std::to_string(number));
    }
  }

  void add(XmlNode peer, const XmlNode* group, const Instance& instance) {
    if (full_) return;
    if (instance) number_name(peer);
    if (group != nullptr) inherit(peer, *group, attribute_group(kGroupDefaults));
    inherit_shared(peer, of_group_);
    inherit_shared(peer, of_mission_);
    expand(peer, instance);
    inherit(peer, mission_, attribute_group(kMissionDefaults));
    nodes_ += size_of(peer);
    if (mission_.children.size() == kMaxItems || nodes_ > kMaxNodes) {
      full_ = true;
      findings_.error(peer.where,
                      "the mission has too much: more than " + std::to_string(kMaxItems) +
                          " peers, or " + std::to_string(kMaxNodes) + " elements and attributes",
                      "make two missions of it");
      return;
    }
    mission_.children.push_back(std::move(peer));
  }

  static void number_name(XmlNode& peer) {
    for (auto& attribute : peer.attributes) {
      const bool plain = attribute.value.find("${instance}") == std::string::npos;
      if (attribute.name == "name" && plain && !attribute.value.empty())
        attribute.value += "-${instance}";
    }
  }

  static void inherit(XmlNode& peer, const XmlNode& outer,
                      const std::vector<std::string_view>& names) {
    for (const auto& name : names) {
      const auto* attribute = outer.find_attribute(name);
      if (attribute == nullptr || peer.find_attribute(name) != nullptr) continue;
      peer.attributes.push_back(*attribute);
      peer.attributes.back().inherited = true;
    }
  }

  /// What the peer does not name itself. A program of one's own obeys no <topic>.
  static void inherit_shared(XmlNode& peer, const std::vector<XmlNode>& shared) {
    const bool program = peer.find_attribute("program") != nullptr;
    const auto key_of = [](const XmlNode& node) {
      const auto* name = node.find_attribute("name");
      return std::pair(node.name, name != nullptr ? name->value : "");
    };
    for (const auto& item : shared) {
      if (program && item.name == "topic") continue;
      const bool own = std::ranges::any_of(
          peer.children, [&](const XmlNode& child) { return key_of(child) == key_of(item); });
      if (own) continue;
      peer.children.push_back(item);
      for (XmlAttribute& attribute : peer.children.back().attributes) attribute.inherited = true;
    }
  }

  XmlNode& mission_;
  const Variables& variables_;
  FindingList& findings_;
  Repeated groups_{"the group"};
  std::vector<XmlNode> of_mission_;  // environment and topics
  std::vector<XmlNode> of_group_;
  std::size_t nodes_ = 0;
  bool full_ = false;
};

}  // namespace

void complete_peers(XmlNode& mission, const Variables& variables, FindingList& findings) {
  Completion(mission, variables, findings).run();
}

}  // namespace skein::profile
