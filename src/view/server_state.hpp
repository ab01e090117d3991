#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "skein/executor.hpp"
#include "view/server.hpp"
#include "view/server_messages.hpp"

namespace skein::view {

class Client;

/// Whether anybody watches a channel; shared with the task that tells its owner.
struct Watch {
  std::string topic;
  ChannelId channel = 0;
  Server::OnWatched on_watched;
  bool watched = false;
  bool told = false;     // what the owner knows
  bool waiting = false;  // a task will tell him
};

struct OfferedChannel {
  Channel channel;
  std::shared_ptr<Watch> watch;
  std::map<Client*, std::uint32_t> subscriptions{};
};

struct OfferedService {
  Service service;
  std::shared_ptr<const Server::OnCall> on_call;
};

/// What the server and its clients share. Functions and members are used under the lock.
struct ServerState : std::enable_shared_from_this<ServerState> {
  ServerState(const Options& options, Executor& callbacks);

  /// To all clients.
  void broadcast(const Frame& message);
  /// Does nothing where the channel is gone.
  void unsubscribe(Client& client, ChannelId channel);
  /// After each change of its subscriptions.
  void note_watched(OfferedChannel& channel);
  Frame all_channels() const;
  Frame all_services() const;

  const Options options;
  const std::string session;

  std::mutex mutex;
  Executor* callbacks;  // none once it is closed
  std::map<std::uint64_t, Client*> clients{};
  std::uint64_t last_client = 0;
  std::map<ChannelId, OfferedChannel> channels{};
  ChannelId last_channel = 0;
  std::map<ServiceId, OfferedService> services{};
  ServiceId last_service = 0;
  Graph graph{};

 private:
  void tell(const std::shared_ptr<Watch>& watch);
};

/// A call that a client has made.
class Answer::Call {
 public:
  Call(std::weak_ptr<ServerState> state, std::uint64_t client, ServiceId service,
       std::uint32_t call);
  ~Call();

  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  void respond(std::string response);
  void fail(const std::string& text);

 private:
  void end(Frame answer);

  const std::weak_ptr<ServerState> state_;
  const std::uint64_t client_;
  const ServiceId service_;
  const std::uint32_t call_;
  bool ended_ = false;  // under the state's lock
};

}  // namespace skein::view
