#include "link.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <utility>

#include "dds/port/largest_sample.hpp"

namespace skein::same_host {
namespace {

thread_local const Link::Answering* answering = nullptr;

// A message that needed more is not kept for the next one.
constexpr std::size_t kKeptCapacity = 4 << 20;

/// At the memory's beginning.
struct State {
  RingState rings[2];
  LoanCounts loans;
};
static_assert(sizeof(State) <= Link::kMemory - 2 * Link::kCapacity);

State& state_in(const SharedMemory& memory) { return *reinterpret_cast<State*>(memory.data()); }

RingPlace place_of(const SharedMemory& memory, bool requests) {
  const std::size_t which = requests ? 0 : 1;
  return {&state_in(memory).rings[which],
          memory.data() + (Link::kMemory - 2 * Link::kCapacity) + which * Link::kCapacity,
          Link::kCapacity};
}

}  // namespace

bool Ending::set(std::function<void()> action) {
  std::lock_guard lock(mutex_);
  if (over_) return false;
  action_ = std::move(action);
  return true;
}

void Ending::forget() {
  std::lock_guard lock(mutex_);
  action_ = nullptr;
}

void Ending::run() {
  std::lock_guard lock(mutex_);
  if (std::exchange(over_, true) || !action_) return;
  action_();
}

Link::Link(Side side, std::shared_ptr<const FileDescriptor> socket, SharedMemory memory,
           DoorbellPair doorbells, const Guid& own, const Guid& peer, std::function<void()> notify)
    : side_(side),
      socket_(std::move(socket)),
      memory_(std::make_shared<const SharedMemory>(std::move(memory))),
      doorbells_(std::move(doorbells)),
      own_(own),
      peer_(peer),
      in_(place_of(*memory_, side == Side::Provider), dds::kLargestSample),
      notify_(std::move(notify)),
      out_(place_of(*memory_, side == Side::Client), doorbells_.out) {}

Duration Link::Patience::begin() const {
  if (on_full && *on_full) (*on_full)();
  return left ? std::min(longest, (*left)()) : longest;
}

Link::Sent Link::send(std::span<const std::byte> message, const Patience& patience) {
  std::lock_guard lock(out_mutex_);
  return write({message}, patience);
}

std::optional<Link::Sent> Link::send_lending(std::span<const std::byte> message,
                                             const std::shared_ptr<LoanMemory>& value,
                                             std::size_t position, const Patience& patience) {
  if (side_ != Side::Client) return std::nullopt;
  std::lock_guard lock(out_mutex_);
  if (ended_) return Sent::Ended;
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

Lender::Connection Link::lending() {
  const auto link = weak_from_this();
  return {socket_, &state_in(*memory_).loans, memory_,
          [link] {
            const auto self = link.lock();
            return !self || self->ended();
          },
          [link](const LoanNote& gone) {
            if (const auto self = link.lock()) self->forget(gone);
          }};
}

Link::Answering::Answering(const Link& link, Sleepers& sleepers, bool others)
    : link_(link), sleepers_(sleepers), others_(others), outer_(std::exchange(answering, this)) {
  if (more_wait()) sleepers.note_call();
}

Link::Answering::~Answering() { answering = outer_; }

bool Link::Answering::more_wait() const { return others_ || sleepers_.any() || link_.in_.ready(); }

// Under the lock. As the other side takes what comes only once it runs, it loses nothing but time.
bool Link::let_sleep() {
  return answering != nullptr && &answering->link_ == this && answering->more_wait() &&
         out_.reader_sleeps_here() && answering->sleepers_.add();
}

void Link::wake_peer(Wakes& wakes) {
  if (lets_sleep_ && lets_sleep_.exchange(false)) out_.wake_reader(wakes);
}

// Where it would have to wait, the other side keeps the memory until another one takes its place.
void Link::forget(const LoanNote& gone) {
  const std::unique_lock lock(out_mutex_, std::try_to_lock);
  if (!lock) return;
  try {
    write({std::as_bytes(std::span(&gone, 1)), true}, Duration::zero());
  } catch (const BrokenRing&) {
    // Whoever uses the link next hears of it.
  }
}

// Under the lock.
Link::Sent Link::write(RingWriter::Part message, const Patience& patience) {
  if (ended_) return Sent::Ended;
  message.lets_sleep = let_sleep();
  try {
    if (out_.put(message)) {
      lets_sleep_ = message.lets_sleep;
      // Who has gone on in this thread's place may have looked before: then it is seen here.
      if (message.lets_sleep && answering->sleepers_.replaced()) {
        Wakes wakes;
        wake_peer(wakes);
      }
      return Sent::Yes;
    }
    message.lets_sleep = false;  // it has been woken, as there is no room
    if (out_.write(message, patience.begin(), [this] { return ended(); })) return Sent::Yes;
  } catch (const BrokenRing&) {
    break_off();
    throw;
  }
  return ended_ ? Sent::Ended : Sent::NoRoom;
}

bool Link::await_taken(Instant deadline) {
  std::lock_guard lock(out_mutex_);
  try {
    return out_.await_empty(deadline, [this] { return ended(); });
  } catch (const BrokenRing&) {
    break_off();
    return false;
  }
}

std::optional<std::span<const std::byte>> Link::receive(Bytes& spare) {
  if (message_.empty()) message_.swap(spare);
  try {
    if (in_.take(message_)) {
      if (!in_.lends()) return std::span<const std::byte>(message_);
      lent_ = borrow();
      if (lent_)
        return std::span<const std::byte>(message_).first(message_.size() - sizeof(LoanNote));
      message_.clear();
    }
  } catch (const BrokenRing&) {
    break_off();
    throw;
  }
  if (message_.empty()) message_.swap(spare);
  if (unfinished_ != message_.size()) unfinished_ = message_.size();
  return std::nullopt;
}

// Nothing where a memory is gone: the message has told all.
std::optional<calls::LentValue> Link::borrow() {
  if (side_ != Side::Provider) throw BrokenRing("a reply that lends");
  if (!borrower_) borrower_.emplace(socket_, &state_in(*memory_).loans, memory_);
  return borrower_->borrow(message_);
}

void Link::break_off() {
  broken_ = true;
  close();
}

void Link::release(Bytes& spare) {
  message_.clear();
  lent_.reset();
  if (unfinished_ != 0) unfinished_ = 0;
  if (message_.capacity() > kKeptCapacity) message_ = Bytes();
  spare = std::move(message_);
}

void Link::close() {
  shutdown(socket_->get(), SHUT_RDWR);
  note_end();
}

void Link::note_end() {
  if (ended_.exchange(true)) return;
  out_.wake();
  notify_();
}

}  // namespace skein::same_host
