#include <algorithm>
#include <optional>
#include <utility>

#include "core/log.hpp"
#include "remote_server_state.hpp"
#include "rpc/wire/common.hpp"
#include "rpc/wire/reply_encoding.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

// How many refusals may wait to be written to a client: no client that waits for them has more
// calls on its way (RemoteChannel::Options::calls_in_flight).
constexpr std::size_t kMaxRefusals = 4096;
// How long a refusal is worth sending; what the call's deadline is may be unknown.
constexpr std::chrono::seconds kRefusalPatience{10};
// How soon replies that found no room are tried again: no port tells when there is some.
constexpr std::chrono::milliseconds kRetryInterval{5};
// How much is written then before an acknowledgment is waited for again: as much as any sender
// takes without blocking `control`.
constexpr std::size_t kRetrySize = 256 << 10;

}  // namespace

// A port's threads never send: the refusal leaves from `control`, by one task for all that wait,
// which finds room there whatever else does.
void RemoteServer::State::refuse(const std::shared_ptr<Client>& client, const RequestId& id,
                                 ErrorCode code, std::string text) {
  {
    std::lock_guard lock(mutex);
    ++counters.refused;
    if (client->refusals.size() >= kMaxRefusals) client->refusals.pop_front();
    client->refusals.push_back({id, code, std::move(text)});
    if (std::exchange(client->refusing, true)) return;
  }
  control.post_or_run([state = weak_from_this(), client] {
    if (const auto self = state.lock()) self->write_refusals(client);
  });
}

void RemoteServer::State::write_refusals(const std::shared_ptr<Client>& client) {
  std::deque<Refusal> refusals;
  {
    std::lock_guard lock(mutex);
    refusals.swap(client->refusals);
    client->refusing = false;
  }
  for (const auto& [id, code, text] : refusals) {
    Bytes message;
    if (code == ErrorCode::Unimplemented) {
      wire::begin_reply(message, id, wire::RemoteException::UnknownOperation, 0,
                        address.representation);
      wire::append_default_branch(message);
      wire::append_trailer(message, wire::ReplyTrailer{code, text});
    } else {
      encode_error(message, address.representation, id, code, text);
    }
    send(client, sender_to(*client), message, clock.now() + kRefusalPatience);
  }
}

void RemoteServer::State::respond(Request& request, const void* out,
                                  const std::exception_ptr& error) {
  const OperationInfo& operation = *request.operation;
  const auto sender = forget(request);
  if (operation.oneway) return;
  thread_local Bytes message;
  if (out || error) {
    encode_outcome(message, address.representation, request.id, operation, out, error);
  } else {
    encode_end(message, address.representation, request.id, operation, request.stream->sent());
  }
  send(request.client, sender, message, request.deadline);
  if (message.capacity() > kKeptCapacity) message = Bytes();
}

void RemoteServer::State::send_item(const std::shared_ptr<Client>& client, const RequestId& id,
                                    const OperationInfo& operation, const void* out,
                                    std::uint64_t position, Instant deadline) {
  thread_local Bytes message;
  encode_item(message, address.representation, id, operation, out, position);
  const bool sent = send(client, sender_to(*client), message, deadline);
  if (message.capacity() > kKeptCapacity) message = Bytes();
  if (!sent) throw Overloaded("the caller of " + quoted(operation) + " takes no replies");
}

// The call is over. Returns the sender to its client, or null.
std::shared_ptr<calls::Sender> RemoteServer::State::forget(const Request& request) {
  std::shared_ptr<calls::Sender> sender;
  {
    std::lock_guard lock(mutex);
    active.erase(request.id);
    sender = request.client->sender;
    if (leaving) less_to_do.notify_all();
  }
  if (options.on_load) options.on_load();
  return sender;
}

std::shared_ptr<calls::Sender> RemoteServer::State::sender_to(const Client& client) const {
  std::lock_guard lock(mutex);
  return client.sender;
}

// False where the reply was lost. A client that stopped reading holds up this thread once, and not
// with each reply: what comes after the one that found no room waits behind it.
bool RemoteServer::State::send(const std::shared_ptr<Client>& client,
                               const std::shared_ptr<calls::Sender>& sender, Bytes& message,
                               Instant deadline) {
  if (!sender) return false;
  if (client->stalled) return keep_unsent(client, message, deadline);
  try {
    sender->send(message, [this, deadline] { return deadline - clock.now(); });
    return true;
  } catch (const Overloaded&) {
    return keep_unsent(client, message, deadline);
  } catch (const Error& error) {
    std::lock_guard lock(mutex);
    note_lost(1, error.what());
    return false;
  }
}

bool RemoteServer::State::keep_unsent(const std::shared_ptr<Client>& client, Bytes& message,
                                      Instant deadline) {
  const std::size_t size = message.size();
  {
    std::lock_guard lock(mutex);
    if (!client->sender) return false;
    if (client->unsent_size + size > kMaxUnsent - unsent_size) {
      note_lost(1, std::to_string(unsent_size) + " octets wait already for clients that take none");
      return false;
    }
    client->unsent.push_back({std::move(message), deadline});
    count_unsent(*client, size);
    client->stalled = true;
    if (std::exchange(client->retrying, true)) return true;
  }
  retry_later(client, kRetryInterval);
  return true;
}

// The client is not kept: the last to let go of it must not be the clock's thread.
void RemoteServer::State::retry_later(const std::shared_ptr<Client>& client, Duration after) {
  const TimerId timer =
      clock.call_after(after, [state = weak_from_this(), weak = std::weak_ptr(client)] {
        const auto self = state.lock();
        if (!self) return;
        self->control.post_or_run([state, weak] {
          const auto self = state.lock();
          const auto client = weak.lock();
          if (self && client) self->send_unsent(client);
        });
      });
  std::lock_guard lock(mutex);
  client->retry = timer;
}

// In their order, once all that was written before has been acknowledged. Others need `control`,
// too: a client for which it has waited in vain gets a fifth of its time at most.
void RemoteServer::State::send_unsent(const std::shared_ptr<Client>& client) {
  Duration pause = kRetryInterval;
  for (std::size_t written = 0; written < kRetrySize;) {
    auto next = next_unsent(*client);
    if (!next) return;
    const Instant begun = clock.now();
    if (!try_to_send(*client, *next, written == 0)) {
      std::lock_guard lock(mutex);
      if (!client->sender) return;
      client->unsent.push_front(std::move(*next));
      count_unsent(*client, client->unsent.front().message.size());
      pause = std::max(pause, 4 * (clock.now() - begun));
      break;
    }
    written += next->message.size();
  }
  retry_later(client, pause);
}

// Nothing, and replies go straight to the sender again, where none waits any more.
std::optional<RemoteServer::State::Unsent> RemoteServer::State::next_unsent(Client& client) {
  std::lock_guard lock(mutex);
  const Instant now = clock.now();
  const auto late = std::erase_if(client.unsent, [&](const Unsent& each) {
    if (each.deadline > now) return false;
    discount_unsent(client, each.message.size());
    return true;
  });
  if (late > 0) note_lost(late, "the client took none before the call's deadline");
  if (client.unsent.empty()) {
    client.stalled = client.retrying = false;
    return std::nullopt;
  }
  std::optional<Unsent> next(std::move(client.unsent.front()));
  client.unsent.pop_front();
  discount_unsent(client, next->message.size());
  return next;
}

bool RemoteServer::State::try_to_send(Client& client, const Unsent& reply, bool await_room) {
  using namespace std::chrono_literals;
  const auto sender = sender_to(client);
  if (!sender) return true;
  try {
    if (await_room && !sender->await_taken(0ms)) return false;
    sender->send(reply.message, [&] { return reply.deadline - clock.now(); });
  } catch (const Overloaded&) {
    return false;
  } catch (const Error& error) {
    std::lock_guard lock(mutex);
    note_lost(1, error.what());
  }
  return true;
}

// These under the lock.
void RemoteServer::State::count_unsent(Client& client, std::size_t size) {
  client.unsent_size += size;
  unsent_size += size;
}

void RemoteServer::State::discount_unsent(Client& client, std::size_t size) {
  client.unsent_size -= size;
  unsent_size -= size;
}

void RemoteServer::State::note_lost(std::uint64_t count, const std::string& why) {
  if (counters.lost == 0) log(LogLevel::Warning, address.service, "a reply was lost: " + why);
  counters.lost += count;
}

}  // namespace skein::rpc
