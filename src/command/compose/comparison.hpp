#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "design_state.idl.hpp"

namespace skein::command::compose {

/// The comparison of a mission with another one. Not thread-safe.
class Comparison {
 public:
  /// `folders`: those from which missions may be read.
  explicit Comparison(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

  /// Compares with this file from now on; with none if it is empty. Throws InvalidArgument for a
  /// file outside the folders, DescriptionError for one that is no mission.
  void compare_with(const std::filesystem::path& file);

  /// Tells the differences between the other mission and the design's text. There are none if
  /// either cannot be read.
  void tell(DesignState& design) const;

 private:
  bool may_read(const std::filesystem::path& file) const;

  const std::vector<std::filesystem::path> folders_;
  std::filesystem::path file_;
};

}  // namespace skein::command::compose
