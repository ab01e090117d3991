#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "rpc/client/queued_calls.hpp"
#include "rpc/service/service.hpp"
#include "skein/detail/channel.hpp"

namespace skein::rpc {

class CallJournal;

/// The transport within one process: typed pointers, no bytes. A blocking call to a service with
/// CallThread::Caller runs on the calling thread, and allocates nothing; all others queue.
class LocalChannel final : public Channel, public std::enable_shared_from_this<LocalChannel> {
 public:
  /// Opens a session at the service; throws what the Head throws to refuse it. The caller's
  /// `journal`, which may be null, is told of each call.
  static std::shared_ptr<LocalChannel> open(const std::weak_ptr<Service>& service,
                                            std::shared_ptr<Clock> clock,
                                            std::shared_ptr<Executor> continuations,
                                            const std::string& strategy,
                                            std::shared_ptr<CallJournal> journal);

  void start(const std::shared_ptr<PendingCall>& call, const void* in) override;
  void start_here(const std::shared_ptr<PendingCall>& call, const void* in) override;
  void call(const OperationInfo& operation, const void* in, void* out,
            const CallTime& time) override;
  Clock& clock() const noexcept override { return *clock_; }
  Executor& continuations() const noexcept override { return *continuations_; }
  std::string peer() const override { return *peer_; }
  std::optional<ConnectionInfo> info() const override;
  bool connected() const override { return !queued_.closed() && !*leaving_; }
  void disconnect() override;
  void lose(const std::string& how) override;

 private:
  LocalChannel(std::weak_ptr<Service> service, std::shared_ptr<Clock> clock,
               std::shared_ptr<Executor> continuations, std::shared_ptr<CallJournal> journal);

  std::shared_ptr<Service> service() const;
  std::uint64_t next_number() noexcept;
  void note_begin(const Service& service, const OperationInfo& operation,
                  std::uint64_t number) const;
  void enqueue(Service& service, const std::shared_ptr<PendingCall>& call, const void* in);

  const Guid id_ = Guid::random();
  std::weak_ptr<Service> service_;
  const std::shared_ptr<Clock> clock_;
  const std::shared_ptr<Executor> continuations_;
  const std::shared_ptr<CallJournal> journal_;
  std::shared_ptr<const std::string> peer_;  // shared with calls on their way
  std::shared_ptr<Session> session_;
  std::shared_ptr<const std::atomic<bool>> leaving_;  // the service
  std::atomic<std::uint64_t> calls_{0};
  QueuedCalls queued_;
};

}  // namespace skein::rpc
