#include <algorithm>

#include "proxy_object.hpp"
#include "skein/connector.hpp"
#include "skein/error.hpp"

namespace skein::c {
namespace {

Constraint constraint_of(const skein_constraint& given) {
  if (given.relation < SKEIN_EQUAL || given.relation > SKEIN_AT_LEAST) {
    throw InvalidArgument(std::to_string(given.relation) + " is no relation of a constraint");
  }
  return {text_of(given.attribute, "the attribute of a constraint"),
          static_cast<Relation>(given.relation), text_of(given.value, "the value of a constraint")};
}

ConnectOptions connect_options_of(const skein_connect_options& given) {
  check_reserved(given.reserved);
  ConnectOptions options;
  if (given.name) options.name = given.name;
  if (given.system) options.system = given.system;
  if (given.strategy) options.strategy = given.strategy;
  if (given.preferred_host) options.preferred_host = given.preferred_host;
  if (given.provider) {
    std::copy_n(given.provider, options.provider.bytes.size(), options.provider.bytes.begin());
  }
  if (given.constraints_size > 0) demand(given.constraints, "constraints");
  for (std::size_t i = 0; i < given.constraints_size; ++i) {
    options.constraints.push_back(constraint_of(given.constraints[i]));
  }
  options.timeout = time_of(given.timeout_ns, "timeout_ns", options.timeout);
  const Duration hedge = time_of(given.hedge_after_ns, "hedge_after_ns", Duration::zero());
  if (hedge > Duration::zero()) options.hedge_after = hedge;
  return options;
}

const OperationInfo& expect_stream(const OperationInfo& operation, bool stream) {
  if (operation.stream == stream) return operation;
  throw InvalidArgument(std::string(operation.name) +
                        (stream ? " is no stream: use skein_proxy_call() or skein_proxy_start()"
                                : " is a stream of results: use skein_proxy_stream()"));
}

ValueCall begin_call(const ProxyObject& proxy, const Arguments& arguments,
                     std::int64_t timeout_ns) {
  expect_stream(arguments.operation, false);
  auto pending = proxy.within(timeout_ns).start(arguments.operation, arguments.value);
  auto* const result = &pending->value;
  return {std::move(pending), proxy.channel, result};
}

/// Tells the end of a call by its callbacks.
void tell_end(ValueCall call, const skein_call_callbacks& callbacks, skein_encoding encoding,
              CallbackGate& gate) {
  std::exception_ptr error;
  std::optional<ResultObject> result;
  try {
    result.emplace(call.get(), encoding);
  } catch (...) {
    error = std::current_exception();
  }
  const CallbackError sink(error);
  const skein_value value = result ? result->value() : skein_value{};
  gate.run([&](void* user) {
    if (callbacks.on_result) callbacks.on_result(user, result ? &value : nullptr, sink.handle());
  });
  gate.close();
}

}  // namespace

std::shared_ptr<ResultObject> CallObject::wait() {
  std::lock_guard lock(mutex_);
  if (!call_) throw InvalidArgument("this call tells its result to a callback: do not wait for it");
  return std::make_shared<ResultObject>(call_->get(), encoding_);
}

}  // namespace skein::c

using namespace skein;
using namespace skein::c;

bool skein_proxy_connect(skein_entity entity, skein_interface interface,
                         const skein_connect_options* options, skein_proxy* out,
                         skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    const auto known = find<InterfaceObject>(interface);
    const auto object = find<EntityObject>(entity);
    const auto use = object->use();
    const auto& info = known->of(idl::DynamicForm::Cdr).info();
    auto channel =
        use->connector().open(info, options ? connect_options_of(*options) : ConnectOptions{});
    *out = add(std::make_shared<ProxyObject>(std::move(channel), known, entity.id));
  });
}

bool skein_proxy_connected(skein_proxy proxy, bool* out, skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    *out = find<ProxyObject>(proxy)->channel->connected();
  });
}

bool skein_proxy_free(skein_proxy proxy, skein_error error) {
  return attempt(error, [&] {
    if (const auto object = remove<ProxyObject>(proxy)) object->channel->disconnect();
  });
}

bool skein_proxy_call(skein_proxy proxy, const char* operation, skein_value arguments,
                      std::int64_t timeout_ns, skein_result* out, skein_error error) {
  return attempt(error, [&] {
    const auto object = find<ProxyObject>(proxy);
    const Arguments given = arguments_of(*object->interface, operation, arguments);
    expect_stream(given.operation, false);
    auto result = object->within(timeout_ns).call(given.operation, given.value);
    if (out) *out = add(std::make_shared<ResultObject>(std::move(result), arguments.encoding));
  });
}

bool skein_proxy_start(skein_proxy proxy, const char* operation, skein_value arguments,
                       std::int64_t timeout_ns, const skein_call_callbacks* callbacks,
                       skein_call* out, skein_error error) {
  return attempt(error, [&] {
    if (!callbacks) demand(out, "out, without callbacks,");
    const auto object = find<ProxyObject>(proxy);
    ValueCall call =
        begin_call(*object, arguments_of(*object->interface, operation, arguments), timeout_ns);
    if (!callbacks) {
      *out = add(std::make_shared<CallObject>(std::move(call), arguments.encoding));
      return;
    }
    if (out) *out = add(std::make_shared<CallObject>(call.canceller()));
    auto gate =
        std::make_shared<CallbackGate>(object->entity, callbacks->user, callbacks->on_close);
    std::move(call).then([gate = std::move(gate), callbacks = *callbacks,
                          encoding = arguments.encoding](ValueCall ended) {
      tell_end(std::move(ended), callbacks, encoding, *gate);
    });
  });
}

bool skein_call_wait(skein_call call, skein_result* out, skein_error error) {
  return attempt(error, [&] {
    auto result = find<CallObject>(call)->wait();
    if (out) *out = add(std::move(result));
  });
}

bool skein_call_cancel(skein_call call, skein_error error) {
  return attempt(error, [&] { find<CallObject>(call)->cancel(); });
}

bool skein_call_free(skein_call call, skein_error error) {
  return attempt(error, [&] {
    if (const auto object = remove<CallObject>(call)) object->cancel();
  });
}

bool skein_proxy_stream(skein_proxy proxy, const char* operation, skein_value arguments,
                        std::int64_t timeout_ns, const skein_stream_callbacks* callbacks,
                        skein_stream* out, skein_error error) {
  return attempt(error, [&] {
    if (!callbacks) demand(out, "out, without callbacks,");
    const auto object = find<ProxyObject>(proxy);
    const Arguments given = arguments_of(*object->interface, operation, arguments);
    const OperationInfo& found = expect_stream(given.operation, true);
    const auto pending = object->within(timeout_ns).stream(found, given.value);
    if (out) {
      *out = add(std::make_shared<StreamObject>(
          StreamParts{pending, object->channel, arguments.encoding, callbacks != nullptr}));
    }
    if (callbacks)
      tell_items({pending, object->channel, arguments.encoding, true}, *callbacks, object->entity);
  });
}

bool skein_stream_next(skein_stream stream, skein_result* out, skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    const auto object = find<StreamObject>(stream);
    if (object->told) {
      throw InvalidArgument("this stream tells its results to a callback: do not wait for them");
    }
    std::lock_guard lock(object->mutex);
    const auto item = object->pending->next();
    *out = item ? add(std::make_shared<ResultObject>(
                      std::move(*static_cast<idl::DynamicValue*>(item.get())), object->encoding))
                : skein_result{};
  });
}

bool skein_stream_free(skein_stream stream, skein_error error) {
  return attempt(error, [&] {
    if (const auto object = remove<StreamObject>(stream)) object->pending->drop();
  });
}
