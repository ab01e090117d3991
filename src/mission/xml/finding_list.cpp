#include "finding_list.hpp"

namespace skein::profile {

void FindingList::error(const SourcePosition& where, std::string problem, std::string remedy) {
  add({Severity::Error, where, std::move(problem), std::move(remedy)});
}

void FindingList::warning(const SourcePosition& where, std::string problem, std::string remedy) {
  add({Severity::Warning, where, std::move(problem), std::move(remedy)});
}

void FindingList::add(Finding finding) {
  if (full() || !seen_.insert(to_text(finding)).second) return;
  list_.push_back(std::move(finding));
  if (list_.size() + 1 == kMax) {
    list_.push_back({Severity::Error,
                     {list_.back().where.file, 0, 0},
                     "more findings than are shown",
                     "mend these first"});
  }
}

void FindingList::add_all(const std::vector<Finding>& findings) {
  for (const auto& finding : findings) add(finding);
}

void FindingList::throw_if_errors() const {
  if (has_errors(list_)) throw DescriptionError(list_);
}

}  // namespace skein::profile
