#include "parts.hpp"
#include "running.hpp"

namespace skein::python {
namespace {

/// What judges the results of a task: functions, or None.
struct Judges {
  std::shared_ptr<Operation> operation;
  py::object evaluate;
  py::object quality;
  py::object cost;
};

/// What one of them says of a result, as `convert` makes it; `otherwise` if it fails.
template <class Value, class Convert>
Value judge(const Judges& judges, const py::object& function, const skein_value* result,
            Value otherwise, const Convert& convert, skein_error reason = {}) {
  const Entered entered;
  if (!entered) return otherwise;
  try {
    return convert(function(decoded([&] { return judges.operation->decode_results(*result); })));
  } catch (py::error_already_set& thrown) {
    skein_error_set(reason, SKEIN_INTERNAL, thrown.what());
    thrown.discard_as_unraisable("a function that judges the results of a task");
  } catch (const py::cast_error& wrong) {
    skein_error_set(reason, SKEIN_INTERNAL, wrong.what());
  }
  return otherwise;
}

/// Python's function returns True, or why the result is not accepted: a str, or False.
bool evaluate(void* user, const skein_value* result, skein_error reason) {
  const auto& judges = *static_cast<Judges*>(user);
  const auto is_accepted = [&](const py::object& said) {
    if (!PyUnicode_Check(said.ptr()) && !said.is_none()) return is_true(said);
    skein_error_set(reason, SKEIN_INTERNAL,
                    said.is_none() ? "evaluate() returned None; return True, or why not"
                                   : py::cast<std::string>(said).c_str());
    return false;
  };
  return judge(judges, judges.evaluate, result, false, is_accepted, reason);
}

double number_of(const py::object& said) { return py::cast<double>(said); }

double quality(void* user, const skein_value* result) {
  const auto& judges = *static_cast<Judges*>(user);
  return judge(judges, judges.quality, result, 0.0, number_of);
}

double cost(void* user, const skein_value* result) {
  const auto& judges = *static_cast<Judges*>(user);
  return judge(judges, judges.cost, result, std::numeric_limits<double>::infinity(), number_of);
}

struct Performed {
  OwnedResult result;
  OwnedResult decision;
};

/// Texts and numbers of a task, which live as long as it runs.
struct Request {
  std::string operation;
  Bytes arguments;
  std::string name;
  std::string only;
  std::vector<std::pair<std::string, double>> features;
  std::size_t width;
  std::size_t enough;
  std::int64_t limit_ns;
  int execution;

  skein_task task(std::vector<skein_feature>& listed) const {
    for (const auto& [feature, value] : features) listed.push_back({feature.c_str(), value});
    skein_task made{};
    made.operation = operation.c_str();
    made.arguments = cdr_of(arguments);
    if (!name.empty()) made.request = name.c_str();
    if (!only.empty()) made.only = only.c_str();
    made.features = listed.data();
    made.features_size = listed.size();
    made.width = width;
    made.enough = enough;
    made.limit_ns = limit_ns;
    made.execution = execution;
    return made;
  }
};

bool perform_on(skein_entity entity, skein_interface interface, const Request& request,
                Judges& judges, Performed& performed, skein_error error) {
  std::vector<skein_feature> features;
  const skein_task task = request.task(features);
  const skein_task_callbacks callbacks{&judges, judges.evaluate ? evaluate : nullptr,
                                       judges.quality ? quality : nullptr,
                                       judges.cost ? cost : nullptr};
  skein_result result{};
  skein_result decision{};
  const bool done =
      skein_entity_perform(entity, interface, &task, &callbacks, &result, &decision, error);
  performed = {OwnedResult(result), OwnedResult(decision)};
  return done;
}

py::object or_nothing(const py::object& function) {
  return function.is_none() ? py::object() : function;
}

/// The result, and the record of the decision as JSON.
py::tuple perform(const Entity& entity, const std::shared_ptr<Operation>& operation,
                  const py::tuple& arguments, const std::string& name, const std::string& only,
                  std::vector<std::pair<std::string, double>> features, std::size_t width,
                  std::size_t enough, std::int64_t limit_ns, int execution,
                  const py::object& evaluate, const py::object& quality, const py::object& cost) {
  // Its last owner may be the thread that runs the task.
  const std::shared_ptr<Judges> judges(
      new Judges{operation, or_nothing(evaluate), or_nothing(quality), or_nothing(cost)},
      [](Judges* held) {
        if (PyGILState_Check() != 0) return delete held;
        const Entered entered;
        if (entered) delete held;
      });
  const auto request = std::make_shared<Request>(
      Request{operation->name, operation->encode_arguments(arguments), name, only,
              std::move(features), width, enough, limit_ns, execution});
  const std::function<bool(Performed&, skein_error)> wait =
      [handle = *entity.handle, interface = operation->interface->handle(), request, judges](
          Performed& performed, skein_error error) {
        return perform_on(handle, interface, *request, *judges, performed, error);
      };
  const Performed performed = wait_for(wait, operation->interface.get());
  const skein_value decision = value_of(performed.decision);
  return py::make_tuple(operation->decode_results(value_of(performed.result)),
                        py::str(static_cast<const char*>(decision.data), decision.size));
}

}  // namespace

void define_task(py::module_& module) { module.def("perform", &perform); }

}  // namespace skein::python
