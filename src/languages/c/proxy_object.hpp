#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "dynamic/value_proxy.hpp"
#include "interface_object.hpp"

namespace skein::c {

/// A connection. Its calls use neither entity nor handle, so that they may outlive both.
class ProxyObject {
 public:
  ProxyObject(std::shared_ptr<Channel> channel_, std::shared_ptr<InterfaceObject> interface_,
              std::uint64_t entity_)
      : channel(std::move(channel_)), interface(std::move(interface_)), entity(entity_) {}
  ~ProxyObject() { channel->disconnect(); }
  ProxyObject(const ProxyObject&) = delete;
  ProxyObject& operator=(const ProxyObject&) = delete;

  /// For one call. Throws InvalidArgument for a timeout of less than 0.
  ValueProxy within(std::int64_t timeout_ns) const {
    return {channel, time_of(timeout_ns, "timeout_ns", ProxyBase::kDefaultTimeout)};
  }

  const std::shared_ptr<Channel> channel;
  const std::shared_ptr<InterfaceObject> interface;
  const std::uint64_t entity;
};
SKEIN_NAMES(skein_proxy, Proxy, ProxyObject);

using ValueCall = Call<idl::DynamicValue>;

/// A call that was begun. Thread-safe.
class CallObject {
 public:
  /// Without callbacks.
  CallObject(ValueCall call, skein_encoding encoding)
      : cancel(call.canceller()), call_(std::move(call)), encoding_(encoding) {}
  /// With callbacks, which have the call.
  explicit CallObject(std::function<void()> canceller) : cancel(std::move(canceller)) {}

  /// Waits for the result, once.
  std::shared_ptr<ResultObject> wait();

  const std::function<void()> cancel;

 private:
  std::mutex mutex_;  // of those that wait
  std::optional<ValueCall> call_;
  const skein_encoding encoding_ = SKEIN_JSON;
};
SKEIN_NAMES(skein_call, Call, CallObject);

/// A stream, and how its results are told.
struct StreamParts {
  std::shared_ptr<PendingStream> pending;
  std::shared_ptr<Channel> channel;
  skein_encoding encoding;
  bool told;  ///< To callbacks.
};

/// A stream that was begun.
struct StreamObject : StreamParts {
  explicit StreamObject(StreamParts parts) : StreamParts(std::move(parts)) {}
  ~StreamObject() { pending->drop(); }
  StreamObject(const StreamObject&) = delete;
  StreamObject& operator=(const StreamObject&) = delete;

  std::mutex mutex;  ///< Of those that wait.
};
SKEIN_NAMES(skein_stream, Stream, StreamObject);

/// Has the results of a stream told, one after the other, on the executor for continuations.
void tell_items(const StreamParts& stream, const skein_stream_callbacks& callbacks,
                std::uint64_t entity);

}  // namespace skein::c
