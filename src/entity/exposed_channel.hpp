#pragma once

#include <functional>
#include <memory>

#include "inline_watch.hpp"
#include "skein/core/channel.hpp"
#include "skein/rpc/service.hpp"

namespace skein::entity {

/// The connection to a CSP of this process while a task is performed: a blocking call runs on the
/// performing thread itself, watched, unless the CSP is busy. All else goes by the CSP's own
/// thread.
class ExposedChannel final : public Channel {
 public:
  struct Terms {
    InlineWatch& watch;
    Worker& worker;  ///< The performing thread.
    Instant deadline;
    std::size_t most;              ///< See InlineWatch::Watched.
    std::function<void()> lost{};  ///< See there.
  };

  /// `queued` is the connection by the CSP's own thread; `terms` hold until end().
  ExposedChannel(std::shared_ptr<Channel> queued, std::shared_ptr<rpc::Service> service,
                 Terms terms)
      : queued_(std::move(queued)), service_(std::move(service)), terms_(std::move(terms)) {}

  /// From now on no call runs here. On the performing thread.
  void end() noexcept { ended_ = true; }

  void start(const std::shared_ptr<PendingCall>& call, const void* in) override {
    queued_->start(call, in);
  }
  void call(const OperationInfo& operation, const void* in, void* out,
            const CallTime& time) override;
  Clock& clock() const noexcept override { return queued_->clock(); }
  Executor& continuations() const noexcept override { return queued_->continuations(); }
  std::string peer() const override { return queued_->peer(); }
  bool connected() const override { return queued_->connected(); }
  void disconnect() override { queued_->disconnect(); }
  void lose(const std::string& how) override { queued_->lose(how); }

 private:
  bool runs_here(const CallTime& time) const;

  const std::shared_ptr<Channel> queued_;
  const std::shared_ptr<rpc::Service> service_;
  const Terms terms_;
  bool ended_ = false;  // the performing thread's
};

}  // namespace skein::entity
