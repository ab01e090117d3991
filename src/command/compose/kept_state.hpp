#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "command/designer/layout.hpp"
#include "core/system/file_descriptor.hpp"

namespace skein::command::compose {

using Places = std::map<std::string, designer::Place>;

/// What is remembered of a mission beside the user's other state, and is not in its file: where its
/// boxes stand, and what was not saved when the program ended. A file that cannot be read tells
/// nothing. One process at a time keeps those of a mission. Not thread-safe.
class KeptState {
 public:
  /// Throws Unavailable while another process keeps them.
  explicit KeptState(std::filesystem::path mission);

  struct Draft {
    std::string text;
    std::optional<std::string> base;  ///< What the file had; nothing: there was none.
    bool operator==(const Draft&) const = default;
  };

  Places read_places() const;
  std::optional<Draft> read_draft();

  /// Writes them if they differ from the last ones. Throw as write_whole_file(), and Unavailable
  /// without a folder for it.
  void keep_places(const Places& places);
  /// Nothing: all is saved.
  void keep_draft(const std::optional<Draft>& draft);
  /// Has the draft's text; empty: there is none.
  std::filesystem::path draft_file() const { return draft_ ? file("drafts") : ""; }

 private:
  std::filesystem::path file(const char* kind) const;

  const std::filesystem::path mission_;
  std::optional<std::string> places_;  // as they were written last
  std::optional<Draft> draft_;
  FileDescriptor lock_;
};

}  // namespace skein::command::compose
