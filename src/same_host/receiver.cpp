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
// A busy thread listens to the doorbells of other links, which takes a system call, once after so
// many turns; one that spins after so many looks.
constexpr int kTurnsUnheard = 8;
constexpr int kLooksUnheard = 16;
// The other side can make a caller miss that its own side wakes it, for so long at most.
constexpr std::chrono::milliseconds kMissed{50};
// What is for a caller that does something else is taken back after so long, or twice that.
constexpr std::chrono::milliseconds kPaused{20};
constexpr std::chrono::milliseconds kNotAtAll{0};

}  // namespace

void SpinPolicy::note(Duration waited) {
  score_ = waited <= limit_ ? std::min(score_ + 1, kMost) : std::max(score_ - 4, 0);
}

/// What wakes the leading thread. It outlives the receiver, for links that do.
struct Receiver::News {
  void tell_of_changes() {
    changed = true;
    doorbells.call();
  }

  void tell_of_pause() {
    if (!paused && !paused.exchange(true)) doorbells.call();
  }

  Doorbells doorbells;
  std::atomic<bool> changed{false};  // a link is new, has ended, or was taken back
  std::atomic<bool> paused{false};   // a caller has, and has not been looked for since
};

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
class Receiver::OwnTurn final : public calls::Turn {
 public:
  OwnTurn(Taker& taker, Link& link, Bytes& spare, std::unique_lock<std::mutex>& lock)
      : taker_(taker), link_(link), spare_(spare), lock_(lock) {
    if (taker.who != Who::Caller)
      answering_.emplace(link.out(), link.in().ring(), taker.sleepers, taker.others_wait);
  }

  // The receiver stands in for a consumer, and nobody for the receiver.
  bool leave() override {
    if (left()) return true;
    if (taker_.who != Who::Consumer) return false;
    link_.in().release(spare_);
    lock_.unlock();
    taker_.left = taker_.lead->leave();
    return true;
  }
  bool left() const { return taker_.left != 0; }
  bool come_back() { return taker_.lead->take_back(std::exchange(taker_.left, 0)); }

 private:
  Taker& taker_;
  Link& link_;
  Bytes& spare_;
  std::unique_lock<std::mutex>& lock_;
  std::optional<LinkWriter::Answering> answering_;
};

// Once it is over, the inbox and the receiver may be gone.
class Receiver::Entry final : public calls::CallerDelivery {
 public:
  Entry(Receiver& receiver_, std::shared_ptr<Link> link_, Inbox& inbox_, std::uint64_t id_)
      : link(std::move(link_)),
        inbox(inbox_),
        id(id_),
        receiver(receiver_),
        spin(receiver_.spin_limit_) {}

  void lend() override {
    if (pauses % 2 != 0) ++pauses;
    link->in().ring().lend();
  }
  void pause() override {
    if (pauses % 2 == 0) ++pauses;
    news->tell_of_pause();
  }
  void take_back() override {
    if (link->in().ring().take_back()) news->tell_of_changes();
  }
  // Who unwound from it would leave the call's result to be written where it was.
  void deliver_until(const std::function<bool()>& over_) noexcept override;
  void wake() override {
    called = true;
    if (!sleeps) return;
    link->in().ring().stay_awake(RingReader::Who::Caller);
    futex_wake(link->in().ring().word(RingReader::Who::Caller));
  }

  /// For who leads.
  bool has_something() const {
    if (over) return false;
    return !begun || link->ended() || (link->in().ring().ready() && !link->in().ring().lent());
  }

  const std::shared_ptr<Link> link;
  Inbox& inbox;
  const std::uint64_t id;  // its doorbell's
  std::mutex mutex;        // held while a function of the inbox runs
  std::atomic<bool> begun{false};
  std::size_t unfinished = 0;  // as others know it; under the mutex
  int turns_after_end = 0;
  bool attended = false;                 // of who leads
  std::uint32_t pauses_seen = 0;         // of who leads
  std::atomic<std::uint32_t> pauses{0};  // odd while a caller pauses
  std::atomic<bool> over{false};         // nobody need wait for it any more
  std::atomic<bool> has_caller{false};   // which is in deliver_until()

 private:
  void sleep(const std::function<bool()>& over_);

  Receiver& receiver;
  const std::shared_ptr<News> news = receiver.news_;
  // The caller's.
  SpinPolicy spin;
  std::atomic<bool> called{false};
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
  called = false;
  if (over || over_()) return;
  RingReader& in = link->in().ring();
  const bool may_spin = spin.limit() > Duration::zero();
  const Instant begin = may_spin ? std::chrono::steady_clock::now() : Instant();
  const Instant give_up = saturating_sum(begin, spin.budget());
  bool come = false;
  while (!come && spin.budget() > Duration::zero() && std::chrono::steady_clock::now() < give_up) {
    come = in.ready() || called;
  }
  if (!come) {
    sleeps = true;
    const bool idle = in.prepare_to_sleep(RingReader::Who::Caller);
    // The other side may write to this word, and so undo what wake() has done.
    if (idle && !called && !over) {
      futex_wait_for(in.word(RingReader::Who::Caller), 1, kMissed);
    }
    in.stay_awake(RingReader::Who::Caller);
    sleeps = false;
  }
  if (may_spin) spin.note(std::chrono::steady_clock::now() - begin);
}

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
    if (receiver_.lead(Who::Consumer, over)) lead_->leave();
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
  const std::shared_ptr<News> news_;
  std::atomic<bool> wants_{false};
  Word called_{1};  // 0 while it waits to be given the lead
};

Receiver::Receiver(std::string name, TimeSpan spin, std::shared_ptr<Unfinished> unfinished)
    : name_(std::move(name)),
      spin_limit_(spin),
      unfinished_(std::move(unfinished)),
      news_(std::make_shared<News>()),
      consumer_(std::make_shared<Consumer>(*this)),
      spin_(spin) {}

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
  std::shared_ptr<Entry> entry;
  {
    std::lock_guard lock(mutex_);
    entry = std::make_shared<Entry>(*this, std::move(link), inbox, ++last_id_);
    news_->doorbells.add(entry->link->doorbells().in, entry->id);
    try {
      if (!thread_.joinable()) thread_ = start_thread(name_, [this] { run(); });
    } catch (...) {
      news_->doorbells.remove(entry->link->doorbells().in);
      throw;
    }
    entries_.push_back(entry);
    added_.push_back(entry);
    consumer_->useful = true;
  }
  news_->tell_of_changes();
  return entry;
}

std::shared_ptr<calls::CallerDelivery> Receiver::delivery() const { return consumer_; }

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
  for (const auto& entry : removed) news_->doorbells.remove(entry->link->doorbells().in);
  Wakes wakes;
  for (const auto& entry : removed) {
    {
      std::lock_guard lock(entry->mutex);
      entry->over = true;
      unfinished_->change(std::exchange(entry->unfinished, 0), 0);
    }
    entry->wake();
    entry->link->out().wake_peer(wakes);
  }
  news_->tell_of_changes();
}

std::size_t Receiver::links() const {
  std::lock_guard lock(mutex_);
  return entries_.size();
}

void Receiver::run() {
  pthread_setname_np(pthread_self(), name_.c_str());
  bool leads = lead_->take();
  while (!stopping_) {
    if (!leads) {
      leads = lead_->stand_by([this] { return stopping_.load(); });
    } else {
      lead(Who::Receiver, [this] { return consumer_->wants(); });
      leads = stopping_ || !consumer_->give();
    }
  }
  if (leads) lead_->leave();
}

// By who has the lead, until `over`, which a call() at the doorbells makes it look at, or the
// receiver ends. False if the receiver has stood in; it may be gone then.
bool Receiver::lead(Who who, const std::function<bool()>& over) {
  Taker taker(who, lead_.get());
  wake_peers();  // those whom the thread that led before has let sleep
  if (turns_ > 0) attend_rung(kNotAtAll);
  while (true) {
    news_->doorbells.forget_call();
    if (news_->changed && news_->changed.exchange(false)) take_in_changes();
    if (stopping_ || over()) break;
    const Looked looked = look_at_all(taker);
    if (looked == Looked::Replaced) return false;
    if (looked == Looked::Something) {
      if (turns_ >= kTurnsUnheard) attend_rung(kNotAtAll);
      continue;
    }
    // Clients that have been let sleep sleep on while there are requests of others.
    if (taker.sleepers.any() && !taker.sleepers.due() && attend_rung(kNotAtAll)) continue;
    wake(taker.sleepers);
    await();
  }
  wake(taker.sleepers);
  return true;
}

// What was new, has ended, or was taken back.
void Receiver::take_in_changes() {
  Entries added;
  Entries ended;  // whose links may end with them: not under the lock
  {
    std::lock_guard lock(mutex_);
    added.swap(added_);
    const auto first = std::stable_partition(entries_.begin(), entries_.end(),
                                             [](const auto& entry) { return !entry->over; });
    ended.assign(first, entries_.end());
    entries_.erase(first, entries_.end());
    if (entries_.empty()) consumer_->useful = false;
  }
  for (const auto& entry : ended) news_->doorbells.remove(entry->link->doorbells().in);
  for (const auto& entry : added) {
    led_.emplace(entry->id, entry);
    attend(entry);
  }
  std::erase_if(attended_, [](const auto& entry) { return entry->over.load(); });
  std::erase_if(led_, [](const auto& each) { return each.second->over.load(); });
  for (const auto& [id, entry] : led_) {
    if (entry->has_something()) attend(entry);
  }
}

void Receiver::attend(const std::shared_ptr<Entry>& entry) {
  if (!std::exchange(entry->attended, true)) attended_.push_back(entry);
}

// Whether any rang.
bool Receiver::attend_rung(std::optional<std::chrono::milliseconds> longest) {
  turns_ = 0;
  const auto rung = news_->doorbells.wait(longest);
  for (const std::uint64_t id : rung) {
    if (const auto found = led_.find(id); found != led_.end()) attend(found->second);
  }
  return !rung.empty();
}

Receiver::Looked Receiver::look_at_all(Taker& taker) {
  const auto next = [&](std::size_t from) {
    while (from < attended_.size() && !attended_[from]->has_something()) ++from;
    return from;
  };
  Looked all = Looked::Nothing;
  for (std::size_t i = next(0); i < attended_.size();) {
    const std::size_t after = next(i + 1);
    taker.others_wait = after < attended_.size();
    const Looked looked = look_at(*attended_[i], spare_, taker);
    if (looked == Looked::Replaced) return looked;
    if (looked == Looked::Something) {
      all = looked;
      ++turns_;
    }
    if (taker.sleepers.due()) wake(taker.sleepers);  // also where no whole message has come
    i = after;
  }
  return all;
}

// On the thread that leads, or a caller's.
Receiver::Looked Receiver::look_at(Entry& entry, Bytes& spare, Taker& taker) {
  Link& link = *entry.link;
  if (entry.over || (entry.begun && !link.in().ring().ready() && !link.ended()))
    return Looked::Nothing;
  std::unique_lock lock(entry.mutex);
  if (entry.over) return Looked::Nothing;
  if (!entry.begun.exchange(true)) entry.inbox.on_begin(link);
  const bool ended = link.ended();  // looked at first: what came before the end is taken
  int taken = 0;
  try {
    for (; taken < kMessagesInARow; ++taken) {
      const auto message = link.in().receive(spare);
      if (!message) break;
      if (entry.unfinished != 0) unfinished_->change(std::exchange(entry.unfinished, 0), 0);
      OwnTurn turn(taker, link, spare, lock);
      entry.inbox.on_message(link, *message, turn);
      const bool left = turn.left();
      if (left && !turn.come_back()) return Looked::Replaced;
      if (taker.sleepers.due()) wake(taker.sleepers);
      if (left) return Looked::Something;
      link.in().release(spare);
    }
  } catch (const BrokenRing& error) {
    log(LogLevel::Warning, "same host", error.what());
  }
  const bool drained = taken == 0 && !link.in().ring().ready();
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
  const std::size_t now = entry.link->in().unfinished();
  if (now == entry.unfinished) return false;
  const std::size_t others = unfinished_->change(std::exchange(entry.unfinished, now), now);
  if (now <= unfinished_->most() - std::min(unfinished_->most(), others)) return false;
  log(LogLevel::Warning, "same host",
      "a connection is ended: of a message without its end " + std::to_string(now) +
          " octets have come, and of others' " + std::to_string(others) +
          "; all together may have " + std::to_string(unfinished_->most()));
  return true;
}

void Receiver::wake(Sleepers& sleepers) const {
  if (!sleepers.any()) return;
  sleepers.clear();
  wake_peers();
}

void Receiver::wake_peers() const {
  Wakes wakes;
  for (const auto& entry : attended_) entry->link->out().wake_peer(wakes);
}

// Until a link has something, or there is a call.
void Receiver::await() {
  const bool spins = spin_limit_ > Duration::zero();
  const Instant begin = spins ? std::chrono::steady_clock::now() : Instant();
  const Instant give_up = saturating_sum(begin, spin_.budget());
  const auto has_something = [](const auto& entry) { return entry->has_something(); };
  bool come = false;
  for (int i = 1; !come && spin_.budget() > Duration::zero(); ++i) {
    if (std::chrono::steady_clock::now() >= give_up) break;
    if (i % kLooksUnheard == 0) attend_rung(kNotAtAll);
    come = news_->doorbells.called() || std::ranges::any_of(attended_, has_something);
  }
  if (!come && may_sleep()) sleep();
  if (spins) spin_.note(std::chrono::steady_clock::now() - begin);
}

void Receiver::sleep() {
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
void Receiver::take_back_paused() {
  look_at_paused_ = Instant::max();
  news_->paused = false;
  for (const auto& [id, entry] : led_) {
    const std::uint32_t pauses = entry->pauses;
    if (pauses % 2 == 0) continue;
    if (std::exchange(entry->pauses_seen, pauses) != pauses) {
      news_->paused = true;
    } else if (entry->link->in().ring().take_back()) {
      attend(entry);
    }
  }
}

// From now on the doorbells of all links ring that bring something; unless one has already.
bool Receiver::may_sleep() {
  std::erase_if(attended_, [](const auto& entry) {
    entry->attended = entry->has_something() || !entry->link->in().ring().prepare_to_sleep();
    return !entry->attended;
  });
  return attended_.empty();
}

}  // namespace skein::same_host
