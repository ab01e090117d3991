#pragma once

#include <exception>
#include <memory>

#include "rpc/service/call_journal.hpp"
#include "rpc/service/call_recorder.hpp"
#include "rpc/service/invocation.hpp"
#include "rpc/service/service_meter.hpp"

namespace skein::rpc {

/// Reports a service's calls to its meters, to the journal, to the recorder. Thread-safe.
struct CallAccounts {
  const InterfaceInfo& interface;
  const std::shared_ptr<CallJournal> journal;    ///< May be null.
  const std::shared_ptr<CallRecorder> recorder;  ///< May be null.
  ServiceMeter meter{interface};

  /// The meter of its operation.
  OperationMeter& received(const OperationInfo& operation, const Invocation& frame) {
    OperationMeter& counters = meter.of(operation);
    OperationMeter::count(counters.received);
    if (journal) {
      journal->note(introspection::CallStep::Received, frame.connection, frame.number,
                    interface.name, operation);
    }
    return counters;
  }

  /// With a null `error`, by its answer.
  void ended(const OperationInfo& operation, const Invocation& frame,
             const std::exception_ptr& error) const {
    if (!journal) return;
    journal->note_end(true, frame.connection, frame.number, interface.name, operation, error);
  }

  CallRecorder::Tap tap(const OperationInfo& operation, const Invocation& frame,
                        const void* in) const {
    return {recorder.get(), interface, operation, {frame.connection, frame.number}, in};
  }
};

}  // namespace skein::rpc
