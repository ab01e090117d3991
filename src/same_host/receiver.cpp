#include "receiver.hpp"

#include <pthread.h>

#include <algorithm>
#include <utility>

#include "core/log.hpp"
#include "core/start_thread.hpp"

namespace skein::same_host {
namespace {

// Then the others have their turn.
constexpr int kMessagesInARow = 16;
// More than a ring holds: who goes on after the end is not listened to.
constexpr int kTurnsAfterEnd = 2048;
// What comes to a link that callers have left is heard of this late at most.
constexpr std::chrono::milliseconds kLent{20};
// Who is away for longer is stood in for, and for twice as long at most before that.
constexpr std::chrono::milliseconds kLate{10};
// Then who stands by sleeps until somebody leaves his turn again.
constexpr int kLooksInVain = 100;

}  // namespace

void SpinPolicy::note(Duration waited) {
  score_ = waited <= limit_ ? std::min(score_ + 1, kMost) : std::max(score_ - 4, 0);
}

/// A turn whose link is locked.
class Receiver::OwnTurn final : public Turn {
 public:
  OwnTurn(Receiver& receiver, Who who, Link& link, Bytes& spare, std::unique_lock<std::mutex>& lock)
      : receiver_(receiver), who_(who), link_(link), spare_(spare), lock_(lock) {}

  bool leave() override {
    if (left()) return true;
    if (who_ != Who::Leader || !receiver_.has_stand_in()) return false;
    link_.release(spare_);
    lock_.unlock();
    away_ = receiver_.go_away();
    return true;
  }
  bool left() const { return away_ != 0; }
  bool come_back() { return receiver_.come_back(away_); }

 private:
  Receiver& receiver_;
  const Who who_;
  Link& link_;
  Bytes& spare_;
  std::unique_lock<std::mutex>& lock_;
  std::uint64_t away_ = 0;
};

class Receiver::Entry final : public dds::CallerDelivery {
 public:
  Entry(Receiver& receiver_, std::shared_ptr<Link> link_, Inbox& inbox_)
      : link(std::move(link_)), inbox(inbox_), receiver(receiver_), spin(receiver_.spin_limit_) {}

  void lend() override {
    if (!used) used = true;
    if (!lent) lent = true;
  }
  void take_back() override {
    if (lent && lent.exchange(false)) notify();
  }
  void deliver_until(const std::function<bool()>& over_) override;
  void wake() override {
    called = 1;
    if (sleeps) futex_wake(called);
  }

  const std::shared_ptr<Link> link;
  Inbox& inbox;
  std::mutex mutex;  // held while a function of the inbox runs
  std::atomic<bool> begun{false};
  std::size_t unfinished = 0;  // as others know it; under the mutex
  int turns_after_end = 0;
  // Once it is so, the inbox and the receiver may be gone.
  std::atomic<bool> over{false};
  std::atomic<bool> lent{false};
  std::atomic<bool> used{false};        // since the receiver's thread last looked
  std::atomic<bool> has_caller{false};  // which is in deliver_until()

 private:
  void sleep(const std::function<bool()>& over_);

  Receiver& receiver;
  const std::function<void()> notify = receiver.notifier();
  // The caller's. The word in the ring is the other side's as well: this one it cannot reach.
  SpinPolicy spin;
  Word called{0};
  std::atomic<bool> sleeps{false};
};

void Receiver::Entry::deliver_until(const std::function<bool()>& over_) {
  thread_local Bytes spare;
  if (has_caller.exchange(true)) return take_back();
  while (!over && !over_()) {
    if (receiver.look_at(*this, spare, Who::Caller) == Looked::Nothing) sleep(over_);
  }
  has_caller = false;
  if (over) take_back();
}

void Receiver::Entry::sleep(const std::function<bool()>& over_) {
  called = 0;
  if (over || over_()) return;
  RingReader& in = link->in();
  const bool may_spin = spin.limit() > Duration::zero();
  const Instant begin = may_spin ? std::chrono::steady_clock::now() : Instant();
  const Instant give_up = begin + spin.budget();
  bool come = false;
  while (!come && spin.budget() > Duration::zero() && std::chrono::steady_clock::now() < give_up) {
    come = in.ready() || called != 0;
  }
  if (!come) {
    sleeps = true;
    const bool idle = in.prepare_to_sleep(RingReader::Who::Caller);
    if (idle && !over && !over_()) {
      futex_waitv words[] = {while_it_is(called, 0),
                             while_it_is(in.word(RingReader::Who::Caller), 1)};
      futex_wait(words);
    }
    in.stay_awake(RingReader::Who::Caller);
    sleeps = false;
  }
  if (may_spin) spin.note(std::chrono::steady_clock::now() - begin);
}

Receiver::Receiver(std::string name, Duration spin, std::shared_ptr<Unfinished> unfinished)
    : name_(std::move(name)), spin_limit_(spin), unfinished_(std::move(unfinished)), spin_(spin) {}

Receiver::~Receiver() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  notify();
  watched_ = 1;
  futex_wake(watched_);
  if (thread_.joinable()) thread_.join();
  // The first one alone starts it.
  if (stand_in_.joinable()) stand_in_.join();
}

std::function<void()> Receiver::notifier() const {
  return [notified = notified_] {
    if (notified->exchange(1) == 0) futex_wake(*notified);
  };
}

void Receiver::notify() const { notifier()(); }

std::shared_ptr<dds::CallerDelivery> Receiver::add(std::shared_ptr<Link> link, Inbox& inbox) {
  const auto entry = std::make_shared<Entry>(*this, std::move(link), inbox);
  {
    std::lock_guard lock(mutex_);
    if (entries_.size() >= kMostLinks) {
      throw Unavailable("this entity has " + std::to_string(kMostLinks) +
                        " connections through shared memory already");
    }
    if (!thread_.joinable()) thread_ = start_thread(name_, [this] { run(true); });
    entries_.push_back(entry);
  }
  notify();
  return entry;
}

void Receiver::remove(Inbox& inbox) {
  Entries removed;
  {
    std::lock_guard lock(mutex_);
    const auto first = std::stable_partition(
        entries_.begin(), entries_.end(), [&](const auto& each) { return &each->inbox != &inbox; });
    removed.assign(first, entries_.end());
    entries_.erase(first, entries_.end());
  }
  for (const auto& entry : removed) {
    {
      std::lock_guard lock(entry->mutex);
      entry->over = true;
      unfinished_->change(std::exchange(entry->unfinished, 0), 0);
    }
    entry->wake();
  }
  notify();
}

std::size_t Receiver::links() const {
  std::lock_guard lock(mutex_);
  return entries_.size();
}

void Receiver::run(bool leads) {
  pthread_setname_np(pthread_self(), name_.c_str());
  for (; !is_stopping(); leads = !leads) {
    if (leads) {
      lead();
    } else {
      stand_by();
    }
  }
}

bool Receiver::is_stopping() const {
  std::lock_guard lock(mutex_);
  return stopping_;
}

// Until the receiver ends, or somebody has stood in.
void Receiver::lead() {
  while (true) {
    notified_->store(0);
    Entries entries;
    {
      std::lock_guard lock(mutex_);
      if (stopping_) return;
      entries = entries_;
    }
    while (notified_->load() == 0) {
      const Looked looked = look_at_all(entries);
      if (looked == Looked::Replaced) return;
      if (looked == Looked::Nothing) await(entries);
    }
    drop_ended();
  }
}

// Until the receiver ends, or who leads has been away for too long.
void Receiver::stand_by() {
  std::uint64_t seen = away_;
  int in_vain = 0;
  while (!is_stopping()) {
    futex_wait(watched_, 1, std::chrono::steady_clock::now() + kLate);
    std::uint64_t now = away_;
    if (now == seen && now % 2 != 0 && away_.compare_exchange_strong(now, now + 1)) return;
    in_vain = now == seen ? in_vain + 1 : 0;
    seen = now;
    if (in_vain < kLooksInVain) continue;
    watched_ = 0;
    if (away_ == seen && !is_stopping()) futex_wait(watched_, 0, Instant::max());
    watched_ = 1;
    in_vain = 0;
  }
}

bool Receiver::has_stand_in() {
  if (has_stand_in_) return true;
  std::lock_guard lock(mutex_);
  if (stopping_) return false;
  try {
    stand_in_ = start_thread(name_, [this] { run(false); });
  } catch (const Error&) {
    return false;
  }
  has_stand_in_ = true;
  return true;
}

// Returns what come_back() has to be told.
std::uint64_t Receiver::go_away() {
  const std::uint64_t away = ++away_;
  if (watched_ == 0 && watched_.exchange(1) == 0) futex_wake(watched_);
  return away;
}

// False where somebody has stood in.
bool Receiver::come_back(std::uint64_t away) {
  return away_.compare_exchange_strong(away, away + 1);
}

Receiver::Looked Receiver::look_at_all(const Entries& entries) {
  Looked all = Looked::Nothing;
  for (const auto& entry : entries) {
    if (entry->lent && entry->begun && !entry->link->ended()) continue;
    const Looked looked = look_at(*entry, spare_, Who::Leader);
    if (looked == Looked::Replaced) return looked;
    if (looked == Looked::Something) all = looked;
  }
  return all;
}

// On the leading thread, or a caller's.
Receiver::Looked Receiver::look_at(Entry& entry, Bytes& spare, Who who) {
  Link& link = *entry.link;
  if (entry.over || (entry.begun && !link.in().ready() && !link.ended())) return Looked::Nothing;
  std::unique_lock lock(entry.mutex);
  if (entry.over) return Looked::Nothing;
  if (!entry.begun.exchange(true)) entry.inbox.on_begin(link);
  const bool ended = link.ended();  // looked at first: what came before the end is taken
  int taken = 0;
  try {
    for (; taken < kMessagesInARow; ++taken) {
      const auto message = link.receive(spare);
      if (!message) break;
      if (entry.unfinished != 0) unfinished_->change(std::exchange(entry.unfinished, 0), 0);
      OwnTurn turn(*this, who, link, spare, lock);
      entry.inbox.on_message(link, *message, turn);
      if (turn.left()) return turn.come_back() ? Looked::Something : Looked::Replaced;
      link.release(spare);
    }
  } catch (const BrokenRing& error) {
    log(LogLevel::Warning, "same host", error.what());
  }
  const bool drained = taken == 0 && !link.in().ready();
  const bool too_much = brings_too_much(entry);
  if (too_much) link.close();
  if (link.broken() || too_much ||
      (ended && (drained || ++entry.turns_after_end > kTurnsAfterEnd))) {
    entry.inbox.on_end(link);
    link.ending().run();
    entry.over = true;
    unfinished_->change(std::exchange(entry.unfinished, 0), 0);
    entry.wake();
    notify();
  }
  return Looked::Something;
}

bool Receiver::brings_too_much(Entry& entry) {
  const std::size_t now = entry.link->unfinished();
  if (now == entry.unfinished) return false;
  const std::size_t others = unfinished_->change(std::exchange(entry.unfinished, now), now);
  if (now <= unfinished_->most() - std::min(unfinished_->most(), others)) return false;
  log(LogLevel::Warning, "same host",
      "a connection is ended: of a message without its end " + std::to_string(now) +
          " octets have come, and of others' " + std::to_string(others) +
          "; all together may have " + std::to_string(unfinished_->most()));
  return true;
}

void Receiver::drop_ended() {
  std::lock_guard lock(mutex_);
  std::erase_if(entries_, [](const auto& entry) { return entry->over.load(); });
}

void Receiver::await(const Entries& entries) {
  const auto ready = [&] {
    return notified_->load() != 0 || std::ranges::any_of(entries, [](const auto& entry) {
             return !entry->over && !entry->lent && entry->link->in().ready();
           });
  };
  const Instant begin =
      spin_limit_ > Duration::zero() ? std::chrono::steady_clock::now() : Instant();
  const Instant give_up = begin + spin_.budget();
  bool come = false;
  while (!come && spin_.budget() > Duration::zero() && std::chrono::steady_clock::now() < give_up) {
    come = ready();
  }
  if (!come) sleep(entries);
  if (spin_limit_ > Duration::zero()) spin_.note(std::chrono::steady_clock::now() - begin);
}

// Until a link has something, or somebody notifies.
void Receiver::sleep(const Entries& entries) {
  futex_waitv words[kMostWords];
  std::size_t count = 0;
  words[count++] = while_it_is(*notified_, 0);
  bool idle = true;
  bool any_lent = false;
  for (const auto& entry : entries) {
    if (entry->over) continue;
    if (entry->lent) {
      any_lent = true;
      continue;
    }
    idle = entry->link->in().prepare_to_sleep() && idle;
    words[count++] = while_it_is(entry->link->in().word(), 1);
  }
  if (!any_lent) {
    look_at_lent_ = Instant::max();
  } else if (look_at_lent_ == Instant::max()) {
    look_at_lent_ = std::chrono::steady_clock::now() + kLent;
  }
  if (idle) futex_wait(std::span(words, count), look_at_lent_);
  for (const auto& entry : entries) {
    if (!entry->over) entry->link->in().stay_awake();
  }
  if (any_lent && std::chrono::steady_clock::now() >= look_at_lent_) take_back_unused(entries);
}

void Receiver::take_back_unused(const Entries& entries) {
  look_at_lent_ = Instant::max();
  for (const auto& entry : entries) {
    if (!entry->used.exchange(false) && !entry->has_caller) entry->lent = false;
  }
}

// ---- several

std::function<void()> Receivers::notifier() const {
  return [notifiers = notifiers_] {
    std::lock_guard lock(notifiers->mutex);
    for (const auto& notify : notifiers->all) notify();
  };
}

std::shared_ptr<dds::CallerDelivery> Receivers::add(std::shared_ptr<Link> link, Inbox& inbox) {
  std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(
      all_, [](const auto& each) { return each->links() < Receiver::kMostLinks; });
  if (found != all_.end()) return (*found)->add(std::move(link), inbox);
  auto added = std::make_unique<Receiver>(name_, spin_, unfinished_);
  {
    std::lock_guard notifying(notifiers_->mutex);
    notifiers_->all.push_back(added->notifier());
  }
  return all_.emplace_back(std::move(added))->add(std::move(link), inbox);
}

// Unlocked: a function of the inbox that is waited for may add another one's link.
void Receivers::remove(Inbox& inbox) {
  std::vector<Receiver*> all;
  {
    std::lock_guard lock(mutex_);
    for (const auto& each : all_) all.push_back(each.get());
  }
  for (Receiver* const each : all) each->remove(inbox);
}

}  // namespace skein::same_host
