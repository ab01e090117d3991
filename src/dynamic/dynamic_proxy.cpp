#include <utility>

#include "brokerless_discovery/broker.hpp"
#include "dynamic_interface.hpp"
#include "idl/types/dynamic_codec.hpp"
#include "skein/detail/json.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/inspector.hpp"

namespace skein {
namespace {

using idl::DynamicSupport;
using idl::DynamicValue;

DynamicValue new_value(const TypeSupport& support) {
  return {&static_cast<const DynamicSupport&>(support), "{}"};
}

struct DynamicCall final : PendingCall {
  DynamicCall(const OperationInfo& operation, Instant deadline)
      : PendingCall(operation, &value, deadline, false), value(new_value(*operation.out)) {}
  DynamicValue value;
};

/// Whether the text is an object with the parameters' names, or the one parameter's value. An
/// object that cannot be the value has a wrong name.
bool names_parameters(const std::string& arguments, const idl::DynamicType::Member& only) {
  bool named = false;
  idl::parse_json(arguments, [&](const idl::JsonReader& json) {
    named = json.has_member(only.described->name) || (json.is_object() && !only.type->is_object());
  });
  return named;
}

DynamicValue arguments_of(const OperationInfo& operation, const std::string& arguments) {
  DynamicValue value = new_value(*operation.in);
  const auto& parameters = value.support->type.members;
  if (!arguments.empty() || !parameters.empty()) value.json = arguments;
  if (parameters.size() == 1 && !names_parameters(arguments, parameters[0])) {
    value.json = "{\"" + parameters[0].described->name + "\":" + arguments + "}";
  }
  return value;
}

/// The provider that a connection would be made to now.
brokerless_discovery::Table::Found providers_of(Entity& entity, const ConnectOptions& options,
                                                Instant deadline) {
  auto query = entity.broker().query(options.name);
  if (options.system) {
    query.system = *options.system == ConnectOptions::kAnySystem ? std::nullopt : options.system;
  }
  query.provider = options.provider;
  query.constraints = options.constraints;
  return entity.broker().await_service(query, deadline);
}

}  // namespace

DynamicException::DynamicException(const ExceptionInfo& info, std::shared_ptr<const void> value,
                                   std::string json)
    : info_(info),
      value_(std::move(value)),
      json_(std::move(json)),
      text_(std::string(info.name) + " " + json_) {}

DynamicProxy::DynamicProxy(std::shared_ptr<Channel> channel, const DynamicInterface& interface)
    : ProxyBase(std::move(channel), kDefaultTimeout), interface_(&interface) {}

DynamicProxy DynamicProxy::within(TimeSpan timeout) const {
  DynamicProxy copy = *this;
  copy.set_timeout(timeout);
  return copy;
}

const DynamicInterface& DynamicProxy::described() const {
  connection();  // else there is none
  return *interface_;
}

std::string DynamicProxy::interface_name() const { return std::string(described().info().name); }

const types::TypeSystem& DynamicProxy::types() const { return described().types(); }

const types::Operation& DynamicProxy::operation(const std::string& name) const {
  return described().described(name);
}

std::string DynamicProxy::example(const std::string& operation) const {
  const auto& in = static_cast<const DynamicSupport&>(*described().operation(operation).in);
  return idl::initial_json(in.type);
}

const OperationInfo& DynamicProxy::find(const std::string& operation, bool stream) const {
  const OperationInfo& found = described().operation(operation);
  if (found.stream == stream) return found;
  throw InvalidArgument(
      operation + (stream ? " is no stream: use call()" : " is a stream of results: use stream()"));
}

std::string DynamicProxy::call(const std::string& operation, const std::string& arguments) const {
  const OperationInfo& found = find(operation, false);
  const DynamicValue in = arguments_of(found, arguments);
  DynamicValue out = new_value(*found.out);
  connection().call(found, &in, &out, call_time());
  return std::move(out.json);
}

Call<std::string> DynamicProxy::async_call(const std::string& operation,
                                           const std::string& arguments) const {
  const OperationInfo& found = find(operation, false);
  const DynamicValue in = arguments_of(found, arguments);
  auto pending = std::make_shared<DynamicCall>(found, call_time().deadline);
  auto* const result = &pending->value.json;
  connection().start(pending, &in);
  return {std::move(pending), channel(), result};
}

Stream<std::string> DynamicProxy::stream(const std::string& operation,
                                         const std::string& arguments) const {
  const OperationInfo& found = find(operation, true);
  const DynamicValue in = arguments_of(found, arguments);
  auto pending = std::make_shared<PendingStream>(found, call_time().deadline);
  connection().start(pending, &in);
  return Stream<std::string>(std::move(pending), channel(), [](void* out) {
    return std::move(static_cast<DynamicValue*>(out)->json);
  });
}

DynamicProxy connect_dynamic(Entity& entity, const ConnectOptions& options) {
  if (options.name.empty()) {
    throw InvalidArgument("connect_dynamic() needs a name, of an interface or an entity");
  }
  const Instant deadline = entity.clock().after(options.timeout);
  const auto providers = providers_of(entity, options, deadline);
  const discovery::ServiceDescription& provider = *providers.front();
  const auto left = [&] { return std::max(Duration::zero(), deadline - entity.clock().now()); };
  const auto participant = entity.broker().participant_of({provider.provider});
  if (!participant) throw Unavailable(provider.entity + " left before it was connected");
  const DynamicInterface& interface =
      dynamic_interface(provider, Inspector(entity).types(provider.service, *participant, left()));
  ConnectOptions wanted = options;
  wanted.timeout = std::max(left(), Duration(1));  // at its end it fails as it does elsewhere
  return {entity.connector().open(interface.info(), wanted), interface};
}

}  // namespace skein
