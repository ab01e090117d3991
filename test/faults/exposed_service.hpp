#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "brokerless_discovery/broker.hpp"
#include "call_port/dds_call_port.hpp"
#include "entity/entity_access.hpp"
#include "rpc/server/remote_server.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "test/connector/echo_service.hpp"
#include "test/tools/describe.hpp"

namespace skein::test {

inline brokerless_discovery::ServiceDescription describe_echo(const Guid& provider,
                                                              const std::string& entity) {
  return describe(::test::LouderEcho::interface_info(), provider, entity);
}

/// A service in an entity, with what the entity hides in sight: its server's counters and its
/// clients' sessions.
class ExposedService {
 public:
  template <class Implementation>
  ExposedService(Entity& entity, std::shared_ptr<Implementation> implementation,
                 std::size_t queue = 4096)
      : executor_("exposed"),
        service_(std::make_shared<rpc::Service>(
            std::make_shared<typename Implementation::Skeleton>(std::move(implementation)),
            executor_, entity.clock(), service_options(entity.broker().new_provider(), queue))),
        port_(EntityAccess::participant(entity)),
        server_(port_, control_, entity.clock(), service_, {}),
        registration_(entity.broker().add_service(
            describe(service_->interface_info(), id(), entity.options().name))) {}

  const Guid& id() const { return service_->id(); }
  calls::Address address() const { return {std::string(service_->interface_info().name), id()}; }
  rpc::RemoteServer::Counters counters() const { return server_.counters(); }

  /// From now on no session is opened: who asks for one hears that the service is Overloaded.
  void fill() { full_ = true; }

  /// Sessions that have not ended.
  std::size_t sessions() const {
    std::lock_guard lock(mutex_);
    std::size_t count = 0;
    for (const auto& session : sessions_) count += session.expired() ? 0 : 1;
    return count;
  }

 private:
  rpc::Service::Options service_options(const Guid& id, std::size_t queue) {
    rpc::Service::Options options;
    options.id = id;
    options.queue = queue;
    options.open = [this](const rpc::OpenRequest&) {
      if (full_) throw Overloaded("no room for one more session");
      auto session = std::make_shared<Session>();
      std::lock_guard lock(mutex_);
      sessions_.push_back(session);
      return session;
    };
    return options;
  }

  std::atomic<bool> full_{false};
  mutable std::mutex mutex_;
  std::vector<std::weak_ptr<Session>> sessions_;
  ThreadExecutor control_{"control"};
  ThreadExecutor executor_;
  std::shared_ptr<rpc::Service> service_;
  calls::DdsCallPort port_;
  rpc::RemoteServer server_;
  brokerless_discovery::Broker::Registration registration_;
};

}  // namespace skein::test
