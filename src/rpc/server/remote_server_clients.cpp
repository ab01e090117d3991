#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/log.hpp"
#include "remote_server_state.hpp"
#include "rpc/wire/common.hpp"
#include "rpc/wire/reply_encoding.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

// How long an opened client may take to be found at its receiver before it is forgotten.
constexpr std::chrono::seconds kOpenPatience{10};
constexpr std::chrono::milliseconds kFirstReminder{20};
constexpr std::chrono::milliseconds kLastReminder{2000};
// How many clients beyond its share are told so: of each peer, and in all.
constexpr std::size_t kRefusedOfPeer = 16;
constexpr std::size_t kRefused = 128;

}  // namespace

// The last to let go of a client may be a port's thread, which must not destroy its sender; or
// the thread of a call that hung, when the server has ended, and taken the sender with it.
std::shared_ptr<RemoteServer::State::Client> RemoteServer::State::make_client() {
  return {new Client, [state = weak_from_this()](Client* client) {
            const std::shared_ptr<Client> owned(client);
            if (const auto self = state.lock()) self->control.post_or_run([owned] {});
          }};
}

// Clients are looked at one a task, so that what else waits for `control` has its turn, too. What
// is not taken here is repeated by who sent it.
void RemoteServer::State::announce(Newcomer newcomer) {
  const Guid client = newcomer.id.client;
  {
    std::lock_guard lock(mutex);
    if (!newcomers.push(std::move(newcomer))) {
      turn_away(client);
      return;
    }
    if (std::exchange(admitting, true)) return;
  }
  admit_later();
}

void RemoteServer::State::admit_later() {
  const bool posted = control.post([state = weak_from_this()] {
    if (const auto self = state.lock()) self->admit_next();
  });
  if (posted) return;
  std::lock_guard lock(mutex);
  admitting = false;
}

void RemoteServer::State::admit_next() {
  std::optional<Newcomer> next;
  {
    std::lock_guard lock(mutex);
    next = newcomers.pop();
    if (!next) {
      admitting = false;
      return;
    }
  }
  if (next->left) {
    // Whatever it asked for, a session would be nobody's.
  } else if (next->opens) {
    open(*next);
  } else {
    dismiss(next->id);
  }
  admit_later();
}

void RemoteServer::State::open(const Newcomer& newcomer) {
  const RequestId& id = newcomer.id;
  bool room;
  {
    std::lock_guard lock(mutex);
    if (const auto found = clients.find(id.client); found != clients.end()) {
      found->second->open = id;
      if (!found->second->found) return;
    }
    room = has_room(id.client, 0, 0);
  }
  if (answer_open(id.client)) return;

  auto client = make_client();
  client->open = id;
  client->transit = newcomer.transit;
  try {
    if (!room) {
      throw Overloaded("this client's process has its share of sessions already (at most " +
                       std::to_string(kMaxClientsOfPeer) + " of " + std::to_string(kMaxClients) +
                       "); close connections that are not needed");
    }
    client->session = service->open({id.client, newcomer.strategy});
  } catch (...) {
    client->refusal = std::current_exception();
  }
  if (!room) {
    std::lock_guard lock(mutex);
    turn_away(id.client);
    if (!has_room(id.client, kRefusedOfPeer, kRefused)) return;
  }
  admit(id, client);
}

// Under the lock: whether one more client of that peer is within the limits, or so many beyond.
bool RemoteServer::State::has_room(const Guid& client, std::size_t beyond_of_peer,
                                   std::size_t beyond) const {
  const Guid peer = client.participant();
  const auto of_peer =
      static_cast<std::size_t>(std::count_if(clients.begin(), clients.end(), [&](const auto& each) {
        return each.first.participant() == peer;
      }));
  const std::size_t most = kMaxClients + beyond;
  const std::size_t left = most - std::min(most, clients.size());
  return of_peer < std::min(kMaxClientsOfPeer + beyond_of_peer, left);
}

// Under the lock.
void RemoteServer::State::turn_away(const Guid& client) {
  if (++counters.turned_away > 1) return;
  log(LogLevel::Warning, address.service,
      "participant " + client.participant().hex() +
          " opens more sessions than its share (at most " + std::to_string(kMaxClientsOfPeer) +
          " of " + std::to_string(kMaxClients) + "); what is beyond it is refused");
}

// This side forgot the client (it was stopped, or cut off), and the client did not notice: it
// hears so once its receiver is found. What it sent may be a repetition, so it is never
// executed.
void RemoteServer::State::dismiss(const RequestId& id) {
  {
    std::lock_guard lock(mutex);
    if (const auto found = clients.find(id.client); found != clients.end())
      found->second->open = id;
  }
  if (answer_open(id.client)) return;
  {
    std::lock_guard lock(mutex);
    if (!has_room(id.client, kRefusedOfPeer, kRefused)) return turn_away(id.client);
  }
  auto client = make_client();
  client->open = id;
  client->refusal = std::make_exception_ptr(
      Disconnected("the session has ended, as the client was not heard of for its lease"));
  admit(id, client);
  remind(id.client, client, kFirstReminder);
}

// A receiver that has found a sender only just may miss what that sends, and who waits for a call's
// end asks for nothing again.
void RemoteServer::State::remind(const Guid& key, const std::weak_ptr<Client>& dismissed,
                                 std::chrono::milliseconds after) {
  if (after > kLastReminder) return;
  clock.call_after(after, [state = weak_from_this(), key, dismissed, after] {
    const auto self = state.lock();
    if (!self) return;
    self->control.post_or_run([state, key, dismissed, after] {
      const auto self = state.lock();
      const auto client = dismissed.lock();
      if (!self || !client || !self->is_current(key, client)) return;
      self->answer_open(key);
      self->remind(key, dismissed, 2 * after);
    });
  });
}

void RemoteServer::State::admit(const RequestId& id, const std::shared_ptr<Client>& client) {
  try {
    make_reply_sender(id, client);
  } catch (const Error& error) {
    log(LogLevel::Error, address.service,
        std::string("a client cannot be answered: ") + error.what());
    return drop(id.client);
  }
  answer_open(id.client);
  const TimerId patience =
      clock.call_after(kOpenPatience, [state = weak_from_this(), key = id.client] {
        const auto self = state.lock();
        if (!self) return;
        self->control.post_or_run([state, key] {
          if (const auto self = state.lock()) self->drop_unless_found(key);
        });
      });
  std::lock_guard lock(mutex);
  client->patience = patience;
}

void RemoteServer::State::make_reply_sender(const RequestId& id,
                                            const std::shared_ptr<Client>& client) {
  SharedUse::Hold hold;
  {
    std::lock_guard lock(mutex);
    if (closed) return;
    hold = senders.hold();
    clients.emplace(id.client, client);
  }
  auto sender = SharedUse::share(
      port.send_replies(address, id.client,
                        [state = weak_from_this(), key = id.client, weak = std::weak_ptr(client)](
                            const Guid& receiver, bool found) {
                          if (receiver.participant() != key.participant())
                            return;  // somebody who listens in
                          const auto self = state.lock();
                          const auto client = weak.lock();
                          if (self && client) self->on_reply_receiver(key, client, found);
                        }),
      std::move(hold));
  const std::lock_guard lock(mutex);
  if (!closed) client->sender = std::move(sender);
}

// False where there is no such client; answers only a client whose receiver would get the answer.
bool RemoteServer::State::answer_open(const Guid& key) {
  std::shared_ptr<Client> client;
  {
    std::lock_guard lock(mutex);
    const auto found = clients.find(key);
    if (found == clients.end()) return false;
    if (!found->second->found || !found->second->sender) return true;
    client = found->second;
  }
  Bytes message;
  try {
    if (client->refusal) std::rethrow_exception(client->refusal);
    wire::begin_reply(message, client->open, wire::RemoteException::Ok, wire::kOpen,
                      address.representation);
    wire::append_default_branch(message);
  } catch (const Error& error) {
    encode_error(message, address.representation, client->open, error.code(), error.what(),
                 wire::kOpen);
  } catch (const std::exception& error) {
    encode_error(message, address.representation, client->open, ErrorCode::Internal, error.what(),
                 wire::kOpen);
  }
  send(client, sender_to(*client), message, clock.now() + kOpenPatience);
  return true;
}

void RemoteServer::State::on_reply_receiver(const Guid& key, const std::shared_ptr<Client>& client,
                                            bool found) {
  {
    std::lock_guard lock(mutex);
    client->found = found;
  }
  control.post_or_run([state = weak_from_this(), key, client, found] {
    const auto self = state.lock();
    if (!self) return;
    if (found) {
      self->answer_open(key);
    } else if (self->is_current(key, client)) {
      self->drop(key);
    }
  });
}

bool RemoteServer::State::is_current(const Guid& key, const std::shared_ptr<Client>& client) const {
  std::lock_guard lock(mutex);
  return is_known(key, client);
}

// Under the lock.
bool RemoteServer::State::is_known(const Guid& key, const std::shared_ptr<Client>& client) const {
  if (client == foreign) return true;
  const auto found = clients.find(key);
  return found != clients.end() && found->second == client;
}

// A client that leaves before it is admitted takes no session with it. One that comes back after it
// was forgotten may not know that it was, and may wait for an answer to what was lost meanwhile.
void RemoteServer::State::on_request_sender(const Guid& key, bool found) {
  {
    std::lock_guard lock(mutex);
    if (found) {
      if (!forgotten.erase(key)) return;
    } else {
      newcomers.note_left(key);
      if (clients.contains(key)) forgotten.insert(key);
    }
  }
  control.post_or_run([state = weak_from_this(), key, found] {
    const auto self = state.lock();
    if (!self) return;
    if (!found) {
      self->end_foreign_calls(key);
      return self->drop_unless_found(key);
    }
    self->drop(key);
    self->dismiss({key, 0});
  });
}

// One that has no session is known by its sender alone.
void RemoteServer::State::end_foreign_calls(const Guid& sender) {
  cancel_if([&](const RequestId&, const Invocation& call) { return call.connection == sender; });
}

// Cancels unlocked: an implementation that hears of it may answer at once. Oneway calls run all the
// same: their caller may leave as soon as they are sent.
template <class Predicate>
void RemoteServer::State::cancel_if(Predicate predicate) {
  std::vector<std::shared_ptr<Invocation>> cancelled;
  {
    std::lock_guard lock(mutex);
    for (const auto& [id, invocation] : active) {
      if (!invocation->operation->oneway && predicate(id, *invocation))
        cancelled.push_back(invocation);
    }
  }
  for (const auto& invocation : cancelled) invocation->cancel();
}

void RemoteServer::State::drop_unless_found(const Guid& key) {
  {
    std::lock_guard lock(mutex);
    const auto found = clients.find(key);
    if (found == clients.end() || found->second->found) return;
  }
  drop(key);
}

// The client has gone: its session ends, and nobody waits for its calls any more.
void RemoteServer::State::drop(const Guid& key) {
  std::shared_ptr<calls::Sender>
      sender;  // goes here, where its listener can be waited for, and unlocked
  std::shared_ptr<Client> client;
  TimerId patience;
  TimerId retry;
  {
    std::lock_guard lock(mutex);
    const auto found = clients.find(key);
    if (found == clients.end()) return;
    client = std::move(found->second);
    sender = std::move(client->sender);
    patience = client->patience;
    retry = client->retry;
    clients.erase(found);
    if (leaving) less_to_do.notify_all();
    forgotten.insert(key);
    discount_unsent(*client, client->unsent_size);
    client->unsent.clear();
  }
  cancel_if([&](const RequestId& id, const Invocation&) { return id.client == key; });
  clock.cancel(patience);
  clock.cancel(retry);
}

}  // namespace skein::rpc
