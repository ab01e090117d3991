#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>

#include "rpc/server/remote_server.hpp"
#include "rpc/server/sessions.hpp"

namespace skein::rpc {

/// Requests come in on the port's thread, and their replies leave from the service's executor.
struct RemoteServer::State : std::enable_shared_from_this<State> {
  using Client = std::shared_ptr<RemoteClient>;

  struct Request : Invocation {
    std::weak_ptr<State> server;
    Client client;
    wire::RequestId id;
  };

  State(calls::ProviderPort& port, Executor& control, Clock& clock_,
        std::shared_ptr<Service> service_, Options options_);

  Clock& clock;
  const std::shared_ptr<Service> service;
  const Options options;
  const calls::Address address;
  ActiveRequests active;
  const std::shared_ptr<Sessions> sessions;
  Client foreign;  // fixed once requests come
  std::atomic<std::uint64_t> received{0};
  std::atomic<std::uint64_t> malformed{0};
  std::atomic<std::uint64_t> refused{0};
  std::atomic<std::uint64_t> unconnected{0};
  std::atomic<bool> leaving{false};
  std::mutex mutex;  // of those who wait, once it is leaving
  std::condition_variable less_to_do;
  std::unique_ptr<calls::Receiver> requests;  // last: goes first, and no listener runs after that

  void on_message(const calls::Message& message);
  void on_unreadable(const calls::Message& message, const Error& why);
  void drop_malformed(const std::string& why);
  Client client_of(const calls::Message& message, const wire::RequestHead& head);
  void on_request(const calls::Message& message, const wire::RequestHead& head);
  void on_reserved(const calls::Message& message, const wire::RequestHead& head);
  std::shared_ptr<Request> read_request(const calls::Message& message,
                                        const wire::RequestHead& head, Instant arrived,
                                        const Client& client);
  void accept(const calls::Message& message, const std::shared_ptr<Request>& request);
  void refuse(RemoteClient& client, const wire::RequestId& id, ErrorCode code, std::string text);
  void forget(const Request& request);
  void note_less_to_do();
  void respond(Request& request, const void* out, const std::exception_ptr& error);
  void send_item(const Request& request, const void* out, std::uint64_t position);
};

}  // namespace skein::rpc
