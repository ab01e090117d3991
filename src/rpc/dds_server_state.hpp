#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>

#include "skein/core/call_memory.hpp"
#include "skein/rpc/dds_server.hpp"
#include "skein/rpc/wire.hpp"
#include "transit_delay.hpp"

namespace skein::rpc {

/// Requests come in on the vendor's thread (dds_server.cpp), clients come and go on `control`
/// (dds_server_clients.cpp), replies leave from the service's executor and refusals from `control`
/// (dds_server_replies.cpp).
struct DdsServer::State : std::enable_shared_from_this<State> {
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

  struct Client {
    std::shared_ptr<dds::Writer> writer;  // under the server's mutex; nothing once the server ends
    std::shared_ptr<Session> session;
    std::exception_ptr refusal;  // what the Head threw instead of making a session
    RequestId open;
    bool matched = false;
    std::atomic<bool> stalled{false};  // did not take a reply in time
    // Under the server's mutex:
    TransitDelay transit;
    std::deque<Refusal> refusals;
    bool refusing = false;  // a task of `control` is about to write them
  };

  struct Request : Invocation {
    std::weak_ptr<State> server;
    std::shared_ptr<Client> client;
    RequestId id;
  };

  State(dds::Participant& participant_, Executor& control_, Clock& clock_,
        std::shared_ptr<Service> service_, Options options_)
      : participant(participant_),
        control(control_),
        clock(clock_),
        service(std::move(service_)),
        options(options_),
        address{std::string(service->interface_info().name), service->id()} {}

  dds::Participant& participant;
  Executor& control;
  Clock& clock;
  const std::shared_ptr<Service> service;
  const Options options;
  const DdsAddress address;

  mutable std::mutex mutex;
  std::unordered_map<Guid, std::shared_ptr<Client>> clients;
  Active active{&call_memory()};
  std::set<Guid> forgotten;  // clients whose sessions have ended
  std::shared_ptr<Client> foreign;
  Counters counters;
  bool closed = false;
  std::unique_ptr<dds::Reader> requests;  // last: goes first, and no listener runs after that

  std::shared_ptr<Client> make_client();

  // ---- on the vendor's thread
  void on_sample(const dds::Sample& sample);
  void drop_malformed(const std::string& why);
  bool is_impostor(const dds::Sample& sample, const wire::RequestHead& head);
  void on_request(const dds::Sample& sample, const wire::RequestHead& head);
  std::shared_ptr<OutgoingStream> make_stream(const std::shared_ptr<Client>& client,
                                              const RequestId& id, const Invocation& invocation,
                                              std::uint32_t credit);
  void on_reserved(const dds::Sample& sample, const wire::RequestHead& head);
  std::shared_ptr<Invocation> find_active(const RequestId& id) const;
  std::shared_ptr<Client> client_of(const RequestId& id, bool skein_client);
  Duration remaining(Client& client, const wire::RequestTrailer& trailer, Instant arrived);
  void refuse(const RequestId& id, ErrorCode code, std::string text);

  // ---- on the control executor
  void write_refusals(Client& client);
  void open(const RequestId& id, const std::string& strategy, const TransitDelay& transit);
  void dismiss(const RequestId& id);
  void admit(const RequestId& id, const std::shared_ptr<Client>& client);
  void make_reply_writer(const RequestId& id, const std::shared_ptr<Client>& client);
  bool answer_open(const Guid& key);
  void on_reply_reader(const Guid& key, const std::shared_ptr<Client>& client, bool matched);
  bool is_current(const Guid& key, const std::shared_ptr<Client>& client) const;
  void on_request_writer(const Guid& key, bool matched);
  void remember_forgotten(const Guid& key);
  void drop_unless_matched(const Guid& key);
  void drop(const Guid& key);

  // ---- on the service's executor
  void respond(Request& request, const void* out, const std::exception_ptr& error);
  void send_item(Client& client, const RequestId& id, const OperationInfo& operation,
                 const void* out, std::uint64_t position);
  void forget(const RequestId& id);
  std::shared_ptr<dds::Writer> writer_of(const Client& client) const;
  bool write(Client& client, const Bytes& message);
};

}  // namespace skein::rpc
