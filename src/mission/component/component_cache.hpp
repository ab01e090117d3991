#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "mission/component/component_description.hpp"
#include "mission/xml/xml_node.hpp"

namespace skein::profile {

/// Reads each component file of a profile once, however many peers name it: a small profile can
/// not make much work out of one large component.
class ComponentCache {
 public:
  explicit ComponentCache(FindingList& findings) : findings_(findings) {}

  /// The component in the file that the attribute names, relative to the file in which it stands;
  /// null and findings if it cannot be read.
  std::shared_ptr<const ComponentDescription> read(const XmlAttribute& named);

  /// Of the components that could be read.
  std::set<std::filesystem::path> files() const;

 private:
  FindingList& findings_;
  std::map<std::filesystem::path, std::shared_ptr<const ComponentDescription>> read_;
};

}  // namespace skein::profile
