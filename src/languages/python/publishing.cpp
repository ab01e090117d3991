#include "parts.hpp"
#include "running.hpp"

namespace skein::python {
namespace {

using OwnedPublisher = Owned<skein_publisher, skein_publisher_free>;
using OwnedSubscription = Owned<skein_subscription, skein_subscription_free>;

/// The options, in which the texts live as long as `systems`.
struct TopicOptions {
  TopicOptions(const std::vector<std::string>& systems, int profile, std::int64_t period_ns,
               int strength) {
    for (const std::string& system : systems) texts.push_back(system.c_str());
    options.systems = texts.data();
    options.systems_size = texts.size();
    options.profile = profile;
    options.period_ns = period_ns;
    options.strength = strength;
    options.encoding = SKEIN_CDR;
  }
  std::vector<const char*> texts;
  skein_topic_options options{};
};

struct Publisher {
  std::shared_ptr<Interface> types;
  const Node* node;
  OwnedPublisher handle;

  void publish(const py::object& value) const {
    const Bytes message = encode(*node, value);
    run([&](skein_error error) {
      return skein_publisher_publish(*handle, cdr_of(message), error);
    });
  }

  std::size_t subscribers() const {
    std::size_t count = 0;
    run([&](skein_error error) { return skein_publisher_subscribers(*handle, &count, error); });
    return count;
  }
};

/// Whether all subscribers have what was published.
struct Acknowledged {
  bool all = false;
};

bool wait(const Publisher& publisher, std::int64_t timeout_ns) {
  const std::function<bool(Acknowledged&, skein_error)> waits =
      [handle = *publisher.handle, timeout_ns](Acknowledged& result, skein_error error) {
        return skein_publisher_wait(handle, timeout_ns, &result.all, error);
      };
  return wait_for(waits).all;
}

/// Whose values a callback gets.
struct Reader {
  std::shared_ptr<Interface> types;
  const Node* node;
  py::object callback;
};

void on_value(void* user, const skein_value* value) {
  const Entered entered;
  if (!entered) return;
  const auto& reader = *static_cast<Reader*>(user);
  try {
    reader.callback(decoded([&] { return decode(*reader.node, bytes_of(*value)); }));
  } catch (py::error_already_set& thrown) {
    thrown.discard_as_unraisable("a callback of a subscription");
  }
}

struct Subscription {
  OwnedSubscription handle;

  std::size_t publishers() const {
    std::size_t count = 0;
    run([&](skein_error error) { return skein_subscription_publishers(*handle, &count, error); });
    return count;
  }
};

}  // namespace

void define_topics(py::module_& module) {
  py::class_<Publisher, std::shared_ptr<Publisher>>(module, "Publisher")
      .def(py::init([](const Entity& entity, const std::shared_ptr<Interface>& types,
                       const std::string& type, const std::string& topic,
                       const std::vector<std::string>& systems, int profile, std::int64_t period_ns,
                       int strength) {
        const Node* const node = &types->node(type);
        const TopicOptions given(systems, profile, period_ns, strength);
        skein_publisher made{};
        run([&](skein_error error) {
          return skein_publisher_new(*entity.handle, types->handle(), type.c_str(), topic.c_str(),
                                     &given.options, &made, error);
        });
        return std::make_shared<Publisher>(Publisher{types, node, OwnedPublisher(made)});
      }))
      .def("publish", &Publisher::publish)
      .def("subscribers", &Publisher::subscribers)
      .def("wait", &wait)
      .def("close", [](Publisher& self) { self.handle.close(); });
  py::class_<Subscription, std::shared_ptr<Subscription>>(module, "Subscription")
      .def(py::init([](const Entity& entity, const std::shared_ptr<Interface>& types,
                       const std::string& type, const std::string& topic,
                       const std::vector<std::string>& systems, int profile, std::int64_t period_ns,
                       const py::object& callback) {
        auto reader = std::make_unique<Reader>(Reader{types, &types->node(type), callback});
        const TopicOptions given(systems, profile, period_ns, 0);
        const skein_subscription_callbacks callbacks{reader.get(), on_value, drop<Reader>};
        skein_subscription made{};
        run([&](skein_error error) {
          return skein_subscription_new(*entity.handle, types->handle(), type.c_str(),
                                        topic.c_str(), &given.options, &callbacks, &made, error);
        });
        static_cast<void>(reader.release());  // which on_close has now
        return std::make_shared<Subscription>(Subscription{OwnedSubscription(made)});
      }))
      .def("publishers", &Subscription::publishers)
      .def("close", [](Subscription& self) { self.handle.close(); });
}

}  // namespace skein::python
