#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "command/designer/layout.hpp"

namespace skein::command::compose {

using Places = std::map<std::string, designer::Place>;

/// What is remembered of a mission beside the user's other state, and is not in its file: where its
/// boxes stand, and what was not saved when the program ended. A file that cannot be read tells
/// nothing. Not thread-safe.
class KeptState {
 public:
  explicit KeptState(std::filesystem::path mission) : mission_(std::move(mission)) {}

  Places read_places() const;
  std::optional<std::string> read_draft() const;

  /// Writes them if they differ from the last ones. Throw as write_whole_file(), and Unavailable
  /// without a folder for it.
  void keep_places(const Places& places);
  /// Nothing: all is saved.
  void keep_draft(const std::optional<std::string>& draft);

 private:
  std::filesystem::path file(const char* kind) const;

  const std::filesystem::path mission_;
  std::optional<std::string> places_;  // as they were written last
  std::optional<std::string> draft_;
};

}  // namespace skein::command::compose
