#include "register.hpp"

#include <utility>

namespace skein::topics {

Register::Entry::Entry(Register* known, Report report) : known_(known) {
  if (!known_) return;
  std::lock_guard lock(known_->mutex_);
  number_ = ++known_->last_;
  known_->reports_.emplace(number_, std::move(report));
}

Register::Entry::~Entry() {
  if (!known_) return;
  std::lock_guard lock(known_->mutex_);
  known_->reports_.erase(number_);
}

std::vector<Endpoint> Register::endpoints() const {
  std::vector<Endpoint> all;
  std::lock_guard lock(mutex_);
  for (const auto& [number, report] : reports_) all.push_back(report());
  return all;
}

}  // namespace skein::topics
