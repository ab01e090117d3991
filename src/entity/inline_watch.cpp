#include "inline_watch.hpp"

#include <algorithm>
#include <optional>

namespace skein::entity {

InlineWatch::Watched::Watched(InlineWatch& watch, Worker& worker, Instant deadline,
                              std::size_t most, const std::function<void()>& lost)
    : watch_(watch), worker_(worker), deadline_(deadline), lost_(lost) {
  worker_.expose();
  admitted_ = watch_.admit(*this, most);
}

InlineWatch::Watched::~Watched() {
  worker_.cover();
  if (admitted_) watch_.dismiss(*this);
}

bool InlineWatch::admit(Watched& work, std::size_t most) {
  {
    std::lock_guard lock(mutex_);
    if (works_.size() + lost_ >= most) return false;
    works_.push_back(&work);
    if (!timers_.empty() && timers_.begin()->first <= work.deadline_) return true;
    timers_[work.deadline_] = 0;
  }
  arm(work.deadline_);
  return true;
}

void InlineWatch::dismiss(Watched& work) {
  std::lock_guard lock(mutex_);
  std::erase(works_, &work);
}

void InlineWatch::arm(Instant when) {
  const TimerId timer = clock_.call_at(when, [watch = weak_from_this(), when] {
    const auto self = watch.lock();
    if (!self) return;
    self->control_.post_or_run([watch, when] {
      if (const auto self = watch.lock()) self->expire(when);
    });
  });
  std::lock_guard lock(mutex_);
  if (const auto set = timers_.find(when); set != timers_.end()) set->second = timer;
}

void InlineWatch::expire(Instant timer) {
  std::lock_guard one_at_a_time(expiring_);
  if (closed_) return;
  for (Watched* work : take_overdue(timer)) {
    work->lost_();
  }
}

// Those that are lost; their threads touch nothing any more.
std::vector<InlineWatch::Watched*> InlineWatch::take_overdue(Instant timer) {
  std::vector<Watched*> lost;
  std::optional<Instant> next;
  {
    std::lock_guard lock(mutex_);
    timers_.erase(timer);
    const Instant now = clock_.now();
    std::erase_if(works_, [&](Watched* work) {
      if (work->deadline_ > now) {
        next = std::min(next.value_or(work->deadline_), work->deadline_);
        return false;
      }
      if (work->worker_.write_off()) lost.push_back(work);
      return true;  // it is on its way back otherwise
    });
    lost_ += lost.size();
    if (next && !timers_.empty() && timers_.begin()->first <= *next) next.reset();
    if (next) timers_[*next] = 0;
  }
  if (next) arm(*next);
  return lost;
}

void InlineWatch::close() {
  std::map<Instant, TimerId> timers;
  {
    std::lock_guard one_at_a_time(expiring_);
    closed_ = true;
    std::lock_guard lock(mutex_);
    timers.swap(timers_);
  }
  for (const auto& [when, timer] : timers) clock_.cancel(timer);
}

}  // namespace skein::entity
