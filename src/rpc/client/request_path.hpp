#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <string>

#include "call_port/call_port.hpp"
#include "rpc/service/call_journal.hpp"
#include "rpc/wire/shared_use.hpp"
#include "rpc/wire/wire.hpp"
#include "skein/detail/channel.hpp"

namespace skein::rpc {

/// The way of a client's requests to its provider. Thread-safe.
class RequestPath {
 public:
  /// `peer` is for messages; `journal` may be null. Without `lends` all parameters are copied.
  RequestPath(calls::Address address, Clock& clock, std::string peer, bool lends,
              std::shared_ptr<CallJournal> journal);

  /// Call it once, before send().
  void open(std::unique_ptr<calls::Sender> sender);
  /// Requests do not wait for room any more.
  void give_up() noexcept { given_up_ = true; }
  /// Nothing is sent any more. Returns the sender.
  std::shared_ptr<calls::Sender> close();
  /// After close(), and after the sender is gone: waits for those who are inside it.
  void await_end() { senders_.await_end(); }

  /// The client's identity.
  const Guid& client() const noexcept { return client_; }
  const calls::Address& address() const noexcept { return address_; }
  /// Whether the provider has taken everything; does not wait.
  bool all_taken() const;

  /// Sends the request of a call; returns false, and sends nothing, if the call has ended. Throws
  /// as Sender::send() does, NotSent once closed, TimedOut if the deadline is over.
  bool send(const PendingCall& call, std::uint64_t number, const void* in) const;
  /// Sends what is about a call, or about the session.
  void send_reserved(std::uint32_t operation, const wire::RequestTrailer& trailer) const;
  void note_end(std::uint64_t number, const OperationInfo& operation,
                const std::exception_ptr& error) const;

 private:
  std::shared_ptr<calls::Sender> sender() const;
  void put_request(Bytes& message, const PendingCall& call, std::uint64_t number,
                   const void* in) const;
  template <class Send>
  auto in_time(const PendingCall& call, Send send) const;

  const calls::Address address_;
  Clock& clock_;
  const std::string peer_;
  const bool lends_;
  const std::shared_ptr<CallJournal> journal_;
  Guid client_;
  std::atomic<bool> given_up_{false};
  mutable std::mutex mutex_;
  SharedUse senders_;
  std::shared_ptr<calls::Sender> sender_;
};

}  // namespace skein::rpc
