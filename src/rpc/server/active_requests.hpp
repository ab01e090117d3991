#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "rpc/service/invocation.hpp"
#include "rpc/wire/wire.hpp"
#include "skein/detail/call_memory.hpp"

namespace skein::rpc {

/// Requests that wait or run. Thread-safe.
class ActiveRequests {
 public:
  using RequestId = wire::RequestId;

  void add(const RequestId& id, const std::shared_ptr<Invocation>& invocation);
  /// Does nothing if another call has this number now.
  void remove(const RequestId& id, const Invocation& call);
  /// Null if there is none.
  std::shared_ptr<Invocation> find(const RequestId& id) const;
  std::size_t size() const;

  /// Cancels those for which `predicate` holds, but not oneway calls: their caller may leave as
  /// soon as they are sent.
  void cancel_if(
      const std::function<bool(const RequestId& id, const Invocation& call)>& predicate) const;

 private:
  struct Hash {
    std::size_t operator()(const RequestId& id) const noexcept {
      return std::hash<Guid>()(id.client) + static_cast<std::size_t>(id.number);
    }
  };

  mutable std::mutex mutex_;
  std::pmr::unordered_map<RequestId, std::shared_ptr<Invocation>, Hash> all_{&call_memory()};
};

}  // namespace skein::rpc
