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

  /// `label` says what was done. An edit with the `key` of the one before becomes one with it, so
  /// that what a person types is undone at once; one without a key never does.
  void edit(const std::string& label, const std::string& key, const profile::Splice& splice);
  /// The next edit is one of its own.
  void seal() { sealed_ = true; }

  /// The edit that undo() and redo() would change; empty: there is none, and they do nothing.
  std::string undo_label() const { return done_ == 0 ? "" : edits_[done_ - 1].label; }
  std::string redo_label() const { return done_ == edits_.size() ? "" : edits_[done_].label; }
  void undo();
  void redo();

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
};

}  // namespace skein::command::compose
