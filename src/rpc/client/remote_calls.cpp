#include "remote_calls.hpp"

#include <utility>

#include "rpc/wire/common.hpp"
#include "rpc/wire/reply_reading.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

std::exception_ptr unreadable_reply(RefusedReplies& refused, const std::string& peer,
                                    const OperationInfo& operation,
                                    const std::exception& malformed) {
  refused.note_malformed(malformed.what());
  return std::make_exception_ptr(Internal(
      peer + " answered " + quoted(operation) + " with what cannot be read: " + malformed.what() +
      "; the network damaged it, or the two sides were built from different IDL"));
}

}  // namespace

std::shared_ptr<RemoteCalls> RemoteCalls::make(Parts parts) {
  std::shared_ptr<RemoteCalls> made(new RemoteCalls(std::move(parts)));
  made->pending_ = std::make_shared<PendingCalls>(
      *made->parts_.clock, made->parts_.most, [calls = std::weak_ptr(made)](std::uint64_t number) {
        if (const auto self = calls.lock()) self->expire(number);
      });
  return made;
}

void RemoteCalls::hand_over() const {
  if (const auto answers = answers_.lock()) answers->hand_over();
}

// The call is known before its request leaves: a reply may be here before send() returns.
bool RemoteCalls::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  if (parts_.spin.count() > 0) call->set_spin(parts_.spin);
  const auto added = pending_->add(call);
  if (!added) return false;
  const std::uint64_t number = *added;
  if (number == 0) {
    hand_over();  // some of them may have come
    throw Overloaded(std::to_string(parts_.most) + " calls to " + parts_.peer +
                     " already wait for their answers; the call was not sent");
  }
  if (!call->blocking()) {
    call->set_canceller([calls = weak_from_this(), number] {
      if (const auto self = calls.lock()) self->abandon(number);
    });
  }
  if (call->operation().stream) {
    static_cast<PendingStream&>(*call).set_granter(
        [calls = weak_from_this(), number](std::uint32_t count) {
          if (const auto self = calls.lock()) self->grant(number, count);
        });
  }
  if (!call->operation().oneway) {
    if (const auto answers = answers_.lock()) call->set_answers(answers);
  }
  bool sent = false;
  std::exception_ptr not_sent;
  call->attempt([&] {
    const std::uint64_t told_before = told_;
    try {
      sent = parts_.path->send(*call, number, in);
    } catch (const NotSent&) {
      not_sent = std::current_exception();
    }
    // The call ended while it was sent: the server may have heard of its end first.
    if (sent && told_ != told_before && call->claimed()) tell_server(number);
  });
  if (!sent || call->operation().oneway) {
    const bool waited = remove(number) != nullptr;  // or else it has ended in another way
    if (not_sent && waited) {
      parts_.path->note_end(number, call->operation(), not_sent);
      call->set_answers(nullptr);
      std::rethrow_exception(not_sent);
    }
  }
  if (sent && call->operation().oneway && call->claim()) finish(*call, number, nullptr);
  return true;
}

std::shared_ptr<PendingCall> RemoteCalls::remove(std::uint64_t number, PendingCalls::Keep keep) {
  auto [call, last] = pending_->remove(number, keep);
  if (last) parts_.on_idle();
  return call;
}

// After claim().
void RemoteCalls::finish(PendingCall& call, std::uint64_t number, std::exception_ptr error) const {
  parts_.path->note_end(number, call.operation(), error);
  call.finish(std::move(error));
}

// A stream stays known until its last reply. What is wrong with it ends it, here and at the server.
void RemoteCalls::on_reply(std::span<const std::byte> message, const wire::ReplyHead& head) {
  const std::uint64_t number = head.related.number;
  const auto call = remove(number, PendingCalls::Keep::Streams);
  if (!call) return;
  if (call->operation().stream) {
    auto& stream = static_cast<PendingStream&>(*call);
    try {
      read_part(number, stream, message, head);
    } catch (const std::exception& malformed) {
      abandon(number);
      stream.fail(unreadable_reply(*parts_.refused, parts_.peer, stream.operation(), malformed));
    }
    return;
  }
  if (!call->claim()) return;
  std::exception_ptr error;
  try {
    error = read_reply(call->operation(), call->out(), message, head, parts_.peer).error;
  } catch (const std::exception& malformed) {
    error = unreadable_reply(*parts_.refused, parts_.peer, call->operation(), malformed);
  }
  finish(*call, number, std::move(error));
}

void RemoteCalls::read_part(std::uint64_t number, PendingStream& stream,
                            std::span<const std::byte> message, const wire::ReplyHead& head) {
  const TypeSupport& type = *stream.operation().out;
  PendingStream::Item item(type.make(), type.destroy);
  Reply reply = read_reply(stream.operation(), item.get(), message, head, parts_.peer);
  if (!reply.error && reply.part != wire::StreamPart::None &&
      reply.position != stream.delivered()) {
    throw InvalidArgument("result " + std::to_string(stream.delivered()) +
                          " of the stream is missing");
  }
  if (!reply.error && reply.part != wire::StreamPart::End && !stream.deliver(std::move(item))) {
    throw InvalidArgument("it is a result more than was asked for");
  }
  if (reply.part == wire::StreamPart::Item) return;
  remove(number);
  if (stream.claim()) finish(stream, number, std::move(reply.error));
}

void RemoteCalls::on_unreadable(std::span<const std::byte> message, const std::exception& why) {
  const auto related = wire::read_request_id(message);
  const auto call =
      related && related->client == parts_.path->client() ? remove(related->number) : nullptr;
  if (!call) return parts_.refused->note_malformed(why.what());
  auto error = unreadable_reply(*parts_.refused, parts_.peer, call->operation(), why);
  if (!call->claim()) return;
  finish(*call, related->number, std::move(error));
  if (call->operation().stream) tell_server(related->number);
}

void RemoteCalls::expire(std::uint64_t number) {
  const auto call = remove(number);
  if (!call || !call->claim()) return;
  finish(*call, number,
         std::make_exception_ptr(TimedOut(parts_.peer + " did not answer " +
                                          quoted(call->operation()) +
                                          " before its deadline; whether it ran is unknown" +
                                          parts_.refused->what_came_malformed() + kMoreTime)));
  tell_server(number);
}

void RemoteCalls::abandon(std::uint64_t number) {
  const auto call = remove(number);
  if (!call) return;
  parts_.path->note_end(number, call->operation(),
                        std::make_exception_ptr(Cancelled("its caller waits no longer")));
  tell_server(number);
}

void RemoteCalls::tell_server(std::uint64_t number) {
  ++told_;                       // before it is
  std::lock_guard lock(mutex_);  // once they have failed, `control` may be gone
  if (failed_) return;
  parts_.control.post([calls = weak_from_this(), number] {
    const auto self = calls.lock();
    if (!self) return;
    try {
      self->parts_.path->send_reserved(wire::kCancel, {.target = number});
    } catch (const Error&) {
      // The server will find the call expired; cancelling early is a courtesy.
    }
  });
}

// On the thread that takes the results: one that is held up here takes none anyway.
void RemoteCalls::grant(std::uint64_t number, std::uint32_t count) const {
  try {
    parts_.path->send_reserved(wire::kCredit, {.target = number, .credit = count});
  } catch (const Unavailable&) {
    // The connection has just ended, which ends the stream, as Disconnected.
  }
}

void RemoteCalls::fail_all(
    const std::function<std::exception_ptr(const OperationInfo&)>& make_error) {
  {
    std::lock_guard lock(mutex_);
    failed_ = true;
  }
  for (auto& [number, call] : pending_->close()) {
    auto error = make_error(call->operation());
    parts_.path->note_end(number, call->operation(), error);
    call->fail(std::move(error));
  }
}

}  // namespace skein::rpc
