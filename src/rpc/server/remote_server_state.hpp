#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/recent_set.hpp"
#include "newcomers.hpp"
#include "rpc/server/remote_server.hpp"
#include "rpc/wire/shared_use.hpp"
#include "rpc/wire/transit_delay.hpp"
#include "rpc/wire/wire.hpp"
#include "skein/detail/call_memory.hpp"

namespace skein::rpc {

/// Requests come in on the port's thread (remote_server.cpp), clients come and go on `control`
/// (remote_server_clients.cpp), replies leave from the service's executor, refusals and what found
/// no room at first from `control` (remote_server_replies.cpp).
struct RemoteServer::State : std::enable_shared_from_this<State> {
  using RequestId = wire::RequestId;

  struct RequestHash {
    std::size_t operator()(const RequestId& id) const noexcept {
      return std::hash<Guid>()(id.client) + static_cast<std::size_t>(id.number);
    }
  };
  using Active = std::pmr::unordered_map<RequestId, std::shared_ptr<Invocation>, RequestHash>;

  struct Refusal {
    RequestId id;
    ErrorCode code;
    std::string text;
  };

  /// A reply that waits for room in its client's sender.
  struct Unsent {
    Bytes message;
    Instant deadline;
  };

  struct Client {
    std::shared_ptr<calls::Sender>
        sender;  // under the server's mutex; nothing once the server ends
    std::shared_ptr<Session> session;
    std::exception_ptr refusal;  // what the Head threw instead of making a session
    RequestId open;
    bool found = false;                // it would hear what is sent
    std::atomic<bool> stalled{false};  // replies wait in `unsent`, or are about to
    // Under the server's mutex:
    TransitDelay transit;
    TimerId patience = 0;
    TimerId retry = 0;
    std::deque<Refusal> refusals;
    bool refusing = false;  // a task of `control` is about to write them
    std::deque<Unsent> unsent;
    std::size_t unsent_size = 0;
    bool retrying = false;  // a task of `control` is about to send them
  };

  struct Request : Invocation {
    std::weak_ptr<State> server;
    std::shared_ptr<Client> client;
    RequestId id;
  };

  State(calls::ProviderPort& port_, Executor& control_, Clock& clock_,
        std::shared_ptr<Service> service_, Options options_)
      : port(port_),
        control(control_),
        clock(clock_),
        service(std::move(service_)),
        options(std::move(options_)),
        address{std::string(service->interface_info().name), service->id(),
                service->interface_info().representation()} {}

  calls::ProviderPort& port;
  Executor& control;
  Clock& clock;
  const std::shared_ptr<Service> service;
  const Options options;
  const calls::Address address;

  mutable std::mutex mutex;
  std::unordered_map<Guid, std::shared_ptr<Client>> clients;
  Active active{&call_memory()};
  /// Clients whose sessions have ended, in case that one of them comes back.
  RecentSet<Guid> forgotten{1024};
  std::shared_ptr<Client> foreign;  // fixed once requests come
  Newcomers newcomers;
  bool admitting = false;       // a task of `control` is about to look at them
  std::size_t unsent_size = 0;  // of all clients
  Counters counters;            // but for `received`
  std::atomic<std::uint64_t> received{0};
  bool closed = false;
  bool leaving = false;
  std::condition_variable less_to_do;  // once it is leaving
  SharedUse senders;
  std::unique_ptr<calls::Receiver> requests;  // last: goes first, and no listener runs after that

  std::shared_ptr<Client> make_client();
  std::size_t connected() const;

  // ---- on the port's thread
  void on_message(const calls::Message& message);
  void on_unreadable(const calls::Message& message, const Error& why);
  void drop_malformed(const std::string& why);
  void drop_impostor();
  std::shared_ptr<Client> client_of(const calls::Message& message, const wire::RequestHead& head);
  void on_request(const calls::Message& message, const wire::RequestHead& head);
  void accept(const calls::Message& message, const wire::RequestHead& head, Instant arrived,
              const std::shared_ptr<Client>& client);
  std::shared_ptr<OutgoingStream> make_stream(const std::shared_ptr<Client>& client,
                                              const RequestId& id, const Invocation& invocation,
                                              std::uint32_t credit);
  void on_reserved(const calls::Message& message, const wire::RequestHead& head);
  std::shared_ptr<Invocation> find_active(const RequestId& id) const;
  Duration remaining(Client& client, const wire::RequestTrailer& trailer, Instant arrived);
  void refuse(const std::shared_ptr<Client>& client, const RequestId& id, ErrorCode code,
              std::string text);
  void announce(Newcomer newcomer);

  // ---- on the control executor
  void write_refusals(const std::shared_ptr<Client>& client);
  void admit_later();
  void admit_next();
  void open(const Newcomer& newcomer);
  void dismiss(const RequestId& id);
  bool has_room(const Guid& client, std::size_t beyond_of_peer, std::size_t beyond) const;
  void turn_away(const Guid& client);
  void admit(const RequestId& id, const std::shared_ptr<Client>& client);
  void make_reply_sender(const RequestId& id, const std::shared_ptr<Client>& client);
  bool answer_open(const Guid& key);
  void on_reply_receiver(const Guid& key, const std::shared_ptr<Client>& client, bool found);
  bool is_current(const Guid& key, const std::shared_ptr<Client>& client) const;
  bool is_known(const Guid& key, const std::shared_ptr<Client>& client) const;
  void on_request_sender(const Guid& key, bool found);
  void remind(const Guid& key, const std::weak_ptr<Client>& dismissed,
              std::chrono::milliseconds after);
  void end_foreign_calls(const Guid& sender);
  template <class Predicate>
  void cancel_if(Predicate predicate);
  void drop_unless_found(const Guid& key);
  void drop(const Guid& key);
  void send_unsent(const std::shared_ptr<Client>& client);
  std::optional<Unsent> next_unsent(Client& client);
  bool try_to_send(Client& client, const Unsent& reply, bool await_room);
  void count_unsent(Client& client, std::size_t size);
  void discount_unsent(Client& client, std::size_t size);

  // ---- on the service's executor
  void respond(Request& request, const void* out, const std::exception_ptr& error);
  void send_item(const std::shared_ptr<Client>& client, const RequestId& id,
                 const OperationInfo& operation, const void* out, std::uint64_t position,
                 Instant deadline);
  std::shared_ptr<calls::Sender> forget(const Request& request);
  std::shared_ptr<calls::Sender> sender_to(const Client& client) const;
  bool send(const std::shared_ptr<Client>& client, const std::shared_ptr<calls::Sender>& sender,
            Bytes& message, Instant deadline);
  bool keep_unsent(const std::shared_ptr<Client>& client, Bytes& message, Instant deadline);
  void retry_later(const std::shared_ptr<Client>& client, Duration after);
  void note_lost(std::uint64_t count, const std::string& why);
};

}  // namespace skein::rpc
