#include <algorithm>

#include "callback_thread.hpp"
#include "provider_object.hpp"
#include "skein/error.hpp"

namespace skein::c {
namespace {

/// Carries calls to C.
class CallbackServant final : public Servant {
 public:
  CallbackServant(const DynamicInterface& interface, const skein_service_callbacks& callbacks,
                  skein_encoding encoding, std::shared_ptr<CallbackGate> gate)
      : interface_(interface),
        on_call_(callbacks.on_call),
        encoding_(encoding),
        gate_(std::move(gate)) {}

  const InterfaceInfo& interface_info() const noexcept override { return interface_.info(); }
  bool answers_later() const noexcept override { return true; }

  void dispatch(const OperationInfo& operation, const void* in, void* out) override {
    const bool later = !operation.stream && !operation.oneway;
    const auto reply = std::make_shared<ReplyObject>(
        interface_, operation, ResultObject(*static_cast<const idl::DynamicValue*>(in), encoding_),
        later ? static_cast<PendingReply*>(out)->shared_from_this() : nullptr,
        operation.stream ? static_cast<StreamWriter*>(out) : nullptr);
    const skein_reply handle = add(reply);
    const bool ran = gate_->run(
        [&](void* user) { on_call_(user, reply->operation(), &reply->arguments(), handle); });
    if (later && ran) return;
    attempt({}, [&] { remove<ReplyObject>(handle); });  // or it has failed, and ended by that
    if (!ran) throw Unavailable(std::string(interface_.info().name) + " is being withdrawn");
    reply->end_dispatch();
  }

 private:
  const DynamicInterface& interface_;
  void (*const on_call_)(void*, const char*, const skein_value*, skein_reply);
  const skein_encoding encoding_;
  const std::shared_ptr<CallbackGate> gate_;
};

ServiceOptions service_options_of(const skein_service_options& given) {
  check_reserved(given.reserved);
  check_value({nullptr, 0, given.encoding});
  ServiceOptions options;
  if (given.attributes_size > 0) demand(given.attributes, "attributes");
  for (std::size_t i = 0; i < given.attributes_size; ++i) {
    options.attributes.push_back({text_of(given.attributes[i].name, "an attribute's name"),
                                  text_of(given.attributes[i].value, "an attribute's value")});
  }
  if (given.component) options.component = given.component;
  if (given.threads > 0) options.threads = given.threads;
  if (given.queue > 0) options.queue = given.queue;
  return options;
}

Guid provide(Entity& entity, std::shared_ptr<Servant> servant, const skein_service_options& given) {
  const ServiceOptions options = service_options_of(given);
  if (!given.csp && !given.owner) return entity.provide(std::move(servant), options);
  return entity.provide_csp(text_of(given.csp, "the CSP's name"),
                            text_of(given.owner, "the CSP's owner"), std::move(servant), options);
}

}  // namespace

ThreadExecutor& callback_thread() {
  static auto& thread = *new ThreadExecutor("skein-c-callback");
  return thread;
}

}  // namespace skein::c

using namespace skein;
using namespace skein::c;

bool skein_provider_new(skein_entity entity, skein_interface interface,
                        const skein_service_options* options,
                        const skein_service_callbacks* callbacks, skein_provider* out,
                        skein_error error) {
  return attempt(error, [&] {
    demand(callbacks, "callbacks");
    demand(reinterpret_cast<const void*>(callbacks->on_call), "on_call");
    demand(out, "out");
    const skein_service_options given = options ? *options : skein_service_options{};
    const auto known = find<InterfaceObject>(interface);
    const auto object = find<EntityObject>(entity);
    const auto use = object->use();
    const auto gate =
        std::make_shared<CallbackGate>(entity.id, callbacks->user, callbacks->on_close);
    auto servant = std::make_shared<CallbackServant>(known->of(given.encoding), *callbacks,
                                                     given.encoding, gate);
    const auto provider = std::make_shared<ProviderObject>(
        ProviderObject{object, provide(*use, std::move(servant), given), gate});
    *out = add(provider);
    object->end_after(gate, [gate = std::weak_ptr(gate)] {
      if (const auto alive = gate.lock()) alive->close();
    });
  });
}

bool skein_provider_identity(skein_provider provider, std::uint8_t out[16], skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    std::ranges::copy(find<ProviderObject>(provider)->identity.bytes, out);
  });
}

bool skein_provider_free(skein_provider provider, skein_error error) {
  return attempt(error, [&] {
    if (provider.id == 0) return;
    if (find<ProviderObject>(provider)->gate->is_inside()) {
      throw InvalidArgument(
          "skein_provider_free() was called in a callback of this provider, for which it would "
          "wait; call it on another thread");
    }
    const auto object = remove<ProviderObject>(provider);
    if (const auto entity = object->entity.lock()) {
      attempt({}, [&] { entity->use()->withdraw(object->identity); });  // unless it was freed
    }
    object->gate->close();
  });
}
