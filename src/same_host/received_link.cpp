#include "received_link.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "core/log.hpp"
#include "futex.hpp"

namespace skein::same_host {
namespace {

// Then the others have their turn.
constexpr int kMessagesInARow = 16;
// More turns than a full ring takes: a peer that writes on after the end is not listened to.
constexpr int kTurnsAfterEnd = 2048;
// The other side can make a caller miss that its own side wakes it, for so long at most.
constexpr std::chrono::milliseconds kMissed{50};

/// A turn during which the link is locked, until leave().
class OwnTurn final : public calls::Turn {
 public:
  OwnTurn(Taker& taker, Link& link, Bytes& spare, std::unique_lock<std::mutex>& lock)
      : taker_(taker), link_(link), spare_(spare), lock_(lock) {
    if (taker.who != Taker::Who::Caller)
      answering_.emplace(link.out(), link.in().ring(), taker.sleepers, taker.others_wait);
  }

  // The receiver stands in for a consumer, and nobody for the receiver.
  bool leave() override {
    if (left()) return true;
    if (taker_.who != Taker::Who::Consumer) return false;
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

}  // namespace

void ReceivedLink::lend() {
  if (pauses_ % 2 != 0) ++pauses_;
  link->in().ring().lend();
}

void ReceivedLink::pause() {
  if (pauses_ % 2 == 0) ++pauses_;
  news_->tell_of_pause();
}

void ReceivedLink::take_back() {
  if (link->in().ring().take_back()) news_->tell_of_changes();
}

void ReceivedLink::deliver_until(const std::function<bool()>& done) noexcept {
  thread_local Bytes spare;
  Taker taker(Taker::Who::Caller);
  if (has_caller_.exchange(true)) return take_back();
  while (!over_ && !done()) {
    if (look(spare, taker) == Looked::Nothing) sleep(done);
  }
  has_caller_ = false;
  if (over_) take_back();
}

// Sequentially consistent with sleep(): either that sees the call, or this sees that it sleeps.
void ReceivedLink::wake() {
  called_ = true;
  if (!sleeps_) return;
  link->in().ring().stay_awake(RingReader::Who::Caller);
  futex_wake(link->in().ring().word(RingReader::Who::Caller));
}

void ReceivedLink::sleep(const std::function<bool()>& done) {
  called_ = false;
  if (over_ || done()) return;
  RingReader& in = link->in().ring();
  const bool may_spin = spin_.limit() > Duration::zero();
  const Instant begin = may_spin ? std::chrono::steady_clock::now() : Instant();
  const Instant give_up = saturating_sum(begin, spin_.budget());
  bool come = false;
  while (!come && spin_.budget() > Duration::zero() && std::chrono::steady_clock::now() < give_up) {
    come = in.ready() || called_;
  }
  if (!come) {
    sleeps_ = true;
    const bool idle = in.prepare_to_sleep(RingReader::Who::Caller);
    // The other side may write to this word, and so undo the effect of wake().
    if (idle && !called_ && !over_) {
      futex_wait_for(in.word(RingReader::Who::Caller), 1, kMissed);
    }
    in.stay_awake(RingReader::Who::Caller);
    sleeps_ = false;
  }
  if (may_spin) spin_.note(std::chrono::steady_clock::now() - begin);
}

ReceivedLink::Looked ReceivedLink::look(Bytes& spare, Taker& taker) {
  if (over_ || (begun_ && !link->in().ring().ready() && !link->ended())) return Looked::Nothing;
  std::unique_lock lock(mutex_);
  if (over_) return Looked::Nothing;
  if (!begun_.exchange(true)) inbox.on_begin(*link);
  const bool ended = link->ended();  // read first: messages from before the end are taken
  int taken = 0;
  try {
    for (; taken < kMessagesInARow; ++taken) {
      const auto message = link->in().receive(spare);
      if (!message) break;
      if (octets_ != 0) unfinished_->change(std::exchange(octets_, 0), 0);
      OwnTurn turn(taker, *link, spare, lock);
      inbox.on_message(*link, *message, turn);
      const bool left = turn.left();
      if (left && !turn.come_back()) return Looked::Replaced;
      if (taker.sleepers.due()) taker.wake();
      if (left) return Looked::Something;
      link->in().release(spare);
    }
  } catch (const BrokenRing& error) {
    log(LogLevel::Warning, "same host", error.what());
  }
  const bool drained = taken == 0 && !link->in().ring().ready();
  const bool too_much = brings_too_much();
  if (too_much) link->close();
  if (link->broken() || too_much || (ended && (drained || ++turns_after_end_ > kTurnsAfterEnd))) {
    inbox.on_end(*link);
    link->ending().run();
    unfinished_->change(std::exchange(octets_, 0), 0);
    over_ = true;  // from now on the receiver may be gone, if a caller runs this
    wake();
    news_->tell_of_changes();
  }
  return Looked::Something;
}

bool ReceivedLink::brings_too_much() {
  const std::size_t now = link->in().unfinished();
  if (now == octets_) return false;
  const std::size_t others = unfinished_->change(std::exchange(octets_, now), now);
  if (now <= unfinished_->most() - std::min(unfinished_->most(), others)) return false;
  log(LogLevel::Warning, "same host",
      "a connection is ended: of a message without its end " + std::to_string(now) +
          " octets have come, and of others' " + std::to_string(others) +
          "; all together may have " + std::to_string(unfinished_->most()));
  return true;
}

void ReceivedLink::remove() {
  {
    std::lock_guard lock(mutex_);
    over_ = true;
    unfinished_->change(std::exchange(octets_, 0), 0);
  }
  link->stop_taking();
  wake();
}

}  // namespace skein::same_host
