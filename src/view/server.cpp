#include "view/server.hpp"

#include <optional>
#include <utility>

#include "view/client.hpp"
#include "view/server_state.hpp"
#include "view/web_socket.hpp"

namespace skein::view {
namespace {

/// Tasks are bounded elsewhere: one of each channel, and the calls that clients may make.
constexpr std::size_t kNoLimit = SIZE_MAX;

WebSocketOptions web_socket_options(const Options& options) {
  return {std::string(kProtocol), options.address,   options.port,    options.max_clients,
          options.max_message,    options.handshake, options.patience};
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

struct Server::Parts {
  explicit Parts(const Options& options)
      : state(std::make_shared<ServerState>(options, callbacks)),
        listener(
            std::in_place, web_socket_options(options),
            [gate = Gate(options.token, options.origins)](const Visit& visit) {
              return gate.refusal(visit);
            },
            [state = state](Connection& connection) {
              return std::make_unique<Client>(state, connection);
            }),
        port(listener->port()) {}

  ThreadExecutor callbacks{"skein-view-call", 1, kNoLimit};
  const std::shared_ptr<ServerState> state;
  std::optional<WebSocketListener> listener;
  const std::uint16_t port;
};

Server::Server(const Options& options) : parts_(std::make_unique<Parts>(options)) {}

Server::~Server() { close(); }

void Server::close() {
  {
    std::lock_guard lock(parts_->state->mutex);
    parts_->state->callbacks = nullptr;
  }
  parts_->listener.reset();
  parts_->callbacks.stop();
}

std::size_t Server::clients() const {
  std::lock_guard lock(parts_->state->mutex);
  return parts_->state->clients.size();
}

std::string Server::url() const {
  const Options& options = parts_->state->options;
  const bool six = options.address.find(':') != std::string::npos;
  return "ws://" + (six ? '[' + options.address + ']' : options.address) + ':' +
         std::to_string(parts_->port) + "/?token=" + options.token;
}

ChannelId Server::add_channel(Channel channel, OnWatched on_watched) {
  ServerState& state = *parts_->state;
  auto watch = std::make_shared<Watch>();
  watch->topic = channel.topic;
  watch->on_watched = std::move(on_watched);
  std::lock_guard lock(state.mutex);
  const ChannelId id = ++state.last_channel;
  watch->channel = id;
  const auto& offered =
      state.channels.emplace(id, OfferedChannel{std::move(channel), std::move(watch)})
          .first->second;
  if (!state.clients.empty()) state.broadcast(advertise({{id, &offered.channel}}));
  return id;
}

void Server::remove_channel(ChannelId channel) {
  ServerState& state = *parts_->state;
  decltype(state.channels)::node_type removed;  // goes outside the lock, with what it has captured
  std::lock_guard lock(state.mutex);
  removed = state.channels.extract(channel);
  if (removed.empty()) return;
  OfferedChannel& offered = removed.mapped();
  for (const auto& [client, subscription] : std::exchange(offered.subscriptions, {})) {
    client->forget(subscription);
  }
  state.note_watched(offered);
  state.broadcast(unadvertise(channel));
}

void Server::send(ChannelId channel, std::uint64_t time, std::span<const std::byte> cdr) {
  ServerState& state = *parts_->state;
  const auto watched = [&] {
    const auto found = state.channels.find(channel);
    return found == state.channels.end() || found->second.subscriptions.empty() ? nullptr
                                                                                : &found->second;
  };
  {
    std::lock_guard lock(state.mutex);
    if (!watched()) return;
  }
  const auto body = std::make_shared<const std::string>(text_of(cdr));
  std::lock_guard lock(state.mutex);
  const OfferedChannel* offered = watched();
  if (!offered) return;
  for (const auto& [client, subscription] : offered->subscriptions) {
    client->push_sample(subscription, message_data(subscription, time, body));
  }
}

ServiceId Server::add_service(Service service, OnCall on_call) {
  ServerState& state = *parts_->state;
  auto held = std::make_shared<const OnCall>(std::move(on_call));
  std::lock_guard lock(state.mutex);
  const ServiceId id = ++state.last_service;
  const auto& offered =
      state.services.emplace(id, OfferedService{std::move(service), std::move(held)}).first->second;
  if (!state.clients.empty()) state.broadcast(advertise_services({{id, &offered.service}}));
  return id;
}

void Server::remove_service(ServiceId service) {
  ServerState& state = *parts_->state;
  decltype(state.services)::node_type removed;  // as in remove_channel()
  std::lock_guard lock(state.mutex);
  removed = state.services.extract(service);
  if (!removed.empty()) state.broadcast(unadvertise_service(service));
}

void Server::set_graph(Graph graph) {
  ServerState& state = *parts_->state;
  std::lock_guard lock(state.mutex);
  const GraphChange changed = change(state.graph, graph);
  state.graph = std::move(graph);
  if (changed.empty()) return;
  const Frame update = graph_update(changed);
  for (const auto& [number, client] : state.clients) {
    if (client->looks_at_graph()) client->push(update);
  }
}

}  // namespace skein::view
