#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <string_view>

#include "dds/port/port.hpp"
#include "rpc/service/batch_publisher.hpp"
#include "skein/clock.hpp"
#include "skein/detail/operation.hpp"
#include "skein/executor.hpp"
#include "skein/guid.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::introspection {

/// In memory, some bytes more or less.
std::size_t size_of(const CallEvent& event);

}  // namespace skein::introspection

namespace skein::rpc {

/// What happens to each call of an entity, on the topic `skein/calls`, as a BatchPublisher tells
/// it: while nobody reads, it costs the look at a flag. Thread-safe.
class CallJournal {
 public:
  /// All live until close(). `entity` is `system/name`.
  CallJournal(dds::Participant& participant, Clock& clock, Executor& control, std::string entity);

  /// Nothing is noted from now on, and nothing of the participant is in use any more. Not from a
  /// listener, nor from a task of `control`.
  void close() { publisher_.close(); }

  bool on() const noexcept { return publisher_.on(); }

  /// `client` and `number` are the request's identity, on either side.
  void note(introspection::CallStep step, const Guid& client, std::uint64_t number,
            std::string_view service, const OperationInfo& operation,
            const std::exception_ptr& error = nullptr) {
    if (on()) record(step, client, number, service, operation, error);
  }

  /// The last step, by what the call ended with: Replied or Refused at the server, Answered or
  /// Failed at the client.
  void note_end(bool at_server, const Guid& client, std::uint64_t number, std::string_view service,
                const OperationInfo& operation, const std::exception_ptr& error);

 private:
  void record(introspection::CallStep step, const Guid& client, std::uint64_t number,
              std::string_view service, const OperationInfo& operation,
              const std::exception_ptr& error) noexcept;

  const std::string entity_;
  introspection::BatchPublisher<introspection::CallEvents> publisher_;
};

}  // namespace skein::rpc
