#include "parts.hpp"
#include "running.hpp"
#include "skein/error.hpp"

namespace skein::python {
namespace {

std::vector<const char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  return pointers;
}

std::shared_ptr<Entity> make_entity(const std::string& name, const std::string& system,
                                    const std::string& vendor,
                                    const std::vector<std::string>& network,
                                    const std::vector<std::string>& peers, std::uint32_t domain,
                                    bool multicast, bool shared_memory_calls,
                                    std::int64_t lease_ns) {
  const auto interfaces = pointers_to(network);
  const auto hosts = pointers_to(peers);
  skein_entity_options options{};
  options.name = name.c_str();
  if (!system.empty()) options.system = system.c_str();
  options.vendor = vendor.c_str();
  options.network = interfaces.data();
  options.network_size = interfaces.size();
  options.peers = hosts.data();
  options.peers_size = hosts.size();
  options.domain = domain;
  options.multicast = multicast;
  options.no_shared_memory_calls = !shared_memory_calls;
  options.lease_ns = lease_ns;
  skein_entity made{};
  run([&](skein_error error) { return skein_entity_new(&options, &made, error); });
  return std::make_shared<Entity>(Entity{Owned<skein_entity, skein_entity_free>(made)});
}

std::string id_of(const Entity& entity) {
  const char* id = nullptr;
  run([&](skein_error error) { return skein_entity_id(*entity.handle, &id, error); });
  return id;
}

struct Drained {
  bool whole = false;
};

bool drain(const Entity& entity, std::int64_t patience_ns) {
  const std::function<bool(Drained&, skein_error)> wait = [handle = *entity.handle, patience_ns](
                                                              Drained& result, skein_error error) {
    return skein_entity_drain(handle, patience_ns, &result.whole, error);
  };
  return wait_for(wait).whole;
}

using Fetch = std::function<bool(skein_interface*, skein_error)>;

std::shared_ptr<Interface> fetched(const Fetch& fetch) {
  const std::function<bool(Interface::Handle&, skein_error)> wait =
      [fetch](Interface::Handle& result, skein_error error) {
        skein_interface made{};
        if (!fetch(&made, error)) return false;
        result = Interface::Handle(made);
        return true;
      };
  return std::make_shared<Interface>(wait_for(wait));
}

std::shared_ptr<Interface> fetch_interface(const Entity& entity, const std::string& name,
                                           std::int64_t timeout_ns) {
  return fetched(
      [entity = *entity.handle, name, timeout_ns](skein_interface* out, skein_error error) {
        return skein_interface_fetch(entity, name.c_str(), timeout_ns, out, error);
      });
}

std::shared_ptr<Interface> fetch_topic(const Entity& entity, const std::string& topic,
                                       std::int64_t timeout_ns) {
  return fetched(
      [entity = *entity.handle, topic, timeout_ns](skein_interface* out, skein_error error) {
        return skein_interface_fetch_topic(entity, topic.c_str(), timeout_ns, out, error);
      });
}

void define_entity(py::module_& module) {
  py::class_<Entity, std::shared_ptr<Entity>>(module, "Entity")
      .def(py::init(&make_entity))
      .def("id", &id_of)
      .def("drain", &drain)
      .def("fetch", &fetch_interface)
      .def("fetch_topic", &fetch_topic)
      .def("close", [](Entity& self) { self.handle.close(); });
}

void define_log(py::module_& module) {
  module.def("log", [](int level, const std::string& place, const std::string& text) {
    run([&](skein_error error) {
      return skein_log_write(level, place.c_str(), text.c_str(), error);
    });
  });
}

/// Turns exceptions of C++, from reading and writing values, into those of Python.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(std::move(thrown));
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const Error&) {
    try {
      raise(c::failure_of(std::current_exception()));
    } catch (py::error_already_set& error) {
      error.restore();
    }
  }
}

}  // namespace
}  // namespace skein::python

PYBIND11_MODULE(_skein, module) {
  using namespace skein::python;
  module.doc() = "The native half of the package skein.";
  py::register_local_exception_translator(&translate);
  module.attr("VERSION") = SKEIN_VERSION_TEXT;
  module.def("set_classes", [](py::tuple errors, py::object array, py::object reference) {
    set_error_classes(std::move(errors));
    Classes::known() = {std::move(array), std::move(reference)};
  });
  module.def("set_main_thread", &set_main_thread);
  module.def("forbid_after_fork", &forbid_after_fork);
  module.def("leave_python", &leave_python);
  define_interface(module);
  define_entity(module);
  define_provider(module);
  define_proxy(module);
  define_task(module);
  define_topics(module);
  define_log(module);
}
