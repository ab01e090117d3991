#pragma once

#include <memory>

#include "idl/types/dynamic_support.hpp"
#include "skein/call.hpp"

namespace skein {

/// A call whose out struct is an idl::DynamicValue.
struct DynamicCall final : PendingCall {
  DynamicCall(const OperationInfo& operation, Instant deadline)
      : PendingCall(operation, &value, deadline, false),
        value{idl::DynamicSupport::of(*operation.out), "{}"} {}
  idl::DynamicValue value;
};

/// Calls of operations of a DynamicInterface, over the connection of another proxy. It may be used
/// with the operations of both forms. Throws what any proxy throws.
class ValueProxy : public ProxyBase {
 public:
  explicit ValueProxy(const ProxyBase& other) : ProxyBase(other) {}
  /// Throws InvalidArgument for a timeout of less than 0.
  ValueProxy(std::shared_ptr<Channel> channel, Duration timeout)
      : ProxyBase(std::move(channel), kDefaultTimeout) {
    set_timeout(timeout);
  }

  idl::DynamicValue call(const OperationInfo& operation, const idl::DynamicValue& in) const {
    idl::DynamicValue out{idl::DynamicSupport::of(*operation.out), "{}"};  // of a oneway
    connection().call(operation, &in, &out, call_time());
    return out;
  }

  std::shared_ptr<DynamicCall> start(const OperationInfo& operation,
                                     const idl::DynamicValue& in) const {
    auto pending = std::make_shared<DynamicCall>(operation, call_time().deadline);
    connection().start(pending, &in);
    return pending;
  }

  std::shared_ptr<PendingStream> stream(const OperationInfo& operation,
                                        const idl::DynamicValue& in) const {
    auto pending = std::make_shared<PendingStream>(operation, call_time().deadline);
    connection().start(pending, &in);
    return pending;
  }
};

}  // namespace skein
