#include "common.hpp"
#include "dds_server_state.hpp"
#include "reply_encoding.hpp"
#include "skein/core/error.hpp"
#include "skein/core/log.hpp"

namespace skein::rpc {
namespace {

// How long an opened client may take to match its reply reader before it is forgotten.
constexpr std::chrono::seconds kOpenPatience{10};
// How many clients that have gone are remembered, in case that one of them comes back.
constexpr std::size_t kMaxForgotten = 1024;

}  // namespace

// The last to let go of a client may be a vendor's thread, which must not destroy its writer.
std::shared_ptr<DdsServer::State::Client> DdsServer::State::make_client() {
  return {new Client, [&control = control](Client* client) {
            const std::shared_ptr<Client> owned(client);
            control.post_or_run([owned] {});
          }};
}

void DdsServer::State::open(const RequestId& id, const std::string& strategy,
                            const TransitDelay& transit) {
  {
    std::lock_guard lock(mutex);
    if (const auto found = clients.find(id.client); found != clients.end()) {
      found->second->open = id;
      if (!found->second->matched) return;
    }
  }
  if (answer_open(id.client)) return;

  auto client = make_client();
  client->open = id;
  client->transit = transit;
  try {
    client->session = service->open({id.client, strategy});
  } catch (...) {
    client->refusal = std::current_exception();
  }
  admit(id, client);
}

// This side forgot the client (it was stopped, or cut off), and the client did not notice: it
// hears so once its reply reader is found. What it sent may be a repetition, so it is never
// executed.
void DdsServer::State::dismiss(const RequestId& id) {
  {
    std::lock_guard lock(mutex);
    if (const auto found = clients.find(id.client); found != clients.end())
      found->second->open = id;
  }
  if (answer_open(id.client)) return;
  auto client = make_client();
  client->open = id;
  client->refusal = std::make_exception_ptr(
      Disconnected("the session has ended, as the client was not heard of for its lease"));
  admit(id, client);
}

void DdsServer::State::admit(const RequestId& id, const std::shared_ptr<Client>& client) {
  try {
    make_reply_writer(id, client);
  } catch (const Error& error) {
    log(LogLevel::Error, address.service,
        std::string("a client cannot be answered: ") + error.what());
    return drop(id.client);
  }
  answer_open(id.client);
  clock.call_after(kOpenPatience, [state = weak_from_this(), key = id.client] {
    if (const auto self = state.lock()) self->drop_unless_matched(key);
  });
}

void DdsServer::State::make_reply_writer(const RequestId& id,
                                         const std::shared_ptr<Client>& client) {
  {
    std::lock_guard lock(mutex);
    clients.emplace(id.client, client);
  }
  dds::WriterListener listener;
  listener.on_matched = [state = weak_from_this(), key = id.client, weak = std::weak_ptr(client)](
                            const Guid&, bool matched) {
    const auto self = state.lock();
    const auto client = weak.lock();
    if (self && client) self->on_reply_reader(key, client, matched);
  };
  auto writer = participant.create_writer(address.reply_topic(), call_qos({id.client.hex()}),
                                          std::move(listener));
  const std::lock_guard lock(mutex);
  if (!closed) client->writer = std::move(writer);
}

// False where there is no such client; answers only a client whose reader would get the answer.
bool DdsServer::State::answer_open(const Guid& key) {
  std::shared_ptr<Client> client;
  {
    std::lock_guard lock(mutex);
    const auto found = clients.find(key);
    if (found == clients.end()) return false;
    if (!found->second->matched || !found->second->writer) return true;
    client = found->second;
  }
  Bytes message;
  try {
    if (client->refusal) std::rethrow_exception(client->refusal);
    wire::begin_reply(message, client->open, wire::RemoteException::Ok, wire::kOpen);
    wire::append_default_branch(message);
  } catch (const Error& error) {
    encode_error(message, client->open, error.code(), error.what(), wire::kOpen);
  } catch (const std::exception& error) {
    encode_error(message, client->open, ErrorCode::Internal, error.what(), wire::kOpen);
  }
  write(*client, message);
  return true;
}

void DdsServer::State::on_reply_reader(const Guid& key, const std::shared_ptr<Client>& client,
                                       bool matched) {
  {
    std::lock_guard lock(mutex);
    client->matched = matched;
  }
  control.post_or_run([state = weak_from_this(), key, client, matched] {
    const auto self = state.lock();
    if (!self) return;
    if (matched) {
      self->answer_open(key);
    } else if (self->is_current(key, client)) {
      self->drop(key);
    }
  });
}

bool DdsServer::State::is_current(const Guid& key, const std::shared_ptr<Client>& client) const {
  std::lock_guard lock(mutex);
  const auto found = clients.find(key);
  return found != clients.end() && found->second == client;
}

// A client that comes back after it was forgotten may not know that it was, and may wait for an
// answer to what was lost meanwhile.
void DdsServer::State::on_request_writer(const Guid& key, bool matched) {
  {
    std::lock_guard lock(mutex);
    if (!matched) {
      if (clients.contains(key)) remember_forgotten(key);
      return;
    }
    if (forgotten.erase(key) == 0) return;
  }
  control.post_or_run([state = weak_from_this(), key] {
    const auto self = state.lock();
    if (!self) return;
    self->drop(key);
    self->dismiss({key, 0});
  });
}

void DdsServer::State::remember_forgotten(const Guid& key) {
  if (forgotten.size() >= kMaxForgotten) forgotten.erase(forgotten.begin());
  forgotten.insert(key);
}

void DdsServer::State::drop_unless_matched(const Guid& key) {
  {
    std::lock_guard lock(mutex);
    const auto found = clients.find(key);
    if (found == clients.end() || found->second->matched) return;
  }
  control.post_or_run([state = weak_from_this(), key] {
    if (const auto self = state.lock()) self->drop(key);
  });
}

// The client has gone: its session ends, and nobody waits for its calls any more.
void DdsServer::State::drop(const Guid& key) {
  std::shared_ptr<dds::Writer>
      writer;  // goes here, where its listener can be waited for, and unlocked
  std::shared_ptr<Client> client;
  std::lock_guard lock(mutex);
  const auto found = clients.find(key);
  if (found == clients.end()) return;
  client = std::move(found->second);
  writer = std::move(client->writer);
  clients.erase(found);
  remember_forgotten(key);
  for (const auto& [id, invocation] : active) {
    if (id.client == key) invocation->cancel();
  }
}

}  // namespace skein::rpc
