#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "skein/core/executor.hpp"
#include "skein/core/guid.hpp"
#include "skein/core/operation.hpp"
#include "skein/dds/port.hpp"
#include "skein/rpc/shared_writers.hpp"

namespace skein::introspection {
struct CallEvent;
enum class CallStep : std::uint32_t;
}  // namespace skein::introspection

namespace skein::rpc {

/// What happens to each call of an entity, on the topic `skein/calls`: best effort, and only while
/// somebody reads it. Off, it costs the look at a flag. On, events wait in a bounded queue for
/// `control`, which writes them; those for which there is no room are dropped and counted.
/// Thread-safe.
class CallJournal : public std::enable_shared_from_this<CallJournal> {
 public:
  static constexpr std::size_t kCapacity = 4096;

  /// `participant` and `control` live until close(). `entity` is `system/name`.
  static std::shared_ptr<CallJournal> open(dds::Participant& participant, Executor& control,
                                           std::string entity);
  ~CallJournal();

  /// Nothing is noted from now on, and nothing of the participant is in use any more. Not from a
  /// listener, nor from a task of `control`.
  void close();

  bool on() const noexcept { return on_.load(std::memory_order_relaxed); }

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
  CallJournal(Executor& control, std::string entity);
  void on_reader(bool matched);
  void record(introspection::CallStep step, const Guid& client, std::uint64_t number,
              std::string_view service, const OperationInfo& operation,
              const std::exception_ptr& error);
  void write_all();

  Executor& control_;
  const std::string entity_;
  std::atomic<bool> on_{false};
  std::mutex mutex_;
  std::size_t readers_ = 0;
  std::uint64_t dropped_ = 0;
  bool writing_ = false;
  std::vector<introspection::CallEvent> events_;
  std::shared_ptr<dds::Writer> writer_;
  SharedWriters writers_;
};

/// Reads that topic, of all entities of the domain whatever their vendor. Its existence switches
/// the journals on.
class CallJournalReader {
 public:
  /// `participant` outlives the reader; `consumer` runs on a vendor's thread: it must return soon.
  CallJournalReader(dds::Participant& participant,
                    std::function<void(const introspection::CallEvent&)> consumer);

  /// Malformed samples, since the start. The log names the first.
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  std::atomic<std::uint64_t> refused_{0};
  std::unique_ptr<dds::Reader> reader_;  // last: goes first
};

}  // namespace skein::rpc
