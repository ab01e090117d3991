#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "finding_list.hpp"
#include "profile/component_description.hpp"

namespace skein::profile {

/// Reads each component file of a profile once, however many peers name it: a small profile can
/// not make much work out of one large component.
class ComponentCache {
 public:
  ComponentCache(std::filesystem::path folder, FindingList& findings)
      : folder_(std::move(folder)), findings_(findings) {}

  /// The component in `file`, relative to the folder; null and findings if it cannot be read.
  /// `named_at` is where the profile names it.
  std::shared_ptr<const ComponentDescription> read(const std::string& file,
                                                   const SourcePosition& named_at);

 private:
  std::filesystem::path folder_;
  FindingList& findings_;
  std::map<std::filesystem::path, std::shared_ptr<const ComponentDescription>> read_;
};

}  // namespace skein::profile
