#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "../connector/echo_service.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity/entity.hpp"
#include "skein/rpc/dds_server.hpp"

namespace skein::test {

/// The description of a service, as an entity would register it.
inline brokerless_discovery::ServiceDescription describe(const InterfaceInfo& interface,
                                                         const Guid& provider,
                                                         const std::string& entity) {
  brokerless_discovery::ServiceDescription description;
  description.provider = provider.bytes;
  description.service = interface.name;
  description.entity = entity;
  for (const InterfaceInfo* base : interface.bases) description.bases.emplace_back(base->name);
  for (const OperationInfo& operation : interface.operations) {
    description.operations.push_back(
        {std::string(operation.name), operation.hash, operation.signature});
  }
  return description;
}

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
      : executor_("exposed", 1, queue),
        service_(std::make_shared<rpc::Service>(
            std::make_shared<typename Implementation::Skeleton>(std::move(implementation)),
            executor_, entity.clock(), service_options(entity.broker().new_provider()))),
        server_(entity.participant(), control_, entity.clock(), service_, {}),
        registration_(entity.broker().add_service(
            describe(service_->interface_info(), id(), entity.options().name))) {}

  const Guid& id() const { return service_->id(); }
  rpc::DdsAddress address() const { return {std::string(service_->interface_info().name), id()}; }
  rpc::DdsServer::Counters counters() const { return server_.counters(); }

  /// Sessions that have not ended.
  std::size_t sessions() const {
    std::lock_guard lock(mutex_);
    std::size_t count = 0;
    for (const auto& session : sessions_) count += session.expired() ? 0 : 1;
    return count;
  }

 private:
  rpc::Service::Options service_options(const Guid& id) {
    rpc::Service::Options options;
    options.id = id;
    options.open = [this](const rpc::OpenRequest&) {
      auto session = std::make_shared<Session>();
      std::lock_guard lock(mutex_);
      sessions_.push_back(session);
      return session;
    };
    return options;
  }

  mutable std::mutex mutex_;
  std::vector<std::weak_ptr<Session>> sessions_;
  ThreadExecutor control_{"control"};
  ThreadExecutor executor_;
  std::shared_ptr<rpc::Service> service_;
  rpc::DdsServer server_;
  brokerless_discovery::Broker::Registration registration_;
};

}  // namespace skein::test
