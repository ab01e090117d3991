#include <algorithm>

#include "core/log.hpp"
#include "remote_channel_state.hpp"
#include "rpc/wire/common.hpp"
#include "rpc/wire/reply_reading.hpp"
#include "skein/error.hpp"

namespace skein::rpc {

void RemoteChannel::State::on_message(const calls::Message& message) {
  if (!is_provider(message.sender)) return note_forged(message.sender);
  try {
    const wire::ReplyHead head = wire::read_reply_head(message.bytes);
    if (head.related.client != client) return;
    if (head.related.number == 0) {
      on_opened(message.bytes, head);
    } else if (head.operation == wire::kOpen) {
      dismissed("it had ended the session before the call arrived");
    } else {
      on_reply(message.bytes, head);
    }
  } catch (const std::exception& error) {
    on_unreadable(message.bytes, error);
  }
}

// Over DDS, whoever knows a client's identity can send to it.
bool RemoteChannel::State::is_provider(const Guid& sender) const {
  const Guid participant = sender.participant();
  if (!options.participant.is_nil()) return participant == options.participant;
  std::lock_guard lock(mutex);
  return std::any_of(servers.begin(), servers.end(),
                     [&](const Guid& receiver) { return receiver.participant() == participant; });
}

void RemoteChannel::State::note_forged(const Guid& sender) {
  std::lock_guard lock(mutex);
  if (++forged > 1) return;
  log(LogLevel::Warning, address.service,
      "refused a reply in the name of " + options.peer + ": participant " +
          sender.participant().hex() + ", which is not the provider, wrote it");
}

// A reply of which no more can be read than whose call it answers ends that call all the same.
void RemoteChannel::State::on_unreadable(std::span<const std::byte> message,
                                         const std::exception& why) {
  const auto related = wire::read_request_id(message);
  const auto call = related && related->client == client ? remove(related->number) : nullptr;
  if (!call) return note_malformed(why.what());
  auto error = unreadable(call->operation(), why);
  if (!call->claim()) return;
  note_end(related->number, call->operation(), error);
  call->finish(std::move(error));
  if (call->operation().stream) tell_server(related->number);
}

void RemoteChannel::State::on_reply(std::span<const std::byte> message,
                                    const wire::ReplyHead& head) {
  const std::uint64_t number = head.related.number;
  const auto call = remove(number, Keep::Streams);
  if (!call) return;
  if (call->operation().stream) {
    on_stream_reply(number, static_cast<PendingStream&>(*call), message, head);
  } else {
    complete(*call, message, head);
  }
}

void RemoteChannel::State::note_malformed(const std::string& why) {
  std::lock_guard lock(mutex);
  if (++malformed > 1) return;
  first_malformed = why;
  log(LogLevel::Warning, address.service, "malformed reply from " + options.peer + ": " + why);
}

// For who waited in vain; under the lock.
std::string RemoteChannel::State::what_came_malformed() const {
  const std::uint64_t headless = replies ? replies->malformed() : 0;
  if (malformed + headless == 0) return {};
  return "; " + std::to_string(malformed + headless) +
         " malformed replies came on this connection, the first: " +
         (malformed > 0 ? first_malformed : "no PLAIN_CDR encapsulation header") +
         ". The network damages packets, or the two sides were built from different IDL";
}

void RemoteChannel::State::on_opened(std::span<const std::byte> message,
                                     const wire::ReplyHead& head) {
  std::exception_ptr refused;
  // A server that is not built with Skein does not know `open`; that it says so proves it ready.
  // One that is refuses with a trailer.
  const bool unknown = head.exception == wire::RemoteException::UnknownOperation ||
                       (head.exception == wire::RemoteException::Unsupported &&
                        !wire::read_reply_trailer(message, head.result + 1));
  if (head.exception != wire::RemoteException::Ok && !unknown) {
    refused = error_in(message, head, "open", options.peer);
  }
  {
    std::lock_guard lock(mutex);
    if (phase == Phase::Opening) {
      if (refused) {
        refusal = refused;
      } else {
        phase = Phase::Open;
      }
      changed.notify_all();
      return;
    }
  }
  if (refused) dismissed("it has ended the session, as this side was not heard of for its lease");
}

// In the default partition one of several servers may not know this client, and others do.
void RemoteChannel::State::dismissed(const std::string& how) {
  if (!address.provider.is_nil()) lose(how);
}

void RemoteChannel::State::complete(PendingCall& call, std::span<const std::byte> message,
                                    const wire::ReplyHead& head) {
  if (!call.claim()) return;
  std::exception_ptr error;
  try {
    error = read_reply(call.operation(), call.out(), message, head, options.peer).error;
  } catch (const std::exception& malformed) {
    error = unreadable(call.operation(), malformed);
  }
  note_end(head.related.number, call.operation(), error);
  call.finish(std::move(error));
}

std::exception_ptr RemoteChannel::State::unreadable(const OperationInfo& operation,
                                                    const std::exception& malformed) {
  note_malformed(malformed.what());
  return std::make_exception_ptr(
      Internal(options.peer + " answered " + quoted(operation) +
               " with what cannot be read: " + malformed.what() +
               "; the network damaged it, or the two sides were built from different IDL"));
}

// What is wrong with a stream ends it, here and at the server.
void RemoteChannel::State::on_stream_reply(std::uint64_t number, PendingStream& stream,
                                           std::span<const std::byte> message,
                                           const wire::ReplyHead& head) {
  try {
    read_part(number, stream, message, head);
  } catch (const std::exception& malformed) {
    abandon(number);
    stream.fail(unreadable(stream.operation(), malformed));
  }
}

void RemoteChannel::State::read_part(std::uint64_t number, PendingStream& stream,
                                     std::span<const std::byte> message,
                                     const wire::ReplyHead& head) {
  const TypeSupport& type = *stream.operation().out;
  PendingStream::Item item(type.make(), type.destroy);
  Reply reply = read_reply(stream.operation(), item.get(), message, head, options.peer);
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
  if (!stream.claim()) return;
  note_end(number, stream.operation(), reply.error);
  stream.finish(std::move(reply.error));
}

}  // namespace skein::rpc
