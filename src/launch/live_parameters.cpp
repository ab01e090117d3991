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
    parameters_[prefix + setting.name] = {entry, profile::plain_text(*entry, setting.value)};
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
    parameter.change = std::move(change);
    first = !offered_;
    offered_ = true;
  }
  if (first) offer_(shared_from_this());
}

void LiveParameters::fix(const std::string& name) {
  Change old;  // goes without the lock
  const std::lock_guard lock(mutex_);
  old.swap(parameters_.at(name).change);
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
  const std::lock_guard lock(mutex_);
  Parameter& parameter = find(name);
  if (!parameter.change) {
    throw InvalidArgument("'" + name +
                          "' may not change while its component runs; set it in the mission "
                          "profile, or by `skein launch --set`, and start the peer anew");
  }
  const ParameterValue wanted = profile::parse_value(*parameter.entry, value);
  try {
    parameter.change(wanted);
  } catch (const std::exception& error) {
    throw ValueRefused(error.what());
  }
  parameter.value = profile::plain_text(*parameter.entry, value);
  return told(name, parameter);
}

}  // namespace skein::launch
