#include "exposed_channel.hpp"

namespace skein::entity {

bool ExposedChannel::runs_here(const CallTime& time) const {
  return ThreadExecutor::worker() == &terms_.worker && !ended_ && time.begin < time.deadline &&
         queued_->connected();
}

void ExposedChannel::call(const OperationInfo& operation, const void* in, void* out,
                          const CallTime& time) {
  bool ran = false;
  if (runs_here(time)) {
    rpc::Invocation frame;
    frame.begun = time.begin;
    frame.deadline = time.deadline;
    frame.outer = CallContext::current();
    const InlineWatch::Watched watched(terms_.watch, terms_.worker, terms_.deadline, terms_.most,
                                       terms_.lost);
    ran = watched.admitted() && service_->try_call_exposed(operation, in, out, frame);
  }
  if (!ran) queued_->call(operation, in, out, time);
}

}  // namespace skein::entity
