#include "receiver.hpp"

#include <pthread.h>

#include <algorithm>
#include <utility>

#include "core/threads/start_thread.hpp"
#include "futex.hpp"

namespace skein::same_host {

/// A thread that leads in the receiver's place. The receiver is there while it has the lead.
class Receiver::Consumer final : public calls::CallerDelivery {
 public:
  explicit Consumer(Receiver& receiver)
      : receiver_(receiver), lead_(receiver.lead_), news_(receiver.news_) {}

  void lend() override {}
  void pause() override {}
  void take_back() override {
    if (lead_->take()) lead_->give_up();
  }
  void deliver_until(const std::function<bool()>& over) override {
    if (!useful || !(lead_->take() || is_given(over))) return;
    if (receiver_.lead(Taker::Who::Consumer, over)) lead_->leave();
  }
  void wake() override {
    call();
    news_->doorbells.call();
  }

  bool wants() const { return wants_; }
  /// By who leads; false where it still does, as the consumer has thought better of it.
  bool give() {
    const std::uint64_t left = lead_->leave();
    if (!wants_.exchange(false)) return !lead_->take_back(left);
    call();
    return true;
  }
  /// The receiver ends.
  void end() {
    useful = false;
    call();
  }

  std::atomic<bool> useful{false};  // there are links, and the receiver does not end

 private:
  // What was given may have been taken by who stands by, where this thread was slow to take it.
  bool is_given(const std::function<bool()>& over) {
    while (true) {
      if (!wants_) {
        wants_ = true;
        news_->doorbells.call();
      }
      called_ = 0;
      if (lead_->take()) {
        wants_ = false;
        return true;
      }
      if (!useful || over()) return !wants_.exchange(false) && lead_->take();
      if (wants_) futex_wait(called_, 0, Instant::max());
    }
  }
  void call() {
    if (called_.exchange(1) == 0) futex_wake(called_);
  }

  Receiver& receiver_;
  const std::shared_ptr<Lead> lead_;
  const std::shared_ptr<ReceiverNews> news_;
  std::atomic<bool> wants_{false};
  Word called_{1};  // 0 while it waits to be given the lead
};

Receiver::Receiver(std::string name, TimeSpan spin, std::shared_ptr<Unfinished> unfinished)
    : name_(std::move(name)),
      spin_limit_(spin),
      unfinished_(std::move(unfinished)),
      news_(std::make_shared<ReceiverNews>()),
      consumer_(std::make_shared<Consumer>(*this)),
      led_(news_, spin) {}

Receiver::~Receiver() {
  stopping_ = true;
  consumer_->end();
  news_->doorbells.call();
  lead_->wake();
  if (thread_.joinable()) thread_.join();
  lead_->end();
}

std::function<void()> Receiver::notifier() const {
  return [news = news_] { news->tell_of_changes(); };
}

std::shared_ptr<calls::CallerDelivery> Receiver::add(std::shared_ptr<Link> link, Inbox& inbox) {
  std::shared_ptr<ReceivedLink> added;
  {
    std::lock_guard lock(mutex_);
    added = std::make_shared<ReceivedLink>(std::move(link), inbox, ++last_id_, spin_limit_,
                                           unfinished_, news_);
    news_->doorbells.add(added->link->doorbells().in, added->id);
    try {
      if (!thread_.joinable()) thread_ = start_thread(name_, [this] { run(); });
    } catch (...) {
      news_->doorbells.remove(added->link->doorbells().in);
      throw;
    }
    links_.push_back(added);
    added_.push_back(added);
    consumer_->useful = true;
  }
  news_->tell_of_changes();
  return added;
}

std::shared_ptr<calls::CallerDelivery> Receiver::delivery() const { return consumer_; }

void Receiver::remove(Inbox& inbox) {
  LedLinks::Links removed;
  {
    std::lock_guard lock(mutex_);
    const auto first = std::stable_partition(
        links_.begin(), links_.end(), [&](const auto& each) { return &each->inbox != &inbox; });
    removed.assign(first, links_.end());
    links_.erase(first, links_.end());
    if (links_.empty()) consumer_->useful = false;
  }
  for (const auto& each : removed) news_->doorbells.remove(each->link->doorbells().in);
  Wakes wakes;
  for (const auto& each : removed) {
    each->remove();
    each->link->out().wake_peer(wakes);
  }
  news_->tell_of_changes();
}

std::size_t Receiver::links() const {
  std::lock_guard lock(mutex_);
  return links_.size();
}

void Receiver::run() {
  pthread_setname_np(pthread_self(), name_.c_str());
  bool leads = lead_->take();
  while (!stopping_) {
    if (!leads) {
      leads = lead_->stand_by([this] { return stopping_.load(); });
    } else {
      lead(Taker::Who::Receiver, [this] { return consumer_->wants(); });
      leads = stopping_ || !consumer_->give();
    }
  }
  if (leads) lead_->leave();
}

// By who has the lead, until `over`, which a call() at the doorbells makes it look at, or the
// receiver ends. False if the receiver has stood in; it may be gone then.
bool Receiver::lead(Taker::Who who, const std::function<bool()>& over) {
  Taker taker(who, lead_.get(), [this] { led_.wake_peers(); });
  led_.begin();
  while (true) {
    news_->doorbells.forget_call();
    if (news_->changed && news_->changed.exchange(false)) take_in_changes();
    if (stopping_ || over()) break;
    const auto looked = led_.look(taker);
    if (looked == ReceivedLink::Looked::Replaced) return false;
    if (looked == ReceivedLink::Looked::Something) continue;
    // Clients that have been let sleep sleep on while there are requests of others.
    if (taker.sleepers.any() && !taker.sleepers.due() && led_.listen()) continue;
    taker.wake();
    led_.await();
  }
  taker.wake();
  return true;
}

// What was new, has ended, or was taken back.
void Receiver::take_in_changes() {
  LedLinks::Links added;
  LedLinks::Links ended;  // may be the last to hold their links: not under the lock
  {
    std::lock_guard lock(mutex_);
    added.swap(added_);
    const auto first = std::stable_partition(links_.begin(), links_.end(),
                                             [](const auto& each) { return !each->over(); });
    ended.assign(first, links_.end());
    links_.erase(first, links_.end());
    if (links_.empty()) consumer_->useful = false;
  }
  for (const auto& each : ended) news_->doorbells.remove(each->link->doorbells().in);
  led_.take_in(added);
}

}  // namespace skein::same_host
