#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mission/component/dictionary.hpp"
#include "mission/profile/mission_profile.hpp"
#include "skein/live_parameters.idl.hpp"
#include "skein/parameters.hpp"

namespace skein::launch {

/// The parameters of the components of one process, and those of them that may change while these
/// run: what `skein param` asks. Thread-safe; a change that does not return holds up other changes.
class LiveParameters final : public ILiveParameters,
                             public std::enable_shared_from_this<LiveParameters> {
 public:
  using Offer = std::function<void(std::shared_ptr<ILiveParameters> service)>;
  /// Throws what a check of the parameter throws, whose name is without a prefix.
  using Check = std::function<void(const std::string& name, const ParameterValue& value)>;
  /// `dictionary` outlives this object. `offer` is called once, on the thread of the component that
  /// is the first to declare a parameter that may change.
  LiveParameters(const profile::Dictionary& dictionary, Check check, Offer offer)
      : dictionary_(dictionary), check_(std::move(check)), offer_(std::move(offer)) {}

  /// What a component gets: its profile's values, as the dictionary types them. It has been checked
  /// that it knows them. `prefix` stands before the names of its parameters here.
  ParameterValues values_of(const std::string& prefix,
                            const std::vector<profile::Setting>& settings);

  std::vector<RunningParameter> parameters() override;
  RunningParameter set(const std::string& name, const std::string& value) override;

 private:
  class Host;
  using Change = std::function<void(const ParameterValue& value)>;
  struct Parameter {
    const profile::DictionaryEntry* entry = nullptr;
    std::string given;  ///< What the profile has, from which live() starts.
    std::string value;
    std::shared_ptr<const Change> change{};  ///< Null while it may not be changed.
  };

  void make_live(const std::string& name, Change change);
  void fix(const std::string& name);
  static RunningParameter told(const std::string& name, const Parameter& parameter);
  Parameter& find(const std::string& name);

  const profile::Dictionary& dictionary_;
  const Check check_;
  const Offer offer_;
  std::mutex changing_;  ///< Held while a component's code runs; comes before the other one.
  std::mutex mutex_;     ///< Guards what follows.
  bool offered_ = false;
  std::map<std::string, Parameter> parameters_;
};

}  // namespace skein::launch
