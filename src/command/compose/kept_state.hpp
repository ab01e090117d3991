#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "command/designer/layout.hpp"
#include "core/system/file_descriptor.hpp"

namespace skein::command::compose {

/// The state of a mission that is not in its file, in the folder of the user's state: the places of
/// boxes, and the changes that were unsaved when the program ended. An unreadable file counts as
/// none. One process at a time keeps those of a mission. Not thread-safe.
class KeptState {
 public:
  /// Throws Unavailable while another process keeps them.
  explicit KeptState(std::filesystem::path mission);

  struct Draft {
    std::string text;
    std::optional<std::string> base;  ///< The text of the file then; nullopt: there was none.
    bool operator==(const Draft&) const = default;
  };

  using Places = std::map<std::string, designer::Place>;

  Places read_places() const;
  std::optional<Draft> read_draft();

  /// Writes them if they differ from the last ones. Throw as write_whole_file(), and Unavailable
  /// without a folder for it.
  void keep_places(const Places& places);
  /// Nothing: all is saved.
  void keep_draft(const std::optional<Draft>& draft);
  /// The draft's file if it has that text; else empty.
  std::filesystem::path file_with(const std::string& text) const;

 private:
  std::filesystem::path file(const char* kind) const;

  const std::filesystem::path mission_;
  std::optional<std::string> places_;  // as they were written last
  std::optional<Draft> draft_;
  FileDescriptor lock_;
};

}  // namespace skein::command::compose
