#include "xml_element.hpp"

#include "words.hpp"

namespace skein::profile {

std::optional<XmlAttribute> XmlElement::maybe_attribute(std::string_view attribute_name) const {
  const auto* found = node_->find_attribute(attribute_name);
  if (found == nullptr || found->unreadable) return std::nullopt;
  return *found;
}

XmlAttribute XmlElement::attribute(std::string_view attribute_name) const {
  const auto* found = node_->find_attribute(attribute_name);
  const std::string wanted(attribute_name);
  if (found != nullptr && found->unreadable) return {wanted, "", found->where};
  if (found != nullptr && !found->value.empty()) return *found;
  const auto& place = found != nullptr ? found->where : where();
  findings_->error(
      place, "<" + shortened(name()) + "> has " + (found != nullptr ? "an empty " : "no ") + wanted,
      "write " + wanted + "=\"...\"");
  return {wanted, "", place};
}

std::vector<XmlElement> XmlElement::children() const {
  std::vector<XmlElement> found;
  for (const auto& child : node_->children) found.emplace_back(child, *findings_);
  return found;
}

std::vector<XmlElement> XmlElement::children(std::string_view child_name) const {
  std::vector<XmlElement> found;
  for (const auto& child : node_->children) {
    if (child.name == child_name) found.emplace_back(child, *findings_);
  }
  return found;
}

std::optional<XmlElement> XmlElement::maybe_child(std::string_view child_name) const {
  const auto found = children(child_name);
  for (std::size_t i = 1; i < found.size(); ++i) {
    findings_->error(found[i].where(), "a second <" + std::string(child_name) + ">",
                     "put its content into the first, at " + to_text(found[0].where()));
  }
  if (found.empty()) return std::nullopt;
  return found.front();
}

}  // namespace skein::profile
