#include <utility>

#include "common.hpp"
#include "dds_server_state.hpp"
#include "reply_encoding.hpp"
#include "skein/core/error.hpp"
#include "skein/core/log.hpp"

namespace skein::rpc {
namespace {

// How many refusals may wait to be written to a client: no client that waits for them has more
// calls on its way (DdsChannel::Options::calls_in_flight).
constexpr std::size_t kMaxRefusals = 4096;

}  // namespace

// Vendor threads never write: the refusal leaves from `control`, by one task for all that wait,
// which finds room there whatever else does.
void DdsServer::State::refuse(const RequestId& id, ErrorCode code, std::string text) {
  std::shared_ptr<Client> client;
  {
    std::lock_guard lock(mutex);
    ++counters.refused;
    const auto found = clients.find(id.client);
    client = found != clients.end() ? found->second : foreign;
    if (!client) return;
    if (client->refusals.size() >= kMaxRefusals) client->refusals.pop_front();
    client->refusals.push_back({id, code, std::move(text)});
    if (std::exchange(client->refusing, true)) return;
  }
  control.post_or_run([state = weak_from_this(), client] {
    if (const auto self = state.lock()) self->write_refusals(*client);
  });
}

void DdsServer::State::write_refusals(Client& client) {
  std::deque<Refusal> refusals;
  {
    std::lock_guard lock(mutex);
    refusals.swap(client.refusals);
    client.refusing = false;
  }
  for (const auto& [id, code, text] : refusals) {
    Bytes message;
    if (code == ErrorCode::Unimplemented) {
      wire::begin_reply(message, id, wire::RemoteException::UnknownOperation, 0);
      wire::append_default_branch(message);
      wire::append_trailer(message, wire::ReplyTrailer{code, text});
    } else {
      encode_error(message, id, code, text);
    }
    write(client, message);
  }
}

void DdsServer::State::respond(Request& request, const void* out, const std::exception_ptr& error) {
  const OperationInfo& operation = *request.operation;
  forget(request.id);
  if (operation.oneway) return;
  thread_local Bytes message;
  if (out || error) {
    encode_outcome(message, request.id, operation, out, error);
  } else {
    encode_end(message, request.id, operation, request.stream->sent());
  }
  write(*request.client, message);
  if (message.capacity() > kKeptCapacity) message = Bytes();
}

void DdsServer::State::send_item(Client& client, const RequestId& id,
                                 const OperationInfo& operation, const void* out,
                                 std::uint64_t position) {
  thread_local Bytes message;
  encode_item(message, id, operation, out, position);
  const bool sent = write(client, message);
  if (message.capacity() > kKeptCapacity) message = Bytes();
  if (!sent) throw Overloaded("the caller of " + std::string(operation.name) + " takes no replies");
}

void DdsServer::State::forget(const RequestId& id) {
  {
    std::lock_guard lock(mutex);
    active.erase(id);
  }
  if (options.on_load) options.on_load();
}

std::shared_ptr<dds::Writer> DdsServer::State::writer_of(const Client& client) const {
  std::lock_guard lock(mutex);
  return client.writer;
}

// False where the reply was lost.
bool DdsServer::State::write(Client& client, const Bytes& message) {
  using namespace std::chrono_literals;
  const auto writer = writer_of(client);
  if (!writer) return false;
  try {
    // A client that stopped reading may hold up this thread once, and not with each reply.
    if (client.stalled && !writer->wait_for_acknowledgments(0ms)) return false;
    client.stalled = false;
    writer->write(message);
    return true;
  } catch (const Error& error) {
    client.stalled = error.code() == ErrorCode::Overloaded;
    log(LogLevel::Warning, address.service, std::string("a reply was lost: ") + error.what());
    return false;
  }
}

}  // namespace skein::rpc
