#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "skein/clock.hpp"
#include "skein/detail/loan_memory.hpp"
#include "skein/detail/representation.hpp"
#include "skein/guid.hpp"

/// The port through which calls travel between a client and a provider: over DDS
/// (dds_call_port.hpp), or through memory that two processes of a host share (src/same_host).
/// Messages begin with the 4-byte encapsulation header, and arrive in order or not at all.
namespace skein::calls {

/// Where a provider of a service is reached.
struct Address {
  /// The interface's name in any spelling; the topics are `AE_navigator/IPlanner_Request` and
  /// `AE_navigator/IPlanner_Reply`.
  std::string service;
  /// Nil: any peer that is not built with Skein.
  Guid provider;
  /// How its requests and replies travel.
  Representation representation = Representation::Xcdr1;
};

/// How long a sender waits for room before it throws Overloaded; longer for a large message through
/// shared memory.
inline constexpr std::chrono::milliseconds kPatience{100};

/// The right to take messages, which a thread has while it delivers one.
class Turn {
 public:
  /// Call it before this thread works for long: another thread then takes the messages that come
  /// meanwhile, and this message's bytes are no longer valid. Returns false, and changes nothing,
  /// if no other thread can.
  virtual bool leave() = 0;

 protected:
  ~Turn() = default;
};

/// A parameter that the sender left out of the message, as the receiver can read it in memory that
/// they share.
struct LentValue {
  std::span<const std::byte> value;  ///< Empty if it cannot be read here.
  std::size_t position = 0;          ///< Offset in the message at which it is missing.
  std::shared_ptr<const void> use;   ///< The value can be read while a copy of this lives.
};

/// What is received; valid during the call that delivers it.
struct Message {
  std::span<const std::byte> bytes;
  Guid sender;                      ///< The identity of its Sender.
  const LentValue* lent = nullptr;  ///< Null: the message is complete.
  Turn* turn = nullptr;             ///< Null: it cannot be left.
};

/// Called when a peer on the other side was found (true) or has gone (false). It may be called
/// before or after the peer's first message.
using PeerListener = std::function<void(const Guid& peer, bool found)>;

/// The functions run on the port's threads; over DDS also inside send(), if both sides belong to
/// one participant. They must return soon, and must not send, create or destroy what the port
/// makes, or wait for a thread that does.
struct Listener {
  std::function<void(const Message&)> on_message;
  PeerListener on_peer{};
};

/// Lets the thread that waits for a message take it itself, which saves the wake-up of the port's
/// thread. It may outlive its receiver; then it delivers nothing. Thread-safe.
class CallerDelivery {
 public:
  virtual ~CallerDelivery() = default;
  /// The port's thread leaves what comes next to the thread that will call deliver_until().
  virtual void lend() = 0;
  /// As lend(), for a while: unless a thread calls lend() again within 20 to 40 ms, the port's
  /// thread takes what comes.
  virtual void pause() = 0;
  /// The port's thread takes what comes next.
  virtual void take_back() = 0;
  /// Calls the listener on this thread as messages come, until `over()` is true. It checks that
  /// after each message and after wake(). Returns earlier, after take_back(), if another thread is
  /// already in it, or if one of the two sides has ended.
  virtual void deliver_until(const std::function<bool()>& over) = 0;
  /// From any thread.
  virtual void wake() = 0;
};

/// All members are thread-safe. Destroying it waits until no listener runs; not from a listener.
class Receiver {
 public:
  virtual ~Receiver() = default;
  /// Messages that were dropped because their encapsulation header is not the address's.
  virtual std::uint64_t malformed() const = 0;
  /// Null if only the port's threads deliver.
  virtual std::shared_ptr<CallerDelivery> caller_delivery() const = 0;
};

/// All members are thread-safe. Destroying it waits until no listener runs; not from a listener.
class Sender {
 public:
  virtual ~Sender() = default;
  /// Sends a message. `left` tells for how long it is still worth sending: a sender calls it only
  /// if it finds no room at first; one over DDS ignores it, and waits for kPatience. Throws
  /// InvalidArgument if the message is larger than receivers take, Overloaded if there was no room
  /// in time, NotSent if the other side of a client's connection has gone, otherwise Internal with
  /// the reason.
  virtual void send(std::span<const std::byte> message,
                    const std::function<Duration()>& left = {}) = 0;
  /// Sends a message that has left out `value` at `position`; throws as send(). Returns false, and
  /// sends nothing, if the other side cannot read the value where it lies.
  virtual bool send_lending(std::span<const std::byte> message,
                            const std::shared_ptr<LoanMemory>& value, std::size_t position) = 0;
  /// Waits until the other side has taken everything; returns false after `timeout`.
  virtual bool await_taken(std::chrono::milliseconds timeout) = 0;
  virtual Guid identity() const = 0;
};

/// The provider's side of the port. It must outlive what it makes. Thread-safe.
class ProviderPort {
 public:
  virtual ~ProviderPort() = default;
  /// Receives requests to the provider at `address`; if `foreign`, also those of clients that are
  /// not built with Skein. Throws Unavailable or Internal if the system refuses what is needed.
  virtual std::unique_ptr<Receiver> receive_requests(const Address& address, bool foreign,
                                                     Listener listener) = 0;
  /// Sends replies to the client of that identity; nil: to all that are not built with Skein.
  virtual std::unique_ptr<Sender> send_replies(const Address& address, const Guid& client,
                                               PeerListener on_peer = {}) = 0;
};

/// The client's side of the port. It must outlive what it makes. Thread-safe.
class ClientPort {
 public:
  virtual ~ClientPort() = default;
  /// Connects to the provider at `address`; the result's identity is the client's. `on_full` is
  /// called inside send() if that is about to wait for room. Throws Unavailable if the provider
  /// cannot be reached in this way.
  virtual std::unique_ptr<Sender> send_requests(const Address& address, PeerListener on_peer,
                                                std::function<void()> on_full = {}) = 0;
  /// Receives replies to that client.
  virtual std::unique_ptr<Receiver> receive_replies(const Address& address, const Guid& client,
                                                    Listener listener) = 0;
};

}  // namespace skein::calls
