#include "receiver.hpp"

#include <pthread.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/log.hpp"
#include "core/threads/start_thread.hpp"

namespace skein::same_host {
namespace {

// Then the others have their turn.
constexpr int kMessagesInARow = 16;
// More than a ring holds: who goes on after the end is not listened to.
constexpr int kTurnsAfterEnd = 2048;
// How often it is looked whether callers have left a link: what comes there is heard of after twice
// that, at the latest.
constexpr std::chrono::milliseconds kLent{20};
// Sleeping for so many links costs little.
constexpr std::size_t kFewLinks = 8;
// Of more than these a link that has brought nothing while its thread has slept so often is left to
// QuietLinks: by then its share of those sleeps has cost about what that does.
constexpr int kSleepsInVain = 1000;
constexpr std::size_t kMostLinks = kMostWords - 1;

}  // namespace

void SpinPolicy::note(Duration waited) {
  score_ = waited <= limit_ ? std::min(score_ + 1, kMost) : std::max(score_ - 4, 0);
}

/// A thread that takes messages: one that leads, or a caller.
struct Receiver::Taker {
  Taker(Who who_, Lead* lead_) : who(who_), lead(lead_) {}

  const Who who;
  Lead* const lead;        ///< Null for a caller.
  std::uint64_t left = 0;  ///< Not 0: this one's is left, and what Lead::leave() has said.
  Sleepers sleepers{[this] { return left != 0 && !lead->is_left(left); }};
  bool others_wait = false;  ///< Whether links have something whose turn comes after this one.
};

/// A turn whose link is locked.
class Receiver::OwnTurn final : public Turn {
 public:
  OwnTurn(Receiver& receiver, Taker& taker, Link& link, Bytes& spare,
          std::unique_lock<std::mutex>& lock)
      : receiver_(receiver), taker_(taker), link_(link), spare_(spare), lock_(lock) {
    if (taker.who != Who::Caller) answering_.emplace(link, taker.sleepers, taker.others_wait);
  }

  // Of a consumer the receiver itself is the stand-in.
  bool leave() override {
    if (left()) return true;
    if (taker_.who == Who::Caller) return false;
    if (taker_.who == Who::Leader && !receiver_.has_stand_in()) return false;
    link_.release(spare_);
    lock_.unlock();
    taker_.left = taker_.lead->leave();
    return true;
  }
  bool left() const { return taker_.left != 0; }
  bool come_back() { return taker_.lead->take_back(std::exchange(taker_.left, 0)); }

 private:
  Receiver& receiver_;  // gone, perhaps, once a consumer has left its turn
  Taker& taker_;
  Link& link_;
  Bytes& spare_;
  std::unique_lock<std::mutex>& lock_;
  std::optional<Link::Answering> answering_;
};

// Once it is over, the inbox and the receiver may be gone.
class Receiver::Entry final : public dds::CallerDelivery, public WatchedLink {
 public:
  Entry(Receiver& receiver_, std::shared_ptr<Link> link_, Inbox& inbox_)
      : WatchedLink(std::move(link_)),
        inbox(inbox_),
        receiver(receiver_),
        spin(receiver_.spin_limit_) {}

  void lend() override {
    if (!used) used = true;
    if (!lent) lent = true;
  }
  void take_back() override {
    if (lent && lent.exchange(false)) notify();
  }
  // Who unwound from it would leave the call's result to be written where it was.
  void deliver_until(const std::function<bool()>& over_) noexcept override;
  void wake() override {
    called = 1;
    if (sleeps) futex_wake(called);
  }

  /// For who leads.
  bool has_something() const {
    if (over || (lent && begun && !link->ended())) return false;
    return !begun || link->in().ready() || link->ended();
  }

  Inbox& inbox;
  std::mutex mutex;  // held while a function of the inbox runs
  std::atomic<bool> begun{false};
  std::size_t unfinished = 0;  // as others know it; under the mutex
  int turns_after_end = 0;
  int sleeps_in_vain = 0;  // of who leads, since it has brought something
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

void Receiver::Entry::deliver_until(const std::function<bool()>& over_) noexcept {
  thread_local Bytes spare;
  Taker taker(Who::Caller, nullptr);
  if (has_caller.exchange(true)) return take_back();
  while (!over && !over_()) {
    if (receiver.look_at(*this, spare, taker) == Looked::Nothing) sleep(over_);
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
  const Instant give_up = saturating_sum(begin, spin.budget());
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

/// A thread that leads in the receiver's place. The receiver is there while it has the lead.
class Receiver::Consumer final : public dds::CallerDelivery {
 public:
  explicit Consumer(Receiver& receiver)
      : receiver_(receiver), lead_(receiver.lead_), notify_(receiver.notifier()) {}

  void lend() override {}
  void take_back() override {
    if (lead_->take()) lead_->give_up();
  }
  void deliver_until(const std::function<bool()>& over) override {
    if (!useful || !(lead_->take() || is_given(over))) return;
    if (receiver_.lead(Who::Consumer, over)) lead_->leave();
  }
  void wake() override {
    call();
    notify_();
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
        notify_();
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
  const std::function<void()> notify_;
  std::atomic<bool> wants_{false};
  Word called_{1};  // 0 while it waits to be given the lead
};

Receiver::Receiver(std::string name, TimeSpan spin, std::shared_ptr<Unfinished> unfinished)
    : name_(std::move(name)),
      spin_limit_(spin),
      unfinished_(std::move(unfinished)),
      quiet_(name_, notifier()),
      consumer_(std::make_shared<Consumer>(*this)),
      spin_(spin) {}

Receiver::~Receiver() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  consumer_->end();
  notify();
  lead_->wake();
  if (thread_.joinable()) thread_.join();
  // The first one alone starts it.
  if (stand_in_.joinable()) stand_in_.join();
  lead_->end();
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
    if (entries_.size() >= kFewLinks) quiet_.reserve(entries_.size() + 1 - kFewLinks);
    if (!thread_.joinable()) thread_ = start_thread(name_, [this] { run(true); });
    entries_.push_back(entry);
    consumer_->useful = true;
  }
  notify();
  return entry;
}

std::shared_ptr<dds::CallerDelivery> Receiver::delivery() const { return consumer_; }

void Receiver::remove(Inbox& inbox) {
  Entries removed;
  {
    std::lock_guard lock(mutex_);
    const auto first = std::stable_partition(
        entries_.begin(), entries_.end(), [&](const auto& each) { return &each->inbox != &inbox; });
    removed.assign(first, entries_.end());
    entries_.erase(first, entries_.end());
    if (entries_.empty()) consumer_->useful = false;
  }
  Wakes wakes;
  for (const auto& entry : removed) {
    {
      std::lock_guard lock(entry->mutex);
      entry->over = true;
      unfinished_->change(std::exchange(entry->unfinished, 0), 0);
    }
    entry->wake();
    entry->link->wake_peer(wakes);
  }
  quiet_.drop_ended();
  notify();
}

std::size_t Receiver::links() const {
  std::lock_guard lock(mutex_);
  return entries_.size();
}

void Receiver::run(bool leads) {
  pthread_setname_np(pthread_self(), name_.c_str());
  leads = leads && lead_->take();
  while (!is_stopping()) {
    if (!leads) {
      leads = lead_->stand_by([this] { return is_stopping(); });
    } else if (!lead(Who::Leader, [this] { return consumer_->wants(); }) || consumer_->give()) {
      leads = false;
    }
  }
  if (leads) lead_->leave();
}

bool Receiver::is_stopping() const {
  std::lock_guard lock(mutex_);
  return stopping_;
}

// By who has the lead, until `over`, which notify() makes it look at, or the receiver ends. False
// where somebody has stood in; a consumer's receiver may be gone then.
bool Receiver::lead(Who who, const std::function<bool()>& over) {
  Taker taker(who, lead_.get());
  while (true) {
    wake_peers();  // also those whom the thread that led before has let sleep
    taker.sleepers.clear();
    notified_->store(0);
    Entries entries;  // at last those before, whose links may end with them: not under the lock
    {
      std::lock_guard lock(mutex_);
      if (stopping_) return true;
      std::ranges::copy_if(entries_, std::back_inserter(entries),
                           [](const auto& entry) { return !entry->quiet || entry->link->ended(); });
    }
    led_.swap(entries);
    entries.clear();
    while (notified_->load() == 0) {
      if (over()) {
        wake(taker.sleepers);
        return true;
      }
      const Looked looked = look_at_all(taker);
      if (looked == Looked::Replaced) return false;
      if (looked == Looked::Nothing) {
        wake(taker.sleepers);
        await();
      }
    }
    drop_ended();
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

Receiver::Looked Receiver::look_at_all(Taker& taker) {
  const auto next = [&](Entries::const_iterator from) {
    return std::find_if(from, led_.cend(),
                        [](const auto& entry) { return entry->has_something(); });
  };
  Looked all = Looked::Nothing;
  for (auto entry = next(led_.cbegin()); entry != led_.cend();) {
    const auto after = next(entry + 1);
    taker.others_wait = after != led_.cend();
    const Looked looked = look_at(**entry, spare_, taker);
    if (looked == Looked::Replaced) return looked;
    if (looked == Looked::Something) {
      all = looked;
      (*entry)->sleeps_in_vain = 0;
    }
    if (taker.sleepers.due()) wake(taker.sleepers);  // also where no whole message has come
    entry = after;
  }
  return all;
}

// On the thread that leads, or a caller's.
Receiver::Looked Receiver::look_at(Entry& entry, Bytes& spare, Taker& taker) {
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
      OwnTurn turn(*this, taker, link, spare, lock);
      entry.inbox.on_message(link, *message, turn);
      const bool left = turn.left();
      if (left && !turn.come_back()) return Looked::Replaced;
      if (taker.sleepers.due()) wake(taker.sleepers);
      if (left) return Looked::Something;
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
    unfinished_->change(std::exchange(entry.unfinished, 0), 0);
    const auto tell = notifier();
    entry.over = true;  // from now on the receiver may be gone, where this is a caller
    entry.wake();
    tell();
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
  {
    std::lock_guard lock(mutex_);
    const std::size_t ended =
        std::erase_if(entries_, [](const auto& entry) { return entry->over.load(); });
    if (ended == 0) return;
    if (entries_.empty()) consumer_->useful = false;
  }
  quiet_.drop_ended();
}

// To QuietLinks: those that bring little, and the latest where they are more than one thread can
// wait for.
void Receiver::leave_quiet_ones() {
  const auto is_waited_for = [](const auto& entry) { return !entry->lent && !entry->over; };
  if (led_.size() <= kFewLinks) return;
  if (std::ranges::count_if(led_, is_waited_for) <= std::ptrdiff_t{kFewLinks}) return;
  std::size_t kept = 0;
  std::erase_if(led_, [&](const auto& entry) {
    if (!is_waited_for(entry) || !entry->begun || entry->link->ended()) return false;
    const bool is_quiet = ++entry->sleeps_in_vain >= kSleepsInVain;
    if (!is_quiet && kept++ < kMostLinks) return false;
    entry->sleeps_in_vain = 0;
    return quiet_.add(entry);
  });
}

void Receiver::wake(Sleepers& sleepers) const {
  if (!sleepers.any()) return;
  sleepers.clear();
  wake_peers();
}

void Receiver::wake_peers() const {
  Wakes wakes;
  for (const auto& entry : led_) entry->link->wake_peer(wakes);
}

void Receiver::await() {
  leave_quiet_ones();
  const auto ready = [&] {
    return notified_->load() != 0 || std::ranges::any_of(led_, [](const auto& entry) {
             return !entry->over && !entry->lent && entry->link->in().ready();
           });
  };
  const Instant begin =
      spin_limit_ > Duration::zero() ? std::chrono::steady_clock::now() : Instant();
  const Instant give_up = saturating_sum(begin, spin_.budget());
  bool come = false;
  while (!come && spin_.budget() > Duration::zero() && std::chrono::steady_clock::now() < give_up) {
    come = ready();
  }
  if (!come) sleep();
  if (spin_limit_ > Duration::zero()) spin_.note(std::chrono::steady_clock::now() - begin);
}

// Until a link has something, or somebody notifies.
void Receiver::sleep() {
  futex_waitv words[kMostWords];
  std::size_t count = 0;
  words[count++] = while_it_is(*notified_, 0);
  bool idle = true;
  bool any_lent = false;
  for (const auto& entry : led_) {
    if (entry->over) continue;
    if (entry->lent) {
      any_lent = true;
      continue;
    }
    idle = entry->link->in().prepare_to_sleep() && idle && count < kMostWords;
    if (count < kMostWords) words[count++] = while_it_is(entry->link->in().word(), 1);
  }
  if (!any_lent) {
    look_at_lent_ = Instant::max();
  } else if (look_at_lent_ == Instant::max()) {
    look_at_lent_ = std::chrono::steady_clock::now() + kLent;
  }
  if (idle) futex_wait(std::span(words, count), look_at_lent_);
  for (const auto& entry : led_) {
    if (!entry->over) entry->link->in().stay_awake();
  }
  if (any_lent && std::chrono::steady_clock::now() >= look_at_lent_) take_back_unused();
}

void Receiver::take_back_unused() {
  look_at_lent_ = Instant::max();
  for (const auto& entry : led_) {
    if (!entry->used.exchange(false) && !entry->has_caller) entry->lent = false;
  }
}

}  // namespace skein::same_host
