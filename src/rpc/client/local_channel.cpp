#include "rpc/client/local_channel.hpp"

#include "rpc/service/call_journal.hpp"
#include "rpc/wire/common.hpp"
#include "rpc/wire/conversion.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/error.hpp"
#include "skein/stream.hpp"

namespace skein::rpc {

namespace {

[[noreturn]] void refuse_closed(const std::string& peer) {
  throw Unavailable("no connection to " + peer +
                    ": it was disconnected, or the entity that had connected has ended");
}

std::exception_ptr too_late(const std::string& peer, const OperationInfo& operation) {
  return std::make_exception_ptr(
      TimedOut(peer + " did not answer " + quoted(operation) + " before its deadline" + kMoreTime));
}

void connect_stream(Invocation& invocation, const std::shared_ptr<PendingCall>& call,
                    Clock& clock) {
  const auto stream = std::static_pointer_cast<PendingStream>(call);
  const TypeSupport& type = *call->operation().out;
  invocation.stream = std::make_shared<OutgoingStream>(
      *invocation.operation, clock, call->deadline(), PendingStream::kWindow,
      [stream, &type, &served = *invocation.operation->out](const void* out, std::uint64_t) {
        PendingStream::Item item(type.make(), type.destroy);
        convert(served, out, type, item.get());
        stream->deliver(std::move(item));
      });
  stream->set_granter([outgoing = std::weak_ptr(invocation.stream)](std::uint32_t count) {
    if (const auto alive = outgoing.lock()) alive->grant(count);
  });
}

/// The service's own operation where the caller's may be of another version, with other C++ types.
const OperationInfo& served_operation(const Service& service, const OperationInfo& called) {
  const OperationInfo* served = service.interface_info().find_operation(called.hash);
  if (!served) {
    throw Unimplemented(std::string(service.interface_info().name) + " has no operation " +
                        quoted(called));
  }
  return served->in == called.in && served->out == called.out ? called : *served;
}

}  // namespace

std::shared_ptr<LocalChannel> LocalChannel::open(const std::weak_ptr<Service>& service,
                                                 std::shared_ptr<Clock> clock,
                                                 std::shared_ptr<Executor> continuations,
                                                 const std::string& strategy,
                                                 std::shared_ptr<CallJournal> journal) {
  std::shared_ptr<LocalChannel> channel(
      new LocalChannel(service, std::move(clock), std::move(continuations), std::move(journal)));
  const auto target = service.lock();
  if (!target) throw Unavailable("the service has been withdrawn");
  channel->peer_ = std::make_shared<std::string>(std::string(target->interface_info().name) +
                                                 " in this process");
  channel->leaving_ = target->leaving();
  channel->session_ = target->open({Guid{}, strategy});
  return channel;
}

LocalChannel::LocalChannel(std::weak_ptr<Service> service, std::shared_ptr<Clock> clock,
                           std::shared_ptr<Executor> continuations,
                           std::shared_ptr<CallJournal> journal)
    : service_(std::move(service)),
      clock_(std::move(clock)),
      continuations_(std::move(continuations)),
      journal_(std::move(journal)) {}

std::shared_ptr<Service> LocalChannel::service() const {
  auto service = service_.lock();
  if (service && !queued_.closed()) return service;
  if (service) refuse_closed(*peer_);
  throw NotSent("no connection to " + *peer_ + ": it was withdrawn");
}

std::optional<ConnectionInfo> LocalChannel::info() const {
  const auto service = service_.lock();
  if (!service || queued_.closed()) return std::nullopt;
  return ConnectionInfo{
      std::string(service->interface_info().name), service->id(), "process", "", queued_.size(),
      calls_.load(std::memory_order_relaxed)};
}

void LocalChannel::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  call->attempt([&] { start_here(call, in); });
}

void LocalChannel::start_here(const std::shared_ptr<PendingCall>& call, const void* in) {
  try {
    enqueue(*service(), call, in);
  } catch (const NotSent&) {
    throw;
  } catch (...) {
    call->fail(std::current_exception());
  }
}

void LocalChannel::call(const OperationInfo& operation, const void* in, void* out,
                        const CallTime& time) {
  const auto target = service();
  if (target->thread() == CallThread::Own || &served_operation(*target, operation) != &operation) {
    return Channel::call(operation, in, out, time);
  }
  Invocation frame;
  frame.connection = id_;
  frame.number = next_number();
  frame.begun = time.begin;
  frame.deadline = time.deadline;
  frame.outer = CallContext::current();
  frame.session =
      std::shared_ptr<Session>(std::shared_ptr<void>(), session_.get());  // owned by this
  const auto note_end = [&](const std::exception_ptr& error) {
    if (!journal_) return;
    journal_->note_end(false, id_, frame.number, target->interface_info().name, operation, error);
  };
  note_begin(*target, operation, frame.number);
  try {
    target->call_here(operation, in, out, frame);
  } catch (...) {
    note_end(std::current_exception());
    throw;
  }
  note_end(nullptr);
}

std::uint64_t LocalChannel::next_number() noexcept {
  return calls_.fetch_add(1, std::memory_order_relaxed) + 1;
}

void LocalChannel::note_begin(const Service& service, const OperationInfo& operation,
                              std::uint64_t number) const {
  if (!journal_) return;
  journal_->note(introspection::CallStep::Sent, id_, number, service.interface_info().name,
                 operation);
}

void LocalChannel::disconnect() {
  for (const auto& queued : queued_.close()) queued->call->cancel();
}

void LocalChannel::lose(const std::string& how) {
  for (const auto& queued : queued_.close()) {
    queued->give_up(std::make_exception_ptr(
        Disconnected("the connection to " + *peer_ + " is gone (" + how + "); whether " +
                     quoted(queued->call->operation()) + " ran is unknown")));
  }
}

void LocalChannel::enqueue(Service& service, const std::shared_ptr<PendingCall>& call,
                           const void* in) {
  if (call->claimed()) return;  // nobody waits for it any more
  const std::uint64_t number = next_number();
  const OperationInfo& operation = served_operation(service, call->operation());
  const auto invocation =
      make_shared_in_call_memory<QueuedCall>(call, clock_, journal_, service.interface_info().name);
  invocation->operation = &operation;
  invocation->connection = id_;
  invocation->number = number;
  invocation->in = {operation.in->make(), operation.in->destroy};
  convert(*call->operation().in, in, *operation.in, invocation->in.get());
  invocation->deadline = call->deadline();
  invocation->session = session_;
  if (call->blocking()) invocation->chain = inherited_chain();
  invocation->respond = [self = invocation.get()](const void* out, std::exception_ptr error) {
    self->end(out, std::move(error));
  };
  if (operation.stream) connect_stream(*invocation, call, *clock_);
  note_begin(service, call->operation(), number);
  call->set_canceller([invocation] { invocation->abandon(); });
  try {
    if (!queued_.add(invocation)) refuse_closed(*peer_);
    invocation->timer = clock_->call_at(call->deadline(), [invocation, peer = peer_] {
      invocation->give_up(too_late(*peer, *invocation->operation));
    });
    service.submit(invocation);
  } catch (const NotSent&) {
    clock_->cancel(invocation->timer);
    call->set_canceller(nullptr);
    invocation->note_end(std::current_exception());
    throw;
  } catch (...) {
    clock_->cancel(invocation->timer);
    invocation->give_up(std::current_exception());
  }
  if (!operation.oneway || !call->claim()) return;
  invocation->note_end(nullptr);
  call->finish();
}

}  // namespace skein::rpc
