#include <utility>

#include "brokerless_discovery/broker.hpp"
#include "dynamic_interface.hpp"
#include "idl/types/dynamic_codec.hpp"
#include "skein/detail/json.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/inspector.hpp"
#include "value_proxy.hpp"

namespace skein {
namespace {

using idl::DynamicSupport;
using idl::DynamicValue;

/// Whether the text is an object with the parameters' names, or the one parameter's value. An
/// object that cannot be the value has a wrong name.
bool names_parameters(const std::string& arguments, const idl::DynamicType::Member& only) {
  bool named = false;
  idl::parse_json(arguments, [&](const idl::JsonReader& json) {
    named = json.has_member(only.described->name) || (json.is_object() && !only.type->is_object());
  });
  return named;
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

DynamicValue arguments_of(const OperationInfo& operation, const std::string& arguments) {
  DynamicValue value{DynamicSupport::of(*operation.in)};
  const auto& parameters = value.support->type.members;
  if (arguments.empty()) {
    value.json = parameters.empty() ? "{}" : " ";  // which is no JSON
  } else if (parameters.size() == 1 && !names_parameters(arguments, parameters[0])) {
    value.json = "{\"" + parameters[0].described->name + "\":" + arguments + "}";
  } else {
    value.json = arguments;
  }
  return value;
}

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
  return ValueProxy(*this).call(found, arguments_of(found, arguments)).json;
}

Call<std::string> DynamicProxy::async_call(const std::string& operation,
                                           const std::string& arguments) const {
  const OperationInfo& found = find(operation, false);
  auto pending = ValueProxy(*this).start(found, arguments_of(found, arguments));
  auto* const result = &pending->value.json;
  return {std::move(pending), channel(), result};
}

Stream<std::string> DynamicProxy::stream(const std::string& operation,
                                         const std::string& arguments) const {
  const OperationInfo& found = find(operation, true);
  return Stream<std::string>(
      ValueProxy(*this).stream(found, arguments_of(found, arguments)), channel(),
      [](void* out) { return std::move(static_cast<DynamicValue*>(out)->json); });
}

ToldInterface ask_for_interface(Entity& entity, const ConnectOptions& options) {
  const Instant deadline = entity.clock().after(options.timeout);
  const auto providers = providers_of(entity, options, deadline);
  const discovery::ServiceDescription& provider = *providers.front();
  const auto participant = entity.broker().participant_of({provider.provider});
  if (!participant) throw Unavailable(provider.entity + " left before it was connected");
  const Duration left = std::max(Duration::zero(), deadline - entity.clock().now());
  return {provider, Inspector(entity).types(provider.service, *participant, left)};
}

DynamicProxy connect_dynamic(Entity& entity, const ConnectOptions& options) {
  if (options.name.empty()) {
    throw InvalidArgument("connect_dynamic() needs a name, of an interface or an entity");
  }
  const Instant deadline = entity.clock().after(options.timeout);
  const ToldInterface told = ask_for_interface(entity, options);
  // A pointer: g++ 14 warns of a reference as of one to `told`.
  const DynamicInterface* const interface = &dynamic_interface(told.service, told.types);
  ConnectOptions wanted = options;
  wanted.timeout = std::max(deadline - entity.clock().now(), Duration(1));  // fails as elsewhere
  return {entity.connector().open(interface->info(), wanted), *interface};
}

}  // namespace skein
