#include "admissions.hpp"

#include <optional>
#include <utility>

namespace skein::rpc {

bool Admissions::add(Newcomer newcomer, const Admit& admit) {
  {
    std::lock_guard lock(mutex_);
    if (!waiting_.push(std::move(newcomer))) return false;
    if (std::exchange(looking_, true)) return true;
  }
  look_later(admit);
  return true;
}

void Admissions::note_left(const Guid& client) {
  std::lock_guard lock(mutex_);
  waiting_.note_left(client);
}

void Admissions::look_later(const Admit& admit) {
  const bool posted = control_.post([admissions = weak_from_this(), admit] {
    if (const auto self = admissions.lock()) self->look(admit);
  });
  if (posted) return;
  std::lock_guard lock(mutex_);
  looking_ = false;
}

// Whatever one that has left asked for, a session would be nobody's.
void Admissions::look(const Admit& admit) {
  std::optional<Newcomer> next;
  {
    std::lock_guard lock(mutex_);
    next = waiting_.pop();
    if (!next) looking_ = false;
  }
  if (!next) return;
  if (!next->left) admit(*next);
  look_later(admit);
}

}  // namespace skein::rpc
