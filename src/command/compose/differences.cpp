#include "differences.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "mission/xml/words.hpp"

namespace skein::command::compose {
namespace {

using profile::in_quotes;
using profile::XmlNode;
using Kind = Difference::Kind;

std::string attribute_of(const XmlNode& node, const char* name) {
  const auto* const attribute = node.find_attribute(name);
  return attribute ? attribute->value : "";
}

/// The attribute that identifies an element among its siblings.
std::string name_of(const XmlNode& node) {
  for (const char* attribute : {"name", "component", "file"})
    if (std::string name = attribute_of(node, attribute); !name.empty()) return name;
  return "";
}

std::string called(const XmlNode& node) {
  const std::string name = name_of(node);
  return node.name + (name.empty() ? "" : " " + profile::shortened(name));
}

/// The surroundings of an element: its entity, the words before its own, the inherited system.
struct Around {
  std::string entity;
  std::string words;
  std::string system = "default";
};

class Walk {
 public:
  void compare(const XmlNode& before, const XmlNode& now, const Around& around) {
    const Around inner = within(now, around);
    compare_attributes(before, now, inner);
    if (before.text != now.text) add(Kind::Changed, inner, "has another text");
    const auto old = keyed(before), fresh = keyed(now);
    for (const auto& [key, child] : old)
      if (!fresh.contains(key)) add_whole(Kind::Gone, *child, within(before, around), inner);
    for (const auto& [key, child] : fresh) {
      if (const auto same = old.find(key); same != old.end()) {
        compare(*same->second, *child, inner);
      } else {
        add_whole(Kind::New, *child, inner, inner);
      }
    }
  }

  std::vector<Difference> result() && { return std::move(result_); }

 private:
  static Around within(const XmlNode& node, const Around& around) {
    Around inner = around;
    if (const std::string system = attribute_of(node, "system"); !system.empty())
      inner.system = system;
    if (node.name == "peer") inner.entity = inner.system + "/" + attribute_of(node, "name");
    if (node.name == "peer") {
      inner.words = profile::shortened(attribute_of(node, "name"));
    } else if (node.name != "mission") {
      inner.words += (inner.words.empty() ? "" : ", ") + called(node);
    }
    return inner;
  }

  static std::map<std::string, const XmlNode*> keyed(const XmlNode& node) {
    std::map<std::string, const XmlNode*> children;
    std::map<std::string, int> counts;
    for (const XmlNode& child : node.children) {
      const std::string key = child.name + "\n" + name_of(child);
      children.emplace(key + "\n" + std::to_string(counts[key]++), &child);
    }
    return children;
  }

  void add(Kind kind, const Around& at, const std::string& text) {
    result_.push_back(
        {kind, at.entity, false, (at.words.empty() ? "the mission" : at.words) + ": " + text});
  }

  void add_whole(Kind kind, const XmlNode& child, const Around& its, const Around& around) {
    const bool entity = child.name == "peer";
    const std::string text = called(child) + (kind == Kind::New ? " is new" : " is gone");
    if (entity) {
      result_.push_back({kind, within(child, its).entity, true, text});
    } else {
      add(kind, around, text);
    }
    if (child.name != "group") return;
    for (const XmlNode& peer : child.children)
      if (peer.name == "peer") add_whole(kind, peer, within(child, its), around);
  }

  void compare_attributes(const XmlNode& before, const XmlNode& now, const Around& at) {
    for (const auto& attribute : now.attributes) {
      const auto* const old = before.find_attribute(attribute.name);
      if (old && old->value == attribute.value) continue;
      add(old ? Kind::Changed : Kind::New, at,
          attribute.name + " is " + in_quotes(attribute.value) +
              (old ? ", was " + in_quotes(old->value) : ", was not given"));
    }
    for (const auto& attribute : before.attributes)
      if (!now.find_attribute(attribute.name))
        add(Kind::Gone, at, attribute.name + " is not given, was " + in_quotes(attribute.value));
  }

  std::vector<Difference> result_;
};

}  // namespace

std::vector<Difference> differences(const XmlNode& before, const XmlNode& now) {
  Walk walk;
  walk.compare(before, now, {});
  return std::move(walk).result();
}

}  // namespace skein::command::compose
