#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "core/threads/idle_work.hpp"
#include "dds/port/port.hpp"

namespace skein::rpc {

class Service;

/// Requests are taken by the service's own thread while it has nothing else to do, and run right
/// there, which saves their way to it: as long as its calls have been quick (Service::is_quick()).
/// Else another thread takes them, so that a long call keeps no cancellation waiting.
class Reception final : public IdleWork {
 public:
  /// `service` has one thread, whose executor it outlives; `requests` brings its requests.
  Reception(const Service& service, std::shared_ptr<dds::CallerDelivery> requests)
      : service_(service), requests_(std::move(requests)) {}

  void work_until(const std::function<bool()>& over) override;
  void wake() override { requests_->wake(); }

  /// Whether this thread is taking requests for this service, of which it is the thread.
  static bool is_of(const Service& service) noexcept;

 private:
  const Service& service_;
  const std::shared_ptr<dds::CallerDelivery> requests_;
};

}  // namespace skein::rpc
