#include <algorithm>

#include "callback_thread.hpp"
#include "provider_object.hpp"
#include "skein/error.hpp"

namespace skein::c {
namespace {

/// What `info` raises for the value.
std::exception_ptr raised(const ExceptionInfo& info, const idl::DynamicValue& value) {
  try {
    info.raise(&value);
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;  // raise() throws
}

}  // namespace

ReplyObject::ReplyObject(const DynamicInterface& interface, const OperationInfo& operation,
                         ResultObject in, std::shared_ptr<PendingReply> pending,
                         StreamWriter* stream)
    : interface_(interface),
      operation_(operation),
      in_(std::move(in)),
      arguments_(in_.value()),
      pending_(std::move(pending)),
      stream_(stream),
      call_(pending_ ? nullptr : CallContext::current()) {}

ReplyObject::~ReplyObject() {
  if (cancel_gate_) cancel_gate_->close();
}

void ReplyObject::answer(const skein_value& value) {
  if (operation_.stream) {
    throw InvalidArgument(std::string(operation_.name) +
                          " is a stream: push its results by skein_reply_push(), and return");
  }
  if (operation_.oneway) return;
  auto result = checked(*operation_.out, value);
  if (!pending_->claim()) return;
  *static_cast<idl::DynamicValue*>(pending_->out()) = std::move(result);
  pending_->finish(nullptr);
}

void ReplyObject::fail(std::exception_ptr error) {
  if (pending_) {
    if (pending_->claim()) pending_->finish(std::move(error));
    return;
  }
  std::lock_guard lock(mutex_);
  stream_ = nullptr;
  failure_ = std::move(error);
}

void ReplyObject::raise(const std::string& exception, const skein_value& members) {
  const ExceptionInfo& info = interface_.raised(exception);
  const auto declared = std::ranges::find(operation_.raises, &info);
  if (declared == operation_.raises.end()) {
    throw InvalidArgument(std::string(operation_.name) + " does not declare the exception " +
                          exception);
  }
  fail(raised(info, checked(*info.type, members)));
}

bool ReplyObject::push(const skein_value& item, bool wait) {
  std::lock_guard lock(mutex_);
  if (!stream_) {
    throw InvalidArgument(std::string(operation_.name) +
                          (operation_.stream ? " has ended: nothing can be pushed any more"
                                             : " is no stream: answer by skein_reply_answer()"));
  }
  const auto value = checked(*operation_.out, item);
  return stream_->put(&value, wait);
}

template <class Use>
auto ReplyObject::with_call(const Use& use) {
  if (pending_) return use(pending_->call());
  std::lock_guard lock(mutex_);
  if (!call_) throw InvalidArgument(std::string(operation_.name) + " has ended");
  return use(*call_);
}

bool ReplyObject::cancelled() {
  return with_call([](const CallContext& call) { return call.cancelled(); });
}

Duration ReplyObject::time_left() {
  return with_call([](const CallContext& call) { return call.remaining(); });
}

void ReplyObject::on_cancel(const skein_cancel_callbacks& callbacks, std::uint64_t entity) {
  if (!pending_) {
    throw InvalidArgument(std::string(operation_.name) +
                          " is not answered later: ask skein_reply_cancelled()");
  }
  demand(reinterpret_cast<const void*>(callbacks.on_cancel), "on_cancel");
  const auto gate = std::make_shared<CallbackGate>(entity, callbacks.user, callbacks.on_close);
  {
    std::lock_guard lock(mutex_);
    if (cancel_gate_) throw InvalidArgument("this reply has its on_cancel already");
    cancel_gate_ = gate;
  }
  pending_->on_cancel([gate, run = callbacks.on_cancel] {
    callback_thread().post([gate, run] { gate->run(run); });
  });
}

void ReplyObject::end_dispatch() {
  std::lock_guard lock(mutex_);
  stream_ = nullptr;
  call_ = nullptr;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace skein::c

using namespace skein;
using namespace skein::c;

bool skein_reply_answer(skein_reply reply, skein_value result, skein_error error) {
  return attempt(error, [&] {
    find<ReplyObject>(reply)->answer(result);
    remove<ReplyObject>(reply);
  });
}

bool skein_reply_fail(skein_reply reply, skein_error_kind kind, const char* text,
                      skein_error error) {
  return attempt(error, [&] {
    auto thrown = exception_of(kind, text ? text : "");
    find<ReplyObject>(reply)->fail(std::move(thrown));
    remove<ReplyObject>(reply);
  });
}

bool skein_reply_raise(skein_reply reply, const char* exception, skein_value members,
                       skein_error error) {
  return attempt(error, [&] {
    find<ReplyObject>(reply)->raise(text_of(exception, "the exception"), members);
    remove<ReplyObject>(reply);
  });
}

bool skein_reply_push(skein_reply reply, skein_value item, bool* sent, skein_error error) {
  return attempt(error, [&] {
    const bool done = find<ReplyObject>(reply)->push(item, !sent);
    if (sent) *sent = done;
  });
}

bool skein_reply_cancelled(skein_reply reply, bool* out, skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    *out = find<ReplyObject>(reply)->cancelled();
  });
}

bool skein_reply_time_left(skein_reply reply, std::int64_t* out_ns, skein_error error) {
  return attempt(error, [&] {
    demand(out_ns, "out_ns");
    *out_ns = std::chrono::nanoseconds(find<ReplyObject>(reply)->time_left()).count();
  });
}

bool skein_reply_on_cancel(skein_reply reply, const skein_cancel_callbacks* callbacks,
                           skein_error error) {
  return attempt(error, [&] {
    demand(callbacks, "callbacks");
    find<ReplyObject>(reply)->on_cancel(*callbacks, 0);
  });
}

bool skein_reply_free(skein_reply reply, skein_error error) {
  return attempt(error, [&] { remove<ReplyObject>(reply); });
}
