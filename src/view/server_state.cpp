#include "view/server_state.hpp"

#include <exception>
#include <utility>

#include "core/log.hpp"
#include "core/printable.hpp"
#include "skein/guid.hpp"
#include "view/client.hpp"

namespace skein::view {

ServerState::ServerState(const Options& options_, Executor& callbacks_)
    : options(options_), session(Guid::random().hex()), callbacks(&callbacks_) {}

void ServerState::broadcast(const Frame& message) {
  for (const auto& [number, client] : clients) client->push(message);
}

void ServerState::unsubscribe(Client& client, ChannelId channel) {
  const auto offered = channels.find(channel);
  if (offered == channels.end()) return;
  offered->second.subscriptions.erase(&client);
  note_watched(offered->second);
}

void ServerState::note_watched(OfferedChannel& channel) {
  Watch& watch = *channel.watch;
  watch.watched = !channel.subscriptions.empty();
  if (!watch.on_watched || watch.watched == watch.told || watch.waiting || !callbacks) return;
  watch.waiting =
      callbacks->post([state = shared_from_this(), held = channel.watch] { state->tell(held); });
}

void ServerState::tell(const std::shared_ptr<Watch>& watch) {
  std::unique_lock lock(mutex);
  watch->waiting = false;
  if (watch->told == watch->watched) return;
  watch->told = watch->watched;
  const bool watched = watch->watched;
  lock.unlock();
  try {
    watch->on_watched(watch->channel, watched);
  } catch (const std::exception& error) {
    constexpr std::size_t kLongest = 1024;
    const std::string text = printable(watch->topic + ": " + error.what(), kLongest);
    log(LogLevel::Warning, "view", text);
    lock.lock();
    broadcast(status(Level::Error, text));
  }
}

Frame ServerState::all_channels() const {
  std::map<ChannelId, const Channel*> all;
  for (const auto& [id, offered] : channels) all.emplace(id, &offered.channel);
  return advertise(all);
}

Frame ServerState::all_services() const {
  std::map<ServiceId, const Service*> all;
  for (const auto& [id, offered] : services) all.emplace(id, &offered.service);
  return advertise_services(all);
}

Answer::Call::Call(std::weak_ptr<ServerState> state, std::uint64_t client, ServiceId service,
                   std::uint32_t call)
    : state_(std::move(state)), client_(client), service_(service), call_(call) {}

Answer::Call::~Call() { fail("the service has given no answer"); }

void Answer::Call::respond(std::string response) {
  end(call_response(service_, call_, std::move(response)));
}

void Answer::Call::fail(const std::string& text) { end(call_failure(service_, call_, text)); }

void Answer::Call::end(Frame answer) {
  const auto state = state_.lock();
  if (!state) return;
  std::lock_guard lock(state->mutex);
  if (std::exchange(ended_, true)) return;
  const auto client = state->clients.find(client_);
  if (client == state->clients.end()) return;
  client->second->end_call();
  client->second->push(std::move(answer));
}

void Answer::respond(std::string response) const { call_->respond(std::move(response)); }

void Answer::fail(const std::string& text) const { call_->fail(text); }

}  // namespace skein::view
