#include "rpc/local_channel.hpp"

#include <algorithm>

#include "common.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/error.hpp"
#include "skein/stream.hpp"

namespace skein::rpc {
namespace {

/// An invocation that knows its caller.
struct QueuedCall final : Invocation {
  QueuedCall(std::shared_ptr<PendingCall> call_, std::shared_ptr<Clock> clock_)
      : call(std::move(call_)), clock(std::move(clock_)) {}

  void end(const void* out, std::exception_ptr error) {
    clock->cancel(timer);
    if (!call->claim()) return;
    if (!error && out) operation->out->assign(call->out(), out);
    call->finish(std::move(error));
  }

  void expire(const std::string& peer) {
    cancel();
    call->fail(
        std::make_exception_ptr(TimedOut(peer + " did not answer " + std::string(operation->name) +
                                         " before its deadline" + kMoreTime)));
  }

  const std::shared_ptr<PendingCall> call;
  const std::shared_ptr<Clock> clock;
  std::atomic<TimerId> timer{0};
};

void connect_stream(Invocation& invocation, const std::shared_ptr<PendingCall>& call,
                    Clock& clock) {
  const auto stream = std::static_pointer_cast<PendingStream>(call);
  const TypeSupport& type = *call->operation().out;
  invocation.stream = std::make_shared<OutgoingStream>(
      call->operation(), clock, call->deadline(), PendingStream::kWindow,
      [stream, &type](const void* out, std::uint64_t) {
        PendingStream::Item item(type.make(), type.destroy);
        type.assign(item.get(), out);
        stream->deliver(std::move(item));
      });
  stream->set_granter([outgoing = std::weak_ptr(invocation.stream)](std::uint32_t count) {
    if (const auto alive = outgoing.lock()) alive->grant(count);
  });
}

}  // namespace

std::shared_ptr<LocalChannel> LocalChannel::open(const std::weak_ptr<Service>& service,
                                                 std::shared_ptr<Clock> clock,
                                                 std::shared_ptr<Executor> continuations,
                                                 const std::string& strategy) {
  std::shared_ptr<LocalChannel> channel(
      new LocalChannel(service, std::move(clock), std::move(continuations)));
  const auto target = service.lock();
  if (!target) throw Unavailable("the service has been withdrawn");
  channel->peer_ = std::make_shared<std::string>(std::string(target->interface_info().name) +
                                                 " in this process");
  channel->session_ = target->open({Guid{}, strategy});
  return channel;
}

LocalChannel::LocalChannel(std::weak_ptr<Service> service, std::shared_ptr<Clock> clock,
                           std::shared_ptr<Executor> continuations)
    : service_(std::move(service)),
      clock_(std::move(clock)),
      continuations_(std::move(continuations)) {}

std::shared_ptr<Service> LocalChannel::service() const {
  auto service = service_.lock();
  if (service && !closed_) return service;
  throw Unavailable("no connection to " + *peer_ + ": it was " +
                    (service ? "disconnected" : "withdrawn"));
}

void LocalChannel::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  call->attempt([&] { enqueue(*service(), call, in); });
}

void LocalChannel::call(const OperationInfo& operation, const void* in, void* out,
                        const CallTime& time) {
  const auto target = service();
  if (target->thread() == CallThread::Own) return Channel::call(operation, in, out, time);
  Invocation frame;
  frame.connection = id_;
  frame.begun = time.begin;
  frame.deadline = time.deadline;
  frame.outer = CallContext::current();
  frame.session =
      std::shared_ptr<Session>(std::shared_ptr<void>(), session_.get());  // owned by this
  target->call_here(operation, in, out, frame);
}

void LocalChannel::disconnect() {
  for (const auto& call : close()) call->cancel();
}

void LocalChannel::lose(const std::string& how) {
  for (const auto& call : close()) {
    call->abandon(std::make_exception_ptr(
        Disconnected("the connection to " + *peer_ + " is gone (" + how + "); whether " +
                     std::string(call->operation().name) + " ran is unknown")));
  }
}

// The calls that have not ended.
std::vector<std::shared_ptr<PendingCall>> LocalChannel::close() {
  std::vector<std::weak_ptr<PendingCall>> queued;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    queued.swap(queued_);
  }
  std::vector<std::shared_ptr<PendingCall>> calls;
  for (const auto& weak : queued) {
    if (auto call = weak.lock()) calls.push_back(std::move(call));
  }
  return calls;
}

// Until disconnect() may have to end it.
void LocalChannel::remember(const std::shared_ptr<PendingCall>& call) {
  std::lock_guard lock(mutex_);
  if (closed_) throw Unavailable("no connection to " + *peer_ + ": it was disconnected");
  if (queued_.size() >= look_at_) {
    std::erase_if(queued_, [](const std::weak_ptr<PendingCall>& weak) {
      const auto queued = weak.lock();
      return !queued || queued->finished();
    });
    look_at_ = std::max<std::size_t>(16, 2 * queued_.size());
  }
  queued_.push_back(call);
}

void LocalChannel::enqueue(Service& service, const std::shared_ptr<PendingCall>& call,
                           const void* in) {
  const OperationInfo& operation = call->operation();
  const auto invocation = make_shared_in_call_memory<QueuedCall>(call, clock_);
  invocation->operation = &operation;
  invocation->connection = id_;
  invocation->in = {operation.in->make(), operation.in->destroy};
  operation.in->assign(invocation->in.get(), in);
  invocation->deadline = call->deadline();
  invocation->session = session_;
  if (call->blocking()) invocation->chain = inherited_chain();
  invocation->respond = [self = invocation.get()](const void* out, std::exception_ptr error) {
    self->end(out, std::move(error));
  };
  if (operation.stream) connect_stream(*invocation, call, *clock_);
  call->set_canceller([invocation] { invocation->cancel(); });
  remember(call);
  invocation->timer =
      clock_->call_at(call->deadline(), [invocation, peer = peer_] { invocation->expire(*peer); });
  try {
    service.submit(invocation);
  } catch (...) {
    clock_->cancel(invocation->timer);
    throw;
  }
  if (operation.oneway && call->claim()) call->finish();
}

}  // namespace skein::rpc
