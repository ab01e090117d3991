#include "reply_path.hpp"

#include <algorithm>
#include <utility>

#include "core/log.hpp"
#include "rpc/wire/reply_encoding.hpp"

namespace skein::rpc {
namespace {

// How many refusals may wait to be sent to a client: no client that waits for them has more calls
// on its way (RemoteChannel::Options::calls_in_flight).
constexpr std::size_t kMaxRefusals = 4096;
// How long a refusal is worth sending; what the call's deadline is may be unknown.
constexpr std::chrono::seconds kRefusalPatience{10};
// How soon replies that found no room are tried again: no port tells when there is some.
constexpr std::chrono::milliseconds kRetryInterval{5};
// How much is sent then before it is awaited again that the client has taken all: as much as any
// sender takes without blocking `control`.
constexpr std::size_t kRetrySize = 256 << 10;

}  // namespace

void ReplyContext::note_lost(std::uint64_t count, const std::string& why) {
  if (lost.fetch_add(count) > 0) return;
  log(LogLevel::Warning, address.service, "a reply was lost: " + why);
}

void ReplyPath::open(std::shared_ptr<calls::Sender> sender) {
  std::lock_guard lock(mutex_);
  sender_ = std::move(sender);
}

std::shared_ptr<calls::Sender> ReplyPath::close() {
  std::shared_ptr<calls::Sender> sender;
  TimerId retry;
  {
    std::lock_guard lock(mutex_);
    sender.swap(sender_);
    unsent_.clear();
    count(-static_cast<std::ptrdiff_t>(unsent_size_));
    retry = retry_;
  }
  context_.clock.cancel(retry);  // unlocked: it may be running
  return sender;
}

std::shared_ptr<calls::Sender> ReplyPath::sender() const {
  std::lock_guard lock(mutex_);
  return sender_;
}

bool ReplyPath::send(const std::shared_ptr<calls::Sender>& sender, Bytes& message,
                     Instant deadline) {
  if (!sender) return false;
  if (stalled_) return keep(message, deadline);
  try {
    sender->send(message, [this, deadline] { return deadline - context_.clock.now(); });
    return true;
  } catch (const Overloaded&) {
    return keep(message, deadline);
  } catch (const Error& error) {
    context_.note_lost(1, error.what());
    return false;
  }
}

void ReplyPath::refuse(const wire::RequestId& id, ErrorCode code, std::string text) {
  {
    std::lock_guard lock(mutex_);
    if (refusals_.size() >= kMaxRefusals) refusals_.pop_front();
    refusals_.push_back({id, code, std::move(text)});
    if (std::exchange(refusing_, true)) return;
  }
  context_.control.post_or_run([weak = weak_context_, path = shared_from_this()] {
    if (const auto context = weak.lock()) path->write_refusals();
  });
}

// One task for all that wait finds room at `control`, whatever else does.
void ReplyPath::write_refusals() {
  std::deque<Refusal> refusals;
  {
    std::lock_guard lock(mutex_);
    refusals.swap(refusals_);
    refusing_ = false;
  }
  const Representation representation = context_.address.representation;
  for (const auto& [id, code, text] : refusals) {
    Bytes message;
    if (code == ErrorCode::Unimplemented) {
      wire::begin_reply(message, id, wire::RemoteException::UnknownOperation, 0, representation);
      wire::append_default_branch(message);
      wire::append_trailer(message, wire::ReplyTrailer{code, text});
    } else {
      encode_error(message, representation, id, code, text);
    }
    send(sender(), message, context_.clock.now() + kRefusalPatience);
  }
}

bool ReplyPath::keep(Bytes& message, Instant deadline) {
  const std::size_t size = message.size();
  {
    std::lock_guard lock(mutex_);
    if (!sender_) return false;
    count(static_cast<std::ptrdiff_t>(size));
    if (const std::size_t all = context_.unsent;
        all - size + unsent_size_ > ReplyContext::kMaxUnsent) {
      count(-static_cast<std::ptrdiff_t>(size));
      context_.note_lost(
          1, std::to_string(all - size) + " octets wait already for clients that take none");
      return false;
    }
    unsent_.push_back({std::move(message), deadline});
    stalled_ = true;
    if (std::exchange(retrying_, true)) return true;
  }
  retry_later(kRetryInterval);
  return true;
}

// The path is not held: its last owner must not be the clock's thread.
void ReplyPath::retry_later(Duration after) {
  const TimerId timer =
      context_.clock.call_after(after, [weak = weak_context_, path = weak_from_this()] {
        const auto context = weak.lock();
        if (!context) return;
        context->control.post_or_run([weak, path] {
          const auto context = weak.lock();
          const auto self = path.lock();
          if (context && self) self->send_kept();
        });
      });
  std::lock_guard lock(mutex_);
  retry_ = timer;
}

// In their order, once the client has taken all that was sent before. Others need `control`, too: a
// client for which it has waited in vain gets a fifth of its time at most.
void ReplyPath::send_kept() {
  Duration pause = kRetryInterval;
  for (std::size_t sent = 0; sent < kRetrySize;) {
    auto next = next_kept();
    if (!next) return;
    const Instant begun = context_.clock.now();
    if (!try_to_send(*next, sent == 0)) {
      std::lock_guard lock(mutex_);
      if (!sender_) return;
      count(static_cast<std::ptrdiff_t>(next->message.size()));
      unsent_.push_front(std::move(*next));
      pause = std::max(pause, 4 * (context_.clock.now() - begun));
      break;
    }
    sent += next->message.size();
  }
  retry_later(pause);
}

// Nothing, and replies go straight to the sender again, if none is kept any more.
std::optional<ReplyPath::Unsent> ReplyPath::next_kept() {
  std::lock_guard lock(mutex_);
  const Instant now = context_.clock.now();
  const auto late = std::erase_if(unsent_, [&](const Unsent& each) {
    if (each.deadline > now) return false;
    count(-static_cast<std::ptrdiff_t>(each.message.size()));
    return true;
  });
  if (late > 0) context_.note_lost(late, "the client took none before the call's deadline");
  if (unsent_.empty()) {
    stalled_ = retrying_ = false;
    return std::nullopt;
  }
  std::optional<Unsent> next(std::move(unsent_.front()));
  unsent_.pop_front();
  count(-static_cast<std::ptrdiff_t>(next->message.size()));
  return next;
}

bool ReplyPath::try_to_send(const Unsent& reply, bool await_room) {
  using namespace std::chrono_literals;
  const auto sender = this->sender();
  if (!sender) return true;
  try {
    if (await_room && !sender->await_taken(0ms)) return false;
    sender->send(reply.message, [&] { return reply.deadline - context_.clock.now(); });
  } catch (const Overloaded&) {
    return false;
  } catch (const Error& error) {
    context_.note_lost(1, error.what());
  }
  return true;
}

// Under the lock.
void ReplyPath::count(std::ptrdiff_t octets) {
  unsent_size_ += static_cast<std::size_t>(octets);
  context_.unsent += static_cast<std::size_t>(octets);
}

}  // namespace skein::rpc
