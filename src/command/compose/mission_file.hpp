#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "text_history.hpp"

namespace skein::command::compose {

/// A file that is edited, and may be edited by others meanwhile. Not thread-safe.
class MissionFile {
 public:
  /// The file, compared with its text when it was last read or written here.
  enum class Disk { Same, Changed, Gone };

  /// Reads the file; if there is none, it will have `text_if_new`. Throws DescriptionError as
  /// read_text_file().
  MissionFile(std::filesystem::path file, const std::string& text_if_new);

  const TextHistory& history() const noexcept { return history_; }
  TextHistory& history() noexcept { return history_; }
  const std::string& text() const noexcept { return history_.text(); }

  /// Whether the file has another text, as far as it was read or written here.
  bool is_changed() const { return saved_ != history_.text(); }

  /// The text of the file when it was last read or written here; nullopt: there was none.
  const std::optional<std::string>& saved() const noexcept { return saved_; }

  Disk disk() const;

  /// Throws Unavailable if others have changed the file, unless `over` them, and as
  /// write_whole_file().
  void save(bool over);

  /// The label of restore().
  static constexpr const char* kRestored = "take up unsaved changes";

  /// Takes up changes that were not saved to the file, which had the text `base` then.
  void restore(const std::string& text, std::optional<std::string> base);

  /// Replaces the text by that of the file, as an edit. Throws DescriptionError.
  void load();

 private:
  const std::filesystem::path file_;
  std::optional<std::string> saved_;  // none: there was no file
  TextHistory history_;
};

}  // namespace skein::command::compose
