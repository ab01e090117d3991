#include "live_parameters.hpp"

#include <algorithm>
#include <optional>

#include "core/suggestion.hpp"
#include "skein/error.hpp"

namespace skein::launch {

/// Of one component, whose parameters have the prefix.
class LiveParameters::Host final : public ParameterHost {
 public:
  Host(std::shared_ptr<LiveParameters> all, std::string prefix)
      : all_(std::move(all)), prefix_(std::move(prefix)) {}

  std::shared_ptr<void> add_live(const std::string& name, Change change) override {
    all_->make_live(prefix_ + name, std::move(change));
    return {all_.get(), [all = all_, whole = prefix_ + name](void*) { all->fix(whole); }};
  }

 private:
  const std::shared_ptr<LiveParameters> all_;
  const std::string prefix_;
};

ParameterValues LiveParameters::values_of(const std::string& prefix,
                                          const std::vector<profile::Setting>& settings) {
  ParameterValues values;
  const std::lock_guard lock(mutex_);
  for (const profile::Setting& setting : settings) {
    const auto* entry = dictionary_.find(profile::EntryKind::Parameter, setting.name);
    if (!entry) continue;
    values.set(setting.name, profile::parse_value(*entry, setting.value));
    const std::string text = profile::plain_text(*entry, setting.value);
    parameters_[prefix + setting.name] = {entry, text, text};
  }
  values.set_host(std::make_shared<Host>(shared_from_this(), prefix));
  return values;
}

void LiveParameters::make_live(const std::string& name, Change change) {
  bool first = false;
  {
    const std::lock_guard lock(mutex_);
    Parameter& parameter = find(name);
    if (parameter.change) {
      throw InvalidArgument("the parameter '" + name +
                            "' is live already; keep what live() returned, and copy it");
    }
    parameter.change = std::make_shared<const Change>(std::move(change));
    first = !offered_;
    offered_ = true;
  }
  if (!first) return;
  try {
    offer_(shared_from_this());
  } catch (...) {
    fix(name);
    const std::lock_guard lock(mutex_);
    offered_ = false;
    throw;
  }
}

void LiveParameters::fix(const std::string& name) {
  std::shared_ptr<const Change> old;  // goes without the locks
  const std::lock_guard changing(changing_);
  const std::lock_guard lock(mutex_);
  Parameter& parameter = parameters_.at(name);
  old.swap(parameter.change);
  parameter.value = parameter.given;
}

LiveParameters::Parameter& LiveParameters::find(const std::string& name) {
  const auto found = parameters_.find(name);
  if (found != parameters_.end()) return found->second;
  std::vector<std::string> names;
  std::string list;
  for (const auto& [known, parameter] : parameters_) {
    names.push_back(known);
    list += (list.empty() ? "" : ", ") + known;
  }
  const std::string nearest = suggestion(name, names);
  throw InvalidArgument("there is no parameter '" + name + "'" +
                        (nearest.empty() ? "; there are " + list : nearest));
}

RunningParameter LiveParameters::told(const std::string& name, const Parameter& parameter) {
  const auto limit = [](const std::optional<double>& number) {
    return number ? std::vector<double>{*number} : std::vector<double>();
  };
  const profile::DictionaryEntry& entry = *parameter.entry;
  return {name,
          parameter.value,
          std::string(to_string(entry.type)),
          entry.unit,
          limit(entry.minimum),
          limit(entry.maximum),
          parameter.change != nullptr,
          entry.documentation};
}

std::vector<RunningParameter> LiveParameters::parameters() {
  const std::lock_guard lock(mutex_);
  std::vector<RunningParameter> all;
  for (const auto& [name, parameter] : parameters_) all.push_back(told(name, parameter));
  return all;
}

RunningParameter LiveParameters::set(const std::string& name, const std::string& value) {
  const std::lock_guard changing(changing_);
  std::shared_ptr<const Change> change;
  ParameterValue wanted;
  std::string text, plain_name;
  {
    const std::lock_guard lock(mutex_);
    const Parameter& parameter = find(name);
    if (!parameter.change) {
      throw InvalidArgument("'" + name +
                            "' may not change while its component runs; set it in the mission "
                            "profile, or by `skein launch --set`, and start the peer anew");
    }
    wanted = profile::parse_value(*parameter.entry, value);
    text = profile::plain_text(*parameter.entry, value);
    change = parameter.change;
    plain_name = parameter.entry->name;
  }
  try {
    check_(plain_name, wanted);
    (*change)(wanted);
  } catch (const std::exception& error) {
    throw ValueRefused(error.what());
  }
  const std::lock_guard lock(mutex_);
  Parameter& parameter = find(name);
  parameter.value = text;
  return told(name, parameter);
}

}  // namespace skein::launch
