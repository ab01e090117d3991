#pragma once

#include <memory>
#include <mutex>
#include <unordered_map>

#include "rpc/service/service.hpp"

namespace skein::rpc {

/// The services of one process, by provider: what lets a connection stay inside it. Thread-safe.
class LocalDirectory {
 public:
  void add(const std::shared_ptr<Service>& service) {
    std::lock_guard lock(mutex_);
    services_[service->id()] = service;
  }

  void remove(const Guid& provider) {
    std::lock_guard lock(mutex_);
    services_.erase(provider);
  }

  /// The service, or nullptr where the provider lives elsewhere.
  std::shared_ptr<Service> find(const Guid& provider) const {
    std::lock_guard lock(mutex_);
    const auto found = services_.find(provider);
    return found == services_.end() ? nullptr : found->second.lock();
  }

 private:
  mutable std::mutex mutex_;
  std::unordered_map<Guid, std::weak_ptr<Service>> services_;
};

}  // namespace skein::rpc
