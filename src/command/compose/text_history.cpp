#include "text_history.hpp"

namespace skein::command::compose {

void TextHistory::edit(const std::string& label, const std::string& key,
                       const profile::Splice& splice) {
  if (splice.removed == 0 && splice.inserted.empty()) return;
  profile::Splice whole = splice;
  std::string after = profile::spliced(text_, splice);
  const bool one_more =
      !sealed_ && !key.empty() && done_ > 0 && done_ == edits_.size() && edits_.back().key == key;
  if (one_more) {
    undo();
    whole = profile::difference(text_, after);
  }
  edits_.resize(done_);
  last_change_ = splice;
  if (whole.removed == 0 && whole.inserted.empty()) {  // typed, and taken back
    text_ = std::move(after);
    return;
  }
  edits_.push_back({label, key, whole.at, text_.substr(whole.at, whole.removed), whole.inserted});
  text_ = std::move(after);
  done_ = edits_.size();
  sealed_ = false;
}

std::string TextHistory::undo() {
  std::string label = undo_label();
  if (label.empty()) return label;
  const Edit& edit = edits_[--done_];
  text_.replace(edit.at, edit.inserted.size(), edit.removed);
  last_change_ = {edit.at, edit.inserted.size(), edit.removed};
  sealed_ = true;
  return label;
}

std::string TextHistory::redo() {
  std::string label = redo_label();
  if (label.empty()) return label;
  const Edit& edit = edits_[done_++];
  text_.replace(edit.at, edit.removed.size(), edit.inserted);
  last_change_ = {edit.at, edit.removed.size(), edit.inserted};
  sealed_ = true;
  return label;
}

}  // namespace skein::command::compose
