#include "led_links.hpp"

#include <algorithm>
#include <utility>

namespace skein::same_host {
namespace {

// A busy thread listens to the doorbells of other links, which takes a system call, once after so
// many turns; one that spins after so many looks.
constexpr int kTurnsUnheard = 8;
constexpr int kLooksUnheard = 16;
// If a caller pauses this long, the leader takes back its messages; after twice that at most.
constexpr std::chrono::milliseconds kPaused{20};

}  // namespace

void LedLinks::begin() {
  wake_peers();  // clients that the previous leader has let sleep
  if (turns_ > 0) listen();
}

void LedLinks::take_in(const Links& added) {
  for (const auto& link : added) {
    all_.emplace(link->id, link);
    attend(link);
  }
  std::erase_if(attended_, [](const auto& link) { return link->over(); });
  std::erase_if(all_, [](const auto& each) { return each.second->over(); });
  for (const auto& [id, link] : all_) {
    if (link->has_something()) attend(link);
  }
}

void LedLinks::attend(const std::shared_ptr<ReceivedLink>& link) {
  if (!std::exchange(link->attended, true)) attended_.push_back(link);
}

bool LedLinks::attend_rung(std::optional<std::chrono::milliseconds> longest) {
  turns_ = 0;
  const auto rung = news_->doorbells.wait(longest);
  for (const std::uint64_t id : rung) {
    if (const auto found = all_.find(id); found != all_.end()) attend(found->second);
  }
  return !rung.empty();
}

ReceivedLink::Looked LedLinks::look(Taker& taker) {
  using Looked = ReceivedLink::Looked;
  const auto next = [&](std::size_t from) {
    while (from < attended_.size() && !attended_[from]->has_something()) ++from;
    return from;
  };
  Looked all = Looked::Nothing;
  for (std::size_t i = next(0); i < attended_.size();) {
    const std::size_t after = next(i + 1);
    taker.others_wait = after < attended_.size();
    const Looked looked = attended_[i]->look(spare_, taker);
    if (looked == Looked::Replaced) return looked;
    if (looked == Looked::Something) {
      all = looked;
      ++turns_;
    }
    if (taker.sleepers.due()) taker.wake();  // even if no whole message has come
    i = after;
  }
  if (all == Looked::Something && turns_ >= kTurnsUnheard) listen();
  return all;
}

void LedLinks::wake_peers() const {
  Wakes wakes;
  for (const auto& each : attended_) each->link->out().wake_peer(wakes);
}

void LedLinks::await() {
  const bool spins = spin_.limit() > Duration::zero();
  const Instant begin = spins ? std::chrono::steady_clock::now() : Instant();
  const Instant give_up = saturating_sum(begin, spin_.budget());
  const auto has_something = [](const auto& link) { return link->has_something(); };
  bool come = false;
  for (int i = 1; !come && spin_.budget() > Duration::zero(); ++i) {
    if (std::chrono::steady_clock::now() >= give_up) break;
    if (i % kLooksUnheard == 0) listen();
    come = news_->doorbells.called() || std::ranges::any_of(attended_, has_something);
  }
  if (!come && may_sleep()) sleep();
  if (spins) spin_.note(std::chrono::steady_clock::now() - begin);
}

void LedLinks::sleep() {
  if (!news_->paused) {
    attend_rung({});
    return;
  }
  const Instant now = std::chrono::steady_clock::now();
  if (look_at_paused_ == Instant::max()) look_at_paused_ = now + kPaused;
  if (now < look_at_paused_) {
    attend_rung(std::chrono::ceil<std::chrono::milliseconds>(look_at_paused_ - now));
  } else {
    take_back_paused();
  }
}

// From callers that have not come back since this was looked at before.
void LedLinks::take_back_paused() {
  look_at_paused_ = Instant::max();
  news_->paused = false;
  for (const auto& [id, link] : all_) {
    const std::uint32_t pauses = link->pauses();
    if (pauses % 2 == 0) continue;
    if (std::exchange(link->pauses_seen, pauses) != pauses) {
      news_->paused = true;
    } else if (link->link->in().ring().take_back()) {
      attend(link);
    }
  }
}

// From now on the doorbells of all links ring that bring something; unless one has already.
bool LedLinks::may_sleep() {
  std::erase_if(attended_, [](const auto& each) {
    each->attended = each->has_something() || !each->link->in().ring().prepare_to_sleep();
    return !each->attended;
  });
  return attended_.empty();
}

}  // namespace skein::same_host
