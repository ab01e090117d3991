#include "rpc/service/reception.hpp"

#include "rpc/service/service.hpp"

namespace skein::rpc {
namespace {

thread_local const Service* received_for = nullptr;

}  // namespace

bool Reception::is_of(const Service& service) noexcept { return received_for == &service; }

void Reception::work_until(const std::function<bool()>& over) {
  received_for = &service_;
  requests_->deliver_until(over);
  received_for = nullptr;
  if (service_.forget_stream()) requests_->take_back();
}

}  // namespace skein::rpc
