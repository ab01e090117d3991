#include "live_domain.hpp"

#include <mutex>
#include <set>
#include <utility>

#include "command/mission/missions_elsewhere.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"

namespace skein::command::designer {

/// Shared by the thread that looks and those that serve requests.
class LiveDomain::Shown {
 public:
  void arrange(DomainState& state) {
    std::lock_guard lock(mutex_);
    layout_.arrange(state.entities, state.links);
    if (!layout_.failure().empty()) state.troubles.push_back(layout_.failure());
    launchers_.clear();
    for (const auto& mission : state.missions) launchers_.insert(mission.launcher);
  }
  void move(const std::string& entity, Place to) {
    std::lock_guard lock(mutex_);
    layout_.move(entity, to);
  }
  void restore(std::map<std::string, Place> places) {
    std::lock_guard lock(mutex_);
    layout_.restore(std::move(places));
  }
  void forget() {
    std::lock_guard lock(mutex_);
    layout_.forget();
  }
  /// A page does not reach missions that it does not show.
  void demand_launcher(int launcher) {
    std::lock_guard lock(mutex_);
    if (launcher > 0 && launchers_.contains(static_cast<std::uint32_t>(launcher))) return;
    throw Unavailable("process " + std::to_string(launcher) +
                      " is no launcher of a mission that is shown here");
  }

 private:
  std::mutex mutex_;
  Layout layout_;
  std::set<std::uint32_t> launchers_;
};

LiveDomain::LiveDomain(const DesignerArguments& arguments, std::optional<Plan> plan,
                       std::function<bool()> gives_up)
    : faults_(arguments.faults),
      domain_(arguments.watched_domain()),
      plan_(std::move(plan)),
      gives_up_(std::move(gives_up)),
      shown_(std::make_unique<Shown>()),
      entity_(join(arguments, "designer")) {}

LiveDomain::~LiveDomain() = default;

std::shared_ptr<const std::string> LiveDomain::look() {
  if (!watch_) watch_.emplace(entity_, domain_, plan_, gives_up_);
  DomainState state = watch_->look();
  state.faults = faults_;
  if (plan_) state.plan = plan_->file;
  shown_->arrange(state);
  if (const std::string elsewhere = missions_elsewhere(domain_);
      state.entities.empty() && !elsewhere.empty())
    state.troubles.push_back(elsewhere);
  return std::make_shared<const std::string>(idl::to_json(state));
}

Actions LiveDomain::actions() {
  return {[this](int launcher, const std::string& request) {
            shown_->demand_launcher(launcher);
            return launch::ask_launcher(launcher, request);
          },
          [this](const std::string& name, Place to) { shown_->move(name, to); },
          [this] { shown_->forget(); }, faults_};
}

void LiveDomain::place(std::map<std::string, Place> places) { shown_->restore(std::move(places)); }

}  // namespace skein::command::designer
