#include "sessions.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/log.hpp"
#include "rpc/service/service.hpp"
#include "rpc/wire/reply_encoding.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

// How long a client may take to be found at its receiver before it is forgotten.
constexpr std::chrono::seconds kOpenPatience{10};
constexpr std::chrono::milliseconds kFirstReminder{20};
constexpr std::chrono::milliseconds kLastReminder{2000};
// How many clients beyond its share are told so: of each peer, and in all.
constexpr std::size_t kRefusedOfPeer = 16;
constexpr std::size_t kRefused = 128;

// Whether one more client of that peer is within the limits, or so many beyond.
bool has_room(const std::unordered_map<Guid, std::shared_ptr<RemoteClient>>& clients,
              const Guid& client, std::size_t beyond_of_peer, std::size_t beyond) {
  const Guid peer = client.participant();
  const auto of_peer =
      static_cast<std::size_t>(std::count_if(clients.begin(), clients.end(), [&](const auto& each) {
        return each.first.participant() == peer;
      }));
  const std::size_t most = Sessions::kMost + beyond;
  const std::size_t left = most - std::min(most, clients.size());
  return of_peer < std::min(Sessions::kMostOfPeer + beyond_of_peer, left);
}

}  // namespace

Sessions::Sessions(calls::ProviderPort& port, Service& service, ActiveRequests& active,
                   Executor& control, Clock& clock, std::function<void()> on_left)
    : port_(port),
      service_(service),
      active_(active),
      on_left_(std::move(on_left)),
      context_{control, clock,
               calls::Address{std::string(service.interface_info().name), service.id(),
                              service.interface_info().representation()}},
      admissions_(std::make_shared<Admissions>(control)) {}

// The last owner of a client may be a port's thread, which must not end a session; or the thread of
// a call that hung, when the server has ended.
Sessions::Client Sessions::make_client() {
  const std::shared_ptr<ReplyContext> context(shared_from_this(), &context_);
  return {new RemoteClient(context),
          [weak = std::weak_ptr<ReplyContext>(context)](RemoteClient* client) {
            const std::shared_ptr<RemoteClient> owned(client);
            if (const auto context = weak.lock()) context->control.post_or_run([owned] {});
          }};
}

Sessions::Client Sessions::open_foreign() {
  auto client = make_client();
  client->replies->open(
      SharedUse::share(port_.send_replies(context_.address, Guid{}), senders_.hold()));
  std::lock_guard lock(mutex_);
  foreign_ = client;
  return client;
}

Sessions::Client Sessions::find(const Guid& client) const {
  std::lock_guard lock(mutex_);
  const auto found = clients_.find(client);
  return found == clients_.end() ? nullptr : found->second;
}

void Sessions::announce(Newcomer newcomer) {
  const Guid client = newcomer.id.client;
  const auto admit = [sessions = weak_from_this()](const Newcomer& admitted) {
    const auto self = sessions.lock();
    if (self && !self->ended_) admitted.opens ? self->open(admitted) : self->dismiss(admitted.id);
  };
  if (admissions_->add(std::move(newcomer), admit)) return;
  std::lock_guard lock(mutex_);
  turn_away(client);
}

Sessions::Counts Sessions::counts() const {
  std::lock_guard lock(mutex_);
  const auto connected = std::count_if(clients_.begin(), clients_.end(),
                                       [](const auto& each) { return !each.second->refusal; });
  return {static_cast<std::size_t>(connected), turned_away_, context_.lost};
}

void Sessions::open(const Newcomer& newcomer) {
  const wire::RequestId& id = newcomer.id;
  bool room;
  {
    std::lock_guard lock(mutex_);
    if (const auto found = clients_.find(id.client); found != clients_.end()) {
      found->second->open = id;
      if (!found->second->found) return;
    }
    room = has_room(clients_, id.client, 0, 0);
  }
  if (answer_open(id.client)) return;

  const auto client = make_client();
  client->open = id;
  client->transit = newcomer.transit;
  try {
    if (!room) {
      throw Overloaded("this client's process has its share of sessions already (at most " +
                       std::to_string(kMostOfPeer) + " of " + std::to_string(kMost) +
                       "); close connections that are not needed");
    }
    client->session = service_.open({id.client, newcomer.strategy});
  } catch (...) {
    client->refusal = std::current_exception();
  }
  if (!room) {
    std::lock_guard lock(mutex_);
    turn_away(id.client);
    if (!has_room(clients_, id.client, kRefusedOfPeer, kRefused)) return;
  }
  admit(id, client);
}

// Under the lock.
void Sessions::turn_away(const Guid& client) {
  if (++turned_away_ > 1) return;
  log(LogLevel::Warning, context_.address.service,
      "participant " + client.participant().hex() +
          " opens more sessions than its share (at most " + std::to_string(kMostOfPeer) + " of " +
          std::to_string(kMost) + "); what is beyond it is refused");
}

// This side forgot the client (it was stopped, or cut off), and the client did not notice: it hears
// so once its receiver is found. What it sent may be a repetition, so it is never executed.
void Sessions::dismiss(const wire::RequestId& id) {
  {
    std::lock_guard lock(mutex_);
    if (const auto found = clients_.find(id.client); found != clients_.end())
      found->second->open = id;
  }
  if (answer_open(id.client)) return;
  {
    std::lock_guard lock(mutex_);
    if (!has_room(clients_, id.client, kRefusedOfPeer, kRefused)) return turn_away(id.client);
  }
  const auto client = make_client();
  client->open = id;
  client->refusal = std::make_exception_ptr(
      Disconnected("the session has ended, as the client was not heard of for its lease"));
  admit(id, client);
  remind(id.client, client, kFirstReminder);
}

// A receiver that has found a sender only just may miss what that sends, and a client that waits
// for a call's end asks for nothing again.
void Sessions::remind(const Guid& key, const std::weak_ptr<RemoteClient>& dismissed,
                      std::chrono::milliseconds after) {
  if (after > kLastReminder) return;
  context_.clock.call_after(after, [sessions = weak_from_this(), key, dismissed, after] {
    const auto self = sessions.lock();
    if (!self) return;
    self->context_.control.post_or_run([sessions, key, dismissed, after] {
      const auto self = sessions.lock();
      const auto client = dismissed.lock();
      if (!self || !client || self->find(key) != client) return;
      self->answer_open(key);
      self->remind(key, dismissed, 2 * after);
    });
  });
}

void Sessions::admit(const wire::RequestId& id, const Client& client) {
  SharedUse::Hold hold;
  {
    std::lock_guard lock(mutex_);
    if (ended_) return;
    hold = senders_.hold();
    clients_.emplace(id.client, client);
  }
  const auto on_receiver = [sessions = weak_from_this(), key = id.client,
                            weak = std::weak_ptr(client)](const Guid& receiver, bool found) {
    if (receiver.participant() != key.participant()) return;  // somebody who listens in
    const auto self = sessions.lock();
    const auto client = weak.lock();
    if (self && client) self->on_receiver(key, client, found);
  };
  try {
    auto sender = SharedUse::share(port_.send_replies(context_.address, id.client, on_receiver),
                                   std::move(hold));
    std::lock_guard lock(mutex_);
    if (!ended_) client->replies->open(std::move(sender));
  } catch (const Error& error) {
    log(LogLevel::Error, context_.address.service,
        std::string("a client cannot be answered: ") + error.what());
    return drop(id.client, true);
  }
  answer_open(id.client);
  const TimerId patience =
      context_.clock.call_after(kOpenPatience, [sessions = weak_from_this(), key = id.client] {
        const auto self = sessions.lock();
        if (!self) return;
        self->context_.control.post_or_run([sessions, key] {
          if (const auto self = sessions.lock()) self->drop(key, false);
        });
      });
  std::lock_guard lock(mutex_);
  client->patience = patience;
}

// Returns false if there is no such client; answers only a client that would receive the answer.
bool Sessions::answer_open(const Guid& key) {
  Client client;
  wire::RequestId open;
  {
    std::lock_guard lock(mutex_);
    const auto found = clients_.find(key);
    if (found == clients_.end()) return false;
    client = found->second;
    if (!client->found) return true;
    open = client->open;
  }
  const Representation representation = context_.address.representation;
  Bytes message;
  try {
    if (client->refusal) std::rethrow_exception(client->refusal);
    wire::begin_reply(message, open, wire::RemoteException::Ok, wire::kOpen, representation);
    wire::append_default_branch(message);
  } catch (const Error& error) {
    encode_error(message, representation, open, error.code(), error.what(), wire::kOpen);
  } catch (const std::exception& error) {
    encode_error(message, representation, open, ErrorCode::Internal, error.what(), wire::kOpen);
  }
  client->replies->send(client->replies->sender(), message, context_.clock.now() + kOpenPatience);
  return true;
}

void Sessions::on_receiver(const Guid& key, const Client& client, bool found) {
  {
    std::lock_guard lock(mutex_);
    client->found = found;
  }
  context_.control.post_or_run([sessions = weak_from_this(), key, client, found] {
    const auto self = sessions.lock();
    if (!self) return;
    if (found) {
      self->answer_open(key);
    } else if (self->find(key) == client) {
      self->drop(key, true);
    }
  });
}

// A client that leaves before it is admitted takes no session with it. One that comes back after it
// was forgotten may not know that it was, and may wait for an answer to what was lost meanwhile.
void Sessions::on_sender(const Guid& client, bool found) {
  if (!found) admissions_->note_left(client);
  {
    std::lock_guard lock(mutex_);
    if (found && !forgotten_.erase(client)) return;
    if (!found && clients_.contains(client)) forgotten_.insert(client);
  }
  context_.control.post_or_run([sessions = weak_from_this(), client, found] {
    const auto self = sessions.lock();
    if (!self || self->ended_) return;
    if (found) {
      self->drop(client, true);
      self->dismiss({client, 0});
    } else {
      // One that has no session is known by its sender alone.
      self->active_.cancel_if(
          [&](const auto&, const Invocation& call) { return call.connection == client; });
      self->drop(client, false);
    }
  });
}

// Its session ends, and nobody waits for its calls any more.
void Sessions::drop(const Guid& key, bool even_if_found) {
  Client client;
  TimerId patience;
  {
    std::lock_guard lock(mutex_);
    const auto found = clients_.find(key);
    if (found == clients_.end() || (found->second->found && !even_if_found)) return;
    client = std::move(found->second);
    patience = client->patience;
    clients_.erase(found);
    forgotten_.insert(key);
  }
  client->gone = true;  // a request that is accepted now sees this, or is seen here
  const auto sender = client->replies->close();  // goes here, where its listener can be awaited
  active_.cancel_if([&](const auto& id, const Invocation&) { return id.client == key; });
  on_left_();
  context_.clock.cancel(patience);
}

void Sessions::end() {
  // They end here, where their listeners can be awaited: a listener that still runs may be the last
  // owner of its client, and of the sessions.
  std::vector<std::shared_ptr<calls::Sender>> senders;
  std::vector<Client> clients;
  std::vector<TimerId> timers;
  {
    std::lock_guard lock(mutex_);
    ended_ = true;
    for (auto& [key, client] : clients_) {
      timers.push_back(client->patience);
      clients.push_back(std::move(client));
    }
    clients_.clear();
    if (foreign_) clients.push_back(std::move(foreign_));
  }
  for (const auto& client : clients) senders.push_back(client->replies->close());
  for (const TimerId timer : timers) context_.clock.cancel(timer);
  clients.clear();
  senders.clear();
  senders_.await_end();
}

}  // namespace skein::rpc
