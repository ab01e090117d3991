#include "proxy_object.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/task.hpp"

namespace skein::c {
namespace {

using idl::DynamicValue;

/// What a task is templated by, where the interface is known at run time alone.
struct ValueInterface {
  using Proxy = ValueProxy;
};
using ValueTask = Task<ValueInterface, DynamicValue>;

Execution execution_of(skein_execution given) {
  if (given < SKEIN_EXECUTE_ONE || given > SKEIN_EXECUTE_ALL) {
    throw InvalidArgument(std::to_string(given) + " is no execution of a task");
  }
  return static_cast<Execution>(given);
}

void set_options(ValueTask& task, const skein_task& given) {
  check_reserved(given.reserved);
  if (given.request) task.request = given.request;
  if (given.only) task.only = given.only;
  if (given.features_size > 0) demand(given.features, "features");
  for (std::size_t i = 0; i < given.features_size; ++i) {
    task.features.push_back(
        {text_of(given.features[i].name, "a feature's name"), given.features[i].value});
  }
  if (given.width > 0) task.width = given.width;
  if (given.enough > 0) task.enough = given.enough;
  task.execution = execution_of(given.execution);
}

/// Runs a task's callbacks, in none of which the entity may be freed: it is in use.
class TaskCallbacks {
 public:
  TaskCallbacks(std::uint64_t entity, const skein_task_callbacks& given, skein_encoding encoding)
      : given_(given), encoding_(encoding), gate_(entity, given.user, nullptr) {}

  std::optional<std::string> evaluate(const DynamicValue& result) {
    const CallbackError reason;
    bool accepted = false;
    lend(result, [&](void* user, const skein_value* value) {
      accepted = given_.evaluate(user, value, reason.handle());
    });
    if (accepted) return std::nullopt;
    const std::string& text = reason.last()->text;
    return text.empty() ? "it was not accepted" : text;
  }

  double number(double (*function)(void*, const skein_value*), const DynamicValue& result) {
    double number = 0;
    lend(result, [&](void* user, const skein_value* value) { number = function(user, value); });
    return number;
  }

  void add_to(ValueTask& task) {
    if (given_.evaluate) {
      task.evaluate = [this](const DynamicValue& result) { return evaluate(result); };
    }
    if (given_.quality) {
      task.quality = [this](const DynamicValue& result) { return number(given_.quality, result); };
    }
    if (given_.cost) {
      task.synthesis = best_by_cost<DynamicValue>(
          [this](const DynamicValue& result) { return number(given_.cost, result); });
    }
  }

 private:
  void lend(const DynamicValue& result, const auto& callback) {
    const ResultObject lent(result, encoding_);
    const skein_value value = lent.value();
    gate_.run([&](void* user) { callback(user, &value); });
  }

  const skein_task_callbacks given_;
  const skein_encoding encoding_;
  CallbackGate gate_;
};

Awaited<DynamicValue> ask(const ValueProxy& csp, const Arguments& arguments) {
  if (arguments.operation.stream) {
    return Stream<DynamicValue>(
        csp.stream(arguments.operation, arguments.value), csp.channel(),
        [](void* out) { return std::move(*static_cast<DynamicValue*>(out)); });
  }
  auto pending = csp.start(arguments.operation, arguments.value);
  auto* const result = &pending->value;
  return ValueCall(std::move(pending), csp.channel(), result);
}

}  // namespace
}  // namespace skein::c

using namespace skein;
using namespace skein::c;

bool skein_entity_perform(skein_entity entity, skein_interface interface, const skein_task* task,
                          const skein_task_callbacks* callbacks, skein_result* out,
                          skein_result* decision, skein_error error) {
  return attempt(error, [&] {
    demand(task, "task");
    const auto known = find<InterfaceObject>(interface);
    const Arguments arguments = arguments_of(*known, task->operation, task->arguments);
    ValueTask made;
    set_options(made, *task);
    const skein_encoding encoding = task->arguments.encoding;
    TaskCallbacks given(entity.id, callbacks ? *callbacks : skein_task_callbacks{}, encoding);
    given.add_to(made);
    made.run = [&](ValueProxy& csp, Duration) { return ask(csp, arguments); };
    const auto object = find<EntityObject>(entity);
    const auto use = object->use();
    const Duration limit = time_of(task->limit_ns, "limit_ns", std::chrono::seconds(60));
    introspection::Decision record;
    const auto tell = [&] {
      if (decision) *decision = add(std::make_shared<ResultObject>(idl::to_json(record)));
    };
    try {
      auto result = use->head().perform(known->of(encoding).info(), made, &record, limit);
      if (out) *out = add(std::make_shared<ResultObject>(std::move(result), encoding));
    } catch (...) {
      tell();
      throw;
    }
    tell();
  });
}
