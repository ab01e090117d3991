#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "rpc/service/batch_publisher.hpp"
#include "rpc/wire/wire.hpp"
#include "skein/detail/bytes.hpp"
#include "skein/detail/operation.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/stream.hpp"

namespace skein::introspection {

/// In memory, some bytes more or less.
std::size_t size_of(const CallRecord& record);

}  // namespace skein::introspection

namespace skein::rpc {

/// Each call that an entity executes, with what it carries, on the topic `skein/call_records`, as a
/// BatchPublisher tells it: above all transports, and only while somebody reads. Otherwise it costs
/// the look at a flag. Thread-safe.
class CallRecorder {
 public:
  /// All live until close(). `entity` is `system/name`.
  CallRecorder(dds::Participant& participant, Clock& clock, Executor& control, std::string entity);

  /// Nothing is recorded from now on, and nothing of the participant is in use any more. Not from a
  /// listener, nor from a task of `control`.
  void close() { publisher_.close(); }

  /// One call, from its beginning to one of the three ends. Does nothing where nobody read when it
  /// began. What cannot be encoded is recorded as empty: the call itself tells of it.
  class Tap {
   public:
    /// All that it is given outlives it; `recorder` may be null.
    Tap(CallRecorder* recorder, const InterfaceInfo& interface, const OperationInfo& operation,
        const wire::RequestId& id, const void* in);

    /// `out` as call_servant() takes it; the results of a stream are recorded on their way.
    void* passing(void* out);

    void returned(const void* out);
    void raised(const UserException& exception);
    void failed(const std::exception& error);

   private:
    class Items;

    /// The last one, which is no item, takes the arguments.
    introspection::CallRecord record(introspection::CallEnd end);

    CallRecorder* recorder_;  // null where nobody reads
    const InterfaceInfo& interface_;
    const OperationInfo& operation_;
    const wire::RequestId id_;
    std::uint64_t begun_ = 0;
    std::chrono::steady_clock::time_point begun_steadily_;
    std::vector<std::uint8_t> arguments_;
    std::shared_ptr<StreamWriter> items_;
  };

 private:
  const std::string entity_;
  introspection::BatchPublisher<introspection::CallRecords> publisher_;
};

}  // namespace skein::rpc
