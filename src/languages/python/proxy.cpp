#include <functional>

#include "parts.hpp"
#include "running.hpp"

namespace skein::python {
namespace {

using OwnedProxy = Owned<skein_proxy, skein_proxy_free>;
using OwnedCall = Owned<skein_call, skein_call_free>;
using OwnedStream = Owned<skein_stream, skein_stream_free>;

struct Proxy {
  std::shared_ptr<Interface> interface;
  OwnedProxy handle;
};

/// Which provider to connect to. Empty members have their defaults.
struct Choice {
  std::string name;
  std::string system;
  std::string strategy;
  std::string preferred_host;
  std::string provider;
  std::vector<std::tuple<std::string, int, std::string>> constraints;
  std::int64_t timeout_ns;
  std::int64_t hedge_after_ns;
};

bool connect_to(skein_entity entity, skein_interface interface, const Choice& choice,
                OwnedProxy& proxy, skein_error error) {
  std::vector<skein_constraint> constraints;
  for (const auto& [attribute, relation, value] : choice.constraints) {
    constraints.push_back({attribute.c_str(), value.c_str(), relation});
  }
  const auto text = [](const std::string& given) {
    return given.empty() ? nullptr : given.c_str();
  };
  skein_connect_options options{};
  options.name = text(choice.name);
  options.system = text(choice.system);
  options.strategy = text(choice.strategy);
  options.preferred_host = text(choice.preferred_host);
  options.provider = reinterpret_cast<const std::uint8_t*>(text(choice.provider));
  options.constraints = constraints.data();
  options.constraints_size = constraints.size();
  options.timeout_ns = choice.timeout_ns;
  options.hedge_after_ns = choice.hedge_after_ns;
  skein_proxy made{};
  if (!skein_proxy_connect(entity, interface, &options, &made, error)) return false;
  proxy = OwnedProxy(made);
  return true;
}

std::shared_ptr<Proxy> connect(const Entity& entity, const std::shared_ptr<Interface>& interface,
                               Choice choice) {
  if (!choice.provider.empty() && choice.provider.size() != 16) {
    refuse("provider: an identity has 16 bytes, and this one has " +
           std::to_string(choice.provider.size()));
  }
  const std::function<bool(OwnedProxy&, skein_error)> wait =
      [entity = *entity.handle, interface = interface->handle(), choice = std::move(choice)](
          OwnedProxy& proxy, skein_error error) {
        return connect_to(entity, interface, choice, proxy, error);
      };
  return std::make_shared<Proxy>(Proxy{interface, wait_for(wait)});
}

/// Calls, and waits for the result.
py::object call(const Proxy& proxy, const Operation& operation, const py::tuple& arguments,
                std::int64_t timeout_ns) {
  const Bytes message = operation.encode_arguments(arguments);
  const skein_value value = cdr_of(message);
  skein_result result{};
  const Interface* const known = proxy.interface.get();
  if (!is_main_thread()) {
    run(
        [&](skein_error error) {
          return skein_proxy_call(*proxy.handle, operation.name.c_str(), value, timeout_ns, &result,
                                  error);
        },
        known);
  } else {
    skein_call begun{};
    run(
        [&](skein_error error) {
          return skein_proxy_start(*proxy.handle, operation.name.c_str(), value, timeout_ns,
                                   nullptr, &begun, error);
        },
        known);
    const OwnedCall owned(begun);
    bool done = false;
    {
      const Interruptible wait([begun] { skein_call_cancel(begun, {}); });
      const Unlocked unlocked;
      done = skein_call_wait(begun, &result, sink());
    }
    if (!done) {
      handle_signals();
      raise(*last_failure(), known);
    }
  }
  const OwnedResult owned(result);
  return operation.decode_results(value_of(owned));
}

/// What is told at the end of a call, once.
struct Told {
  std::shared_ptr<const Proxy> proxy;  // whose end would cancel the call
  std::shared_ptr<Operation> operation;
  py::object callback;  // (result, error)
};

void tell(const Told& told, const skein_value* value, skein_error error) {
  py::object result = py::none();
  py::object failure = py::none();
  const auto* const known = told.operation->interface.get();
  try {
    try {
      if (!value) raise(*c::find<c::ErrorSink>(error)->last(), known);
      result = decoded([&] { return told.operation->decode_results(*value); });
    } catch (py::error_already_set& thrown) {
      failure = thrown.value();
    }
    told.callback(result, failure);
  } catch (py::error_already_set& thrown) {
    thrown.discard_as_unraisable("a callback of Skein's");
  }
}

void on_result(void* user, const skein_value* value, skein_error error) {
  const Entered entered;
  if (entered) tell(*static_cast<Told*>(user), value, error);
}

/// Begins a call whose end `callback(result, error)` is told on a thread of Skein's.
std::shared_ptr<OwnedCall> start(const std::shared_ptr<Proxy>& proxy,
                                 const std::shared_ptr<Operation>& operation,
                                 const py::tuple& arguments, std::int64_t timeout_ns,
                                 const py::object& callback) {
  const Bytes message = operation->encode_arguments(arguments);
  auto told = std::make_unique<Told>(Told{proxy, operation, callback});
  const skein_call_callbacks callbacks{told.get(), on_result, drop<Told>};
  skein_call begun{};
  run(
      [&](skein_error error) {
        return skein_proxy_start(*proxy->handle, operation->name.c_str(), cdr_of(message),
                                 timeout_ns, &callbacks, &begun, error);
      },
      proxy->interface.get());
  static_cast<void>(told.release());  // which on_close has now
  return std::make_shared<OwnedCall>(begun);
}

struct Stream {
  std::shared_ptr<const Proxy> proxy;  // whose end would cancel the operation
  std::shared_ptr<Operation> operation;
  OwnedStream handle;

  /// The next result; throws StopIteration at the end.
  py::object next() const {
    const skein_stream stream = *handle;
    skein_result result{};
    bool done = false;
    refuse_after_fork();
    {
      const Interruptible wait([stream] { skein_stream_free(stream, {}); });
      const Unlocked unlocked;
      done = skein_stream_next(stream, &result, sink());
    }
    if (!done) {
      handle_signals();
      raise(*last_failure(), operation->interface.get());
    }
    if (result.id == 0) throw py::stop_iteration();
    const OwnedResult owned(result);
    return operation->decode_results(value_of(owned));
  }
};

std::shared_ptr<Stream> stream(const std::shared_ptr<Proxy>& proxy,
                               const std::shared_ptr<Operation>& operation,
                               const py::tuple& arguments, std::int64_t timeout_ns) {
  const Bytes message = operation->encode_arguments(arguments);
  skein_stream begun{};
  run(
      [&](skein_error error) {
        return skein_proxy_stream(*proxy->handle, operation->name.c_str(), cdr_of(message),
                                  timeout_ns, nullptr, &begun, error);
      },
      proxy->interface.get());
  return std::make_shared<Stream>(Stream{proxy, operation, OwnedStream(begun)});
}

}  // namespace

void define_proxy(py::module_& module) {
  py::class_<Proxy, std::shared_ptr<Proxy>>(module, "Proxy")
      .def(py::init([](const Entity& entity, const std::shared_ptr<Interface>& interface,
                       std::string name, std::string system, std::string strategy,
                       std::string preferred_host, const py::bytes& provider,
                       std::vector<std::tuple<std::string, int, std::string>> constraints,
                       std::int64_t timeout_ns, std::int64_t hedge_after_ns) {
        return connect(
            entity, interface,
            {std::move(name), std::move(system), std::move(strategy), std::move(preferred_host),
             provider, std::move(constraints), timeout_ns, hedge_after_ns});
      }))
      .def("connected",
           [](const Proxy& self) {
             bool connected = false;
             if (self.handle.closed()) return false;
             run([&](skein_error error) {
               return skein_proxy_connected(*self.handle, &connected, error);
             });
             return connected;
           })
      .def("close", [](Proxy& self) { self.handle.close(); })
      .def("call", &call)
      .def("start", &start)
      .def("stream", &stream);
  py::class_<OwnedCall, std::shared_ptr<OwnedCall>>(module, "Call")
      .def("cancel", [](const OwnedCall& self) {
        run([&](skein_error error) { return skein_call_cancel(*self, error); });
      });
  py::class_<Stream, std::shared_ptr<Stream>>(module, "Stream")
      .def("next", &Stream::next)
      .def("close", [](Stream& self) {
        // Ctrl-C in next() may have freed it.
        if (!self.handle.closed())
          run([&](skein_error) { return skein_stream_free(*self.handle, {}) || true; });
        self.handle.release();
      });
}

}  // namespace skein::python
