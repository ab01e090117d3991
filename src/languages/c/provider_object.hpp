#pragma once

#include <exception>
#include <memory>
#include <mutex>
#include <string>

#include "interface_object.hpp"
#include "skein/call_context.hpp"
#include "skein/detail/pending_reply.hpp"
#include "skein/stream.hpp"

namespace skein::c {

/// A service that C provides.
struct ProviderObject {
  std::weak_ptr<EntityObject> entity;
  Guid identity;
  std::shared_ptr<CallbackGate> gate;
};
SKEIN_NAMES(skein_provider, Provider, ProviderObject);

/// What C owes for one call. Thread-safe.
class ReplyObject {
 public:
  /// For a call that is answered later: `pending`. For a stream: `stream`, until end_dispatch().
  /// With neither for a oneway call.
  ReplyObject(const DynamicInterface& interface, const OperationInfo& operation, ResultObject in,
              std::shared_ptr<PendingReply> pending, StreamWriter* stream);
  ~ReplyObject();
  ReplyObject(const ReplyObject&) = delete;
  ReplyObject& operator=(const ReplyObject&) = delete;

  const skein_value& arguments() const noexcept { return arguments_; }
  const char* operation() const noexcept { return operation_.name.data(); }

  /// Throws InvalidArgument, and changes nothing, for what is no result of the operation.
  void answer(const skein_value& value);
  void fail(std::exception_ptr error);
  /// Throws InvalidArgument for what is no such exception of the operation.
  void raise(const std::string& exception, const skein_value& members);
  /// False if the caller is too far behind, and `wait` is false.
  bool push(const skein_value& item, bool wait);
  bool cancelled();
  Duration time_left();
  void on_cancel(const skein_cancel_callbacks& callbacks, std::uint64_t entity);

  /// on_call has returned: a stream's writer is gone. Throws what a stream failed with.
  void end_dispatch();

 private:
  /// Runs `use(CallContext)`. Throws InvalidArgument for a stream that has ended.
  template <class Use>
  auto with_call(const Use& use);

  const DynamicInterface& interface_;
  const OperationInfo& operation_;
  const ResultObject in_;
  const skein_value arguments_;
  const std::shared_ptr<PendingReply> pending_;
  std::mutex mutex_;  // of the following; held by push()
  StreamWriter* stream_;
  const CallContext* call_;  // while on_call runs, where there is no `pending`
  std::exception_ptr failure_;
  std::shared_ptr<CallbackGate> cancel_gate_;
};
SKEIN_NAMES(skein_reply, Reply, ReplyObject);

}  // namespace skein::c
