#include "observers.hpp"

#include <utility>

namespace skein::brokerless_discovery {

std::shared_ptr<Observers::Observer> Observers::add(std::function<void(const Change&)> observer) {
  auto added = std::make_shared<Observer>(std::move(observer));
  std::lock_guard lock(mutex_);
  observers_.push_back(added);
  return added;
}

void Observers::remove(const std::shared_ptr<Observer>& observer) {
  {
    std::lock_guard lock(mutex_);
    std::erase(observers_, observer);
  }
  std::lock_guard lock(observer->telling);
  observer->gone = true;
}

void Observers::note(const Table::Changes& changes) {
  std::lock_guard lock(mutex_);
  if (!observers_.empty()) untold_.insert(untold_.end(), changes.begin(), changes.end());
}

// One task for all changes that wait: a flood of them does not fill the executor, where one that
// finds no room would be lost.
void Observers::tell_later() {
  {
    std::lock_guard lock(mutex_);
    if (untold_.empty() || std::exchange(telling_, true)) return;
  }
  const bool posted = control_.post([this, owner = owner_] {
    if (const auto kept = owner.lock()) tell();
  });
  if (posted) return;
  std::lock_guard lock(mutex_);
  telling_ = false;  // the next change tries again
}

void Observers::tell() {
  std::vector<std::shared_ptr<Observer>> told;
  Table::Changes changes;
  {
    std::lock_guard lock(mutex_);
    told = observers_;
    changes.swap(untold_);
    telling_ = false;
  }
  for (const Change& change : changes) {
    for (const auto& observer : told) {
      std::lock_guard lock(observer->telling);
      if (!observer->gone) observer->tell(change);
    }
  }
}

}  // namespace skein::brokerless_discovery
