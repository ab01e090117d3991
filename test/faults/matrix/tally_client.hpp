#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rpc/client/remote_channel.hpp"
#include "skein/entity.hpp"
#include "tally.idl.hpp"
#include "test/faults/journal.hpp"

namespace skein::test {

/// How a client calls.
struct CallShape {
  std::chrono::milliseconds timeout{1000};
  std::uint32_t work_ms = 0;
  /// Calls carry from 0 up to so many bytes, in turn.
  std::size_t max_bytes = 0;
  std::chrono::milliseconds pause{1};
};

/// A client of the tally service whose calls are written down.
class TallyClient {
 public:
  /// Connects as users do, or, `exposed`, by a transport of its own so that its pending calls can
  /// be counted. Throws what connecting throws. Its calls' numbers begin at `first`.
  TallyClient(Entity& entity, Journal& journal, std::uint64_t first, bool exposed);
  ~TallyClient();
  TallyClient(const TallyClient&) = delete;
  TallyClient& operator=(const TallyClient&) = delete;

  /// Calls on a thread of its own, one call after the other, until stop().
  void start(const CallShape& shape);
  /// The number of calls that have succeeded so far.
  std::uint64_t stop();

  /// Calls at once, without waiting for an answer; settle() waits for all.
  void burst(int calls, const CallShape& shape);
  void settle();

  /// One call: how it ended.
  std::string call(const CallShape& shape);
  /// Has the provider end before it answers.
  std::string call_and_kill(std::chrono::milliseconds timeout);

  /// Calls of the exposed transport that have no answer yet.
  std::size_t pending() const { return channel_ ? channel_->pending() : 0; }

 private:
  struct Pending {
    std::uint64_t number;
    Instant deadline;
    Call<std::vector<std::uint8_t>> call;
  };
  ::test::Tally::Proxy proxy(std::chrono::milliseconds timeout);
  template <class Action>
  std::string note(std::uint64_t number, Instant deadline, Action&& action);

  Entity& entity_;
  Journal& journal_;
  std::uint64_t next_;
  const bool exposed_;
  std::shared_ptr<rpc::RemoteChannel> channel_;
  std::optional<::test::Tally::Proxy> connected_;
  std::vector<Pending> pending_;
  std::uint64_t succeeded_ = 0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace skein::test
