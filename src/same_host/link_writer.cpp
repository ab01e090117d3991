#include "link_writer.hpp"

#include <algorithm>
#include <utility>

namespace skein::same_host {
namespace {

thread_local const LinkWriter::Answering* answering = nullptr;

}  // namespace

Duration LinkWriter::Patience::begin() const {
  if (on_full && *on_full) (*on_full)();
  return left ? std::min(longest, (*left)()) : longest;
}

LinkWriter::Sent LinkWriter::send(std::span<const std::byte> message, const Patience& patience) {
  std::lock_guard lock(mutex_);
  return write({message}, patience);
}

std::optional<LinkWriter::Sent> LinkWriter::send_lending(std::span<const std::byte> message,
                                                         const std::shared_ptr<LoanMemory>& value,
                                                         std::size_t position,
                                                         const Patience& patience) {
  if (state_.side() != LinkState::Side::Client) return std::nullopt;
  std::lock_guard lock(mutex_);
  if (ended()) return Sent::Ended;
  if (!lender_) lender_.emplace(lending());
  const auto note = lender_->lend(value, position);
  if (!note) return std::nullopt;
  Sent sent = Sent::NoRoom;
  try {
    Bytes whole(message);
    whole.append(std::as_bytes(std::span(&*note, 1)));
    sent = write({whole, true}, patience);
  } catch (...) {
    lender_->not_sent(*note);
    throw;
  }
  if (sent == Sent::Yes) {
    lender_->sent(*note);
  } else {
    lender_->not_sent(*note);
  }
  return sent;
}

// While the state is there, so is this half of its link.
Lender::Connection LinkWriter::lending() {
  const auto link = state_.weak_from_this();
  return {state_.socket(), &state_.loans(), state_.memory(),
          [link] {
            const auto state = link.lock();
            return !state || state->ended();
          },
          [link, this](const LoanNote& gone) {
            if (const auto state = link.lock()) forget(gone);
          }};
}

LinkWriter::Answering::Answering(const LinkWriter& writer, const RingReader& requests,
                                 Sleepers& sleepers, bool others)
    : writer_(writer),
      requests_(requests),
      sleepers_(sleepers),
      others_(others),
      outer_(std::exchange(answering, this)) {
  if (more_wait()) sleepers.note_call();
}

LinkWriter::Answering::~Answering() { answering = outer_; }

bool LinkWriter::Answering::more_wait() const {
  return others_ || sleepers_.any() || requests_.ready();
}

// Under the lock. The other side takes messages only once it runs: it loses nothing but time.
bool LinkWriter::let_sleep() {
  return answering != nullptr && &answering->writer_ == this && answering->more_wait() &&
         ring_.reader_sleeps_here() && answering->sleepers_.add();
}

void LinkWriter::wake_peer(Wakes& wakes) {
  if (lets_sleep_ && lets_sleep_.exchange(false)) ring_.wake_reader(wakes);
}

// If this would have to wait, the other side keeps the memory until another one takes its place.
void LinkWriter::forget(const LoanNote& gone) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  try {
    write({std::as_bytes(std::span(&gone, 1)), true}, Duration::zero());
  } catch (const BrokenRing&) {
    // The next use of the link finds that it has ended.
  }
}

// Under the lock.
LinkWriter::Sent LinkWriter::write(RingWriter::Part message, const Patience& patience) {
  if (ended()) return Sent::Ended;
  message.lets_sleep = let_sleep();
  try {
    if (ring_.put(message)) {
      lets_sleep_ = message.lets_sleep;
      // A thread that has replaced this one may have looked before `lets_sleep_` was set.
      if (message.lets_sleep && answering->sleepers_.replaced()) {
        Wakes wakes;
        wake_peer(wakes);
      }
      return Sent::Yes;
    }
    message.lets_sleep = false;  // it has been woken, as there is no room
    if (ring_.write(message, patience.begin(), [this] { return ended(); })) return Sent::Yes;
  } catch (const BrokenRing&) {
    state_.break_off();
    throw;
  }
  return ended() ? Sent::Ended : Sent::NoRoom;
}

bool LinkWriter::await_taken(Instant deadline) {
  std::lock_guard lock(mutex_);
  if (ring_.reader_gone()) return true;  // it takes nothing more
  try {
    return ring_.await_empty(deadline, [this] { return state_.ended(); });
  } catch (const BrokenRing&) {
    state_.break_off();
    return false;
  }
}

}  // namespace skein::same_host
