#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "skein/call.hpp"
#include "skein/connector.hpp"
#include "skein/stream.hpp"
#include "skein/topics.hpp"
#include "skein/types.idl.hpp"

namespace skein {

class DynamicInterface;
class Entity;

/// An exception that the interface declares, by a DynamicProxy.
class DynamicException : public UserException {
 public:
  /// `info` must live until the process ends.
  DynamicException(const ExceptionInfo& info, std::shared_ptr<const void> value, std::string json);

  const ExceptionInfo& info() const noexcept override { return info_; }
  const void* value() const noexcept override { return value_.get(); }
  /// Its members.
  const std::string& json() const noexcept { return json_; }
  /// Its name and its members.
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  const ExceptionInfo& info_;
  std::shared_ptr<const void> value_;
  std::string json_;
  std::string text_;
};

/// A proxy without the interface's generated code: typed on the wire, JSON text here. For tools,
/// and for bridges to other languages. Made by connect_dynamic(). Thread-safe. One that was made
/// without a connection throws InvalidArgument.
///
/// Arguments are a JSON object of the in and inout parameters by name; where there is only one, its
/// value alone will do, and where there is none, empty text. A result is a JSON object: `return_`,
/// and the out and inout parameters by name. JSON is that of generated types (idl/README.md).
class DynamicProxy : public ProxyBase {
 public:
  DynamicProxy() = default;
  DynamicProxy(std::shared_ptr<Channel> channel, const DynamicInterface& interface);

  /// A copy with another timeout for its calls.
  DynamicProxy within(TimeSpan timeout) const;

  /// Canonical name: `AE_navigator/INavigator`.
  std::string interface_name() const;
  /// The interface, its bases, and all types that they name; to_idl() prints them.
  const types::TypeSystem& types() const;
  /// Throws InvalidArgument with the most similar name where the interface has none of that name.
  const types::Operation& operation(const std::string& name) const;
  /// Arguments that the operation takes, all with their initial values: zeros, first enumerators,
  /// empty sequences. Throws as operation().
  std::string example(const std::string& operation) const;

  /// Calls an operation that is no stream. Throws InvalidArgument for an unknown operation, and,
  /// with the place, for arguments that do not fit; DynamicException; and what any proxy throws.
  std::string call(const std::string& operation, const std::string& arguments) const;
  Call<std::string> async_call(const std::string& operation, const std::string& arguments) const;

  /// Calls an operation under `@stream`; each result is a JSON object.
  Stream<std::string> stream(const std::string& operation, const std::string& arguments) const;

 private:
  const OperationInfo& find(const std::string& operation, bool stream) const;

  const DynamicInterface& described() const;

  const DynamicInterface* interface_ = nullptr;
};

/// Connects to a provider as Connector::connect does, and asks it for its types. `options.name` is
/// required: an interface or an entity. Throws as connect() does, and Unavailable where the
/// provider does not tell its types within the timeout.
DynamicProxy connect_dynamic(Entity& entity, const ConnectOptions& options);

/// Publishes JSON on a topic whose type is known by its description alone. Thread-safe, movable as
/// a Publisher. Destroy it before its entity.
class DynamicPublisher {
 public:
  /// `type` is one of `known`, a struct or a union. If `qos` names no systems, the topic is
  /// published in the entity's own. Throws as Entity::publisher() does, and InvalidArgument for
  /// types that make no sense.
  DynamicPublisher(Entity& entity, const std::string& topic, const std::string& type,
                   const types::TypeSystem& known, const TopicQos& qos);

  /// As Publisher::publish(). Throws InvalidArgument, with the place, for what is no such value.
  void publish(const std::string& json);
  /// A value as it stands on the wire, with its encapsulation header: what was recorded. Throws
  /// InvalidArgument where the topic has keys and the bytes are no value of its type.
  void publish_encoded(std::span<const std::byte> cdr);
  /// As Publisher's.
  bool wait_for_acknowledgments(std::chrono::milliseconds timeout) {
    return topics::held(writer_).wait_for_acknowledgments(timeout);
  }
  std::size_t subscribers() const { return topics::held(writer_).subscribers(); }

 private:
  const topics::TopicType& type_;
  std::unique_ptr<topics::TopicWriter> writer_;
};

/// Receives the values of a topic whose type is known by its description alone, as JSON.
/// Thread-safe, movable as a Subscription. Destroy it before its entity.
class DynamicSubscription {
 public:
  using Callback = std::function<void(const std::string& json)>;
  /// Gets the value as CDR with its encapsulation header, as `known` describes the type.
  using CdrCallback = std::function<void(std::span<const std::byte> cdr)>;

  /// Throws as DynamicPublisher() does. The callback runs as that of Entity::subscription().
  DynamicSubscription(Entity& entity, const std::string& topic, const std::string& type,
                      const types::TypeSystem& known, const TopicQos& qos, Callback callback,
                      SubscriptionOptions options = {});
  DynamicSubscription(Entity& entity, const std::string& topic, const std::string& type,
                      const types::TypeSystem& known, const TopicQos& qos, CdrCallback callback,
                      SubscriptionOptions options = {});

  std::size_t publishers() const { return topics::held(reader_).publishers(); }
  SubscriptionCounters counters() const { return topics::held(reader_).counters(); }

 private:
  std::unique_ptr<topics::TopicReader> reader_;
};

}  // namespace skein
