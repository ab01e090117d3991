#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "mission/component/component_description.hpp"
#include "mission/xml/xml_node.hpp"

namespace skein::command::compose {

/// A component description that a mission can use.
struct KnownComponent {
  std::shared_ptr<const profile::ComponentDescription> description;  ///< Null: `failure` says why.
  std::string failure;
  std::string plugin;   ///< That a mission names for it, or of the source beside it; may be empty.
  std::string program;  ///< The same; a name without a slash, or a whole path.
};

/// The component descriptions in some folders, and in the folders in them, by their whole paths.
/// Not thread-safe.
class Repository {
 public:
  explicit Repository(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

  /// Reads the folders anew.
  void look();

  const std::map<std::filesystem::path, KnownComponent>& components() const noexcept {
    return components_;
  }
  /// The first dictionary that was found; empty: none.
  const std::filesystem::path& dictionary() const noexcept { return dictionary_; }
  /// The folders with IDL files.
  std::vector<std::filesystem::path> idl_folders() const {
    return {idl_folders_.begin(), idl_folders_.end()};
  }
  /// Why not all is known, in words.
  const std::vector<std::string>& troubles() const noexcept { return troubles_; }

 private:
  struct Use;

  void look_into(const std::filesystem::path& folder);
  void read(const std::filesystem::path& file);
  void add_uses(const profile::XmlNode& node, const Use& around);

  const std::vector<std::filesystem::path> folders_;
  std::map<std::filesystem::path, KnownComponent> components_;
  std::map<std::filesystem::path, std::pair<std::string, std::string>> uses_;  // plugin, program
  std::filesystem::path dictionary_;
  std::set<std::filesystem::path> idl_folders_;
  std::vector<std::string> troubles_;
};

/// A path in which links, `.` and `..` are resolved, as far as it is there.
std::filesystem::path whole_path(const std::filesystem::path& path);

}  // namespace skein::command::compose
