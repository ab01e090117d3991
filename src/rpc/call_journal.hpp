#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <string_view>

#include "dds/port.hpp"
#include "rpc/introspection_topic.hpp"
#include "skein/detail/operation.hpp"
#include "skein/executor.hpp"
#include "skein/guid.hpp"

namespace skein::introspection {
enum class CallStep : std::uint32_t;
}  // namespace skein::introspection

namespace skein::rpc {

/// What happens to each call of an entity, on the topic `skein/calls`, as a Publisher tells it:
/// while nobody reads, it costs the look at a flag. Thread-safe.
class CallJournal {
 public:
  /// `participant` and `control` live until close(). `entity` is `system/name`.
  CallJournal(dds::Participant& participant, Executor& control, std::string entity);

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
              const std::exception_ptr& error);

  const std::string entity_;
  introspection::Publisher<introspection::CallEvent> publisher_;
};

}  // namespace skein::rpc
