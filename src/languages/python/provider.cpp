#include <map>

#include "parts.hpp"
#include "running.hpp"

namespace skein::python {
namespace {

using OwnedProvider = Owned<skein_provider, skein_provider_free>;
using OwnedReply = Owned<skein_reply, skein_reply_free>;

/// The pending reply to one call.
class Reply {
 public:
  Reply(std::shared_ptr<Operation> operation, skein_reply handle)
      : operation_(std::move(operation)), handle_(handle) {}

  void answer(const py::object& results) {
    const Bytes message = operation_->encode_results(results);
    end([&](skein_error error) { return skein_reply_answer(*handle_, cdr_of(message), error); });
  }

  void fail(int kind, const std::string& text) {
    end([&](skein_error error) { return skein_reply_fail(*handle_, kind, text.c_str(), error); });
  }

  void raise(const std::string& exception, const py::object& members) {
    const Bytes message = encode(operation_->interface->node(exception), members);
    end([&](skein_error error) {
      return skein_reply_raise(*handle_, exception.c_str(), cdr_of(message), error);
    });
  }

  void push(const py::object& item) {
    const Bytes message = operation_->encode_results(item);
    run([&](skein_error error) {
      return skein_reply_push(*handle_, cdr_of(message), nullptr, error);
    });
  }

  bool cancelled() const {
    bool cancelled = true;  // as one that has ended is
    run([&](skein_error) { return skein_reply_cancelled(*handle_, &cancelled, {}) || true; });
    return cancelled;
  }

  std::int64_t time_left() const {
    std::int64_t left_ns = 0;
    run([&](skein_error error) { return skein_reply_time_left(*handle_, &left_ns, error); });
    return left_ns;
  }

  void on_cancel(const py::object& callback) {
    auto held = std::make_unique<py::object>(callback);
    const skein_cancel_callbacks callbacks{held.get(), call, drop<py::object>};
    run([&](skein_error error) { return skein_reply_on_cancel(*handle_, &callbacks, error); });
    static_cast<void>(held.release());  // which on_close has now
  }

 private:
  /// The reply has ended if the function succeeds.
  template <class Function>
  void end(const Function& function) {
    run(function);
    handle_.release();
  }

  static void call(void* user) {
    const Entered entered;
    if (!entered) return;
    try {
      (*static_cast<py::object*>(user))();
    } catch (py::error_already_set& thrown) {
      thrown.discard_as_unraisable("an on_cancel() callback");
    }
  }

  const std::shared_ptr<Operation> operation_;
  OwnedReply handle_;
};

/// The implementation of an interface: functions that take arguments and a Reply.
struct Service {
  struct Method {
    std::shared_ptr<Operation> operation;
    py::object function;
  };
  std::map<std::string, Method, std::less<>> methods;
};

void fail(skein_reply reply, skein_error_kind kind, const std::string& text) {
  const Unlocked unlocked;
  skein_reply_fail(reply, kind, text.c_str(), {});
}

void on_call(void* user, const char* operation, const skein_value* arguments, skein_reply handle) {
  const Entered entered;
  if (!entered) return void(skein_reply_fail(handle, SKEIN_UNAVAILABLE, "its process ends", {}));
  const auto& methods = static_cast<Service*>(user)->methods;
  const auto found = methods.find(std::string_view(operation));
  if (found == methods.end()) {
    return fail(handle, SKEIN_UNIMPLEMENTED, "its provider does not implement the operation");
  }
  try {
    const auto& [known, function] = found->second;
    const py::tuple given = known->decode_arguments(*arguments);
    function(given, std::make_shared<Reply>(known, handle));
  } catch (py::error_already_set& thrown) {
    thrown.discard_as_unraisable("a call of a service");
    fail(handle, SKEIN_INTERNAL, "its provider could not answer");
  } catch (const std::exception& thrown) {
    fail(handle, SKEIN_INTERNAL, thrown.what());
  }
}

std::shared_ptr<OwnedProvider> provide(
    const Entity& entity, const std::shared_ptr<Interface>& interface, const py::dict& methods,
    const std::vector<std::pair<std::string, std::string>>& attributes,
    const std::string& component, const std::string& csp, const std::string& owner,
    std::size_t threads, std::size_t queue) {
  auto service = std::make_unique<Service>();
  for (const auto& [name, function] : methods) {
    const auto text = py::cast<std::string>(name);
    service->methods[text] = {interface->operation(text),
                              py::reinterpret_borrow<py::object>(function)};
  }
  std::vector<skein_attribute> declared;
  for (const auto& [name, value] : attributes) declared.push_back({name.c_str(), value.c_str()});
  skein_service_options options{};
  options.attributes = declared.data();
  options.attributes_size = declared.size();
  if (!component.empty()) options.component = component.c_str();
  if (!csp.empty()) options.csp = csp.c_str();
  if (!owner.empty()) options.owner = owner.c_str();
  options.threads = threads;
  options.queue = queue;
  options.encoding = SKEIN_CDR;
  const skein_service_callbacks callbacks{service.get(), on_call, drop<Service>};
  skein_provider made{};
  run([&](skein_error error) {
    return skein_provider_new(*entity.handle, interface->handle(), &options, &callbacks, &made,
                              error);
  });
  static_cast<void>(service.release());  // which on_close has now
  return std::make_shared<OwnedProvider>(made);
}

}  // namespace

void define_provider(py::module_& module) {
  py::class_<OwnedProvider, std::shared_ptr<OwnedProvider>>(module, "Provider")
      .def(py::init(&provide))
      .def(
          "identity",
          [](const OwnedProvider& self) {
            std::uint8_t identity[16];
            run([&](skein_error error) { return skein_provider_identity(*self, identity, error); });
            return py::bytes(reinterpret_cast<const char*>(identity), sizeof identity);
          })
      .def("close", &OwnedProvider::close);
  py::class_<Reply, std::shared_ptr<Reply>>(module, "Reply")
      .def("answer", &Reply::answer)
      .def("fail", &Reply::fail)
      .def("raise_", &Reply::raise)
      .def("push", &Reply::push)
      .def("cancelled", &Reply::cancelled)
      .def("time_left_ns", &Reply::time_left)
      .def("on_cancel", &Reply::on_cancel);
}

}  // namespace skein::python
