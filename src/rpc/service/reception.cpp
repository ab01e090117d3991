#include "rpc/service/reception.hpp"

#include "rpc/service/service.hpp"

namespace skein::rpc {
namespace {

thread_local const Service* received_for = nullptr;

}  // namespace

bool Reception::is_of(const Service& service) noexcept { return received_for == &service; }

void Reception::work_until(const std::function<bool()>& over) {
  if (!service_.is_quick()) return;
  received_for = &service_;
  requests_->deliver_until([&] { return over() || !service_.is_quick(); });
  received_for = nullptr;
  if (!service_.is_quick()) requests_->take_back();
}

}  // namespace skein::rpc
