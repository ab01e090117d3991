#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mission/xml/xml_source.hpp"

namespace skein::command::compose {

/// A text with all edits that have made it, each of which can be undone and done again. A plain
/// value.
class TextHistory {
 public:
  explicit TextHistory(std::string text) : text_(std::move(text)) {}

  const std::string& text() const noexcept { return text_; }

  /// `label` names the edit for people. Successive edits with one `key` become one edit, so that
  /// one undo takes back a whole word; edits with an empty key stay apart.
  void edit(const std::string& label, const std::string& key, const profile::Splice& splice);
  /// The next edit is one of its own.
  void seal() { sealed_ = true; }

  /// The splice that has led to the present text; empty: the text is the first one.
  const profile::Splice& last_change() const noexcept { return last_change_; }

  /// The edit that undo() and redo() would change; empty: there is none.
  std::string undo_label() const { return done_ == 0 ? "" : edits_[done_ - 1].label; }
  std::string redo_label() const { return done_ == edits_.size() ? "" : edits_[done_].label; }
  /// Return the label. Nothing happens without one.
  std::string undo();
  std::string redo();

 private:
  struct Edit {
    std::string label;
    std::string key;
    std::size_t at;
    std::string removed;
    std::string inserted;
  };

  std::string text_;
  std::vector<Edit> edits_;
  std::size_t done_ = 0;  // so many of them are in the text
  bool sealed_ = false;
  profile::Splice last_change_;
};

}  // namespace skein::command::compose
