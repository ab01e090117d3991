#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "call_port/call_port.hpp"
#include "core/threads/idle_work.hpp"

namespace skein::rpc {

class Service;

/// Lets a service's own thread take the requests itself while it has nothing else to do, and run
/// them right there, which saves their way to it. While a call takes long, another thread takes
/// what comes, so that cancellations are heard; for a stream, whose reader grants room for its
/// results, from the beginning.
class Reception final : public IdleWork {
 public:
  /// `service` has one thread, whose executor it outlives; `requests` brings its requests.
  Reception(Service& service, std::shared_ptr<calls::CallerDelivery> requests)
      : service_(service), requests_(std::move(requests)) {}

  void work_until(const std::function<bool()>& over) override;
  void wake() override { requests_->wake(); }

  /// Whether this thread is taking requests for this service, of which it is the thread.
  static bool is_of(const Service& service) noexcept;

 private:
  Service& service_;
  const std::shared_ptr<calls::CallerDelivery> requests_;
};

}  // namespace skein::rpc
