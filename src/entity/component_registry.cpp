#include "skein/component_registry.hpp"

#include <algorithm>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <set>

#include "core/clock_wait.hpp"
#include "core/system/shared_object.hpp"
#include "core/threads/run_user_code.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/selection.hpp"

namespace skein {
namespace {

template <class Value>
const Value* find_in(const std::map<std::string, Value>& map, const std::string& name) {
  const auto found = map.find(name);
  return found == map.end() ? nullptr : &found->second;
}

/// What was registered before the plugin that this thread is loading; null where it loads none.
thread_local const std::vector<std::string>* names_before = nullptr;

std::string remedy_for_duplicate(const std::string& name) {
  return names_before && std::ranges::count(*names_before, name) == 0
             ? "; this plugin registers it twice: keep one, or give it another name"
             : "; load only one of the plugins that hold it";
}

}  // namespace

void ComponentRegistry::add_body(const std::string& component, BodyFactory factory) {
  refuse_duplicate(component);
  bodies_[component] = std::move(factory);
}

void ComponentRegistry::add_csp(const std::string& component, CspFactory factory) {
  refuse_duplicate(component);
  csps_[component] = std::move(factory);
}

void ComponentRegistry::add_mission(const std::string& component, Mission mission) {
  refuse_duplicate(component);
  missions_[component] = std::move(mission);
}

void ComponentRegistry::add_activity(const std::string& component, Activity activity) {
  add_activity(component, ActivityFactory([activity = std::move(activity)](
                                              Entity& entity, const ParameterValues& values) {
                 return [activity, &entity, values](const std::stop_token& told_to_end) {
                   return activity(entity, values, told_to_end);
                 };
               }));
}

void ComponentRegistry::add_activity(const std::string& component, ActivityFactory factory) {
  refuse_duplicate(component);
  activities_[component] = std::move(factory);
}

void ComponentRegistry::add_value_check(const std::string& parameter, ValueCheck check) {
  checks_.emplace(parameter, std::move(check));
}

void ComponentRegistry::add_strategy(std::shared_ptr<const SelectionStrategy> strategy) {
  const std::string name = strategy->name();
  if (std::ranges::count(StrategyFactory().names(), name) > 0) {
    throw InvalidArgument("'" + name +
                          "' is one of Skein's own selection strategies; give yours another name");
  }
  for (const auto& known : strategies_) {
    if (known->name() != name) continue;
    throw InvalidArgument("two selection strategies '" + name + "' are registered" +
                          remedy_for_duplicate(name));
  }
  strategies_.push_back(std::move(strategy));
}

const ComponentRegistry::BodyFactory* ComponentRegistry::find_body(
    const std::string& component) const {
  return find_in(bodies_, component);
}

const ComponentRegistry::CspFactory* ComponentRegistry::find_csp(
    const std::string& component) const {
  return find_in(csps_, component);
}

const ComponentRegistry::Mission* ComponentRegistry::find_mission(
    const std::string& component) const {
  return find_in(missions_, component);
}

const ComponentRegistry::ActivityFactory* ComponentRegistry::find_activity(
    const std::string& component) const {
  return find_in(activities_, component);
}

void ComponentRegistry::check_value(const std::string& parameter,
                                    const ParameterValue& value) const {
  const auto [first, last] = checks_.equal_range(parameter);
  std::for_each(first, last, [&](const auto& check) { check.second(value); });
}

const InterfaceInfo* ComponentRegistry::find_interface(const std::string& component) const {
  const auto found = implemented_.find(component);
  return found == implemented_.end() ? nullptr : found->second;
}

std::vector<std::string> ComponentRegistry::names() const {
  std::set<std::string> names;
  for (const auto& [name, factory] : bodies_) names.insert(name);
  for (const auto& [name, factory] : csps_) names.insert(name);
  for (const auto& [name, mission] : missions_) names.insert(name);
  for (const auto& [name, activity] : activities_) names.insert(name);
  return {names.begin(), names.end()};
}

void ComponentRegistry::load_plugin(const std::string& name) {
  const SharedObject plugin(name, "build or install the plugin '" + name + "'",
                            SharedObject::Maker::User);
  plugin.check_abi("skein_plugin_abi");
  const auto register_components =
      plugin.function<void(ComponentRegistry&)>("skein_register_components");
  std::vector<std::string> before = names();
  for (const auto& strategy : strategies_) before.push_back(strategy->name());
  names_before = &before;
  const auto forget = [](const auto*) { names_before = nullptr; };
  const std::unique_ptr<const std::vector<std::string>, decltype(forget)> loading(&before, forget);
  run_user_code(plugin.file() + ", while it registered its components: ",
                [&] { register_components(*this); });
}

void ComponentRegistry::refuse_duplicate(const std::string& component) const {
  if (find_body(component) || find_csp(component) || find_mission(component) ||
      find_activity(component)) {
    throw InvalidArgument("two implementations of component '" + component + "' are registered" +
                          remedy_for_duplicate(component));
  }
}

bool await_end(Entity& entity, const std::stop_token& told_to_end, Duration at_most) {
  std::mutex mutex;
  std::condition_variable changed;
  const std::stop_callback wakes(told_to_end, [&] {
    const std::lock_guard lock(mutex);
    changed.notify_all();
  });
  std::unique_lock lock(mutex);
  const auto told = [&] { return told_to_end.stop_requested(); };
  return wait_until(entity.clock(), entity.clock().after(at_most), lock, changed, told);
}

}  // namespace skein
