#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "browser.hpp"
#include "command/commands.hpp"
#include "command/mission/missions_elsewhere.hpp"
#include "command/print/interruption.hpp"
#include "core/printable.hpp"
#include "layout.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "page_hub.hpp"
#include "recorded_states.hpp"
#include "requests.hpp"
#include "site.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "view/gate.hpp"
#include "watch.hpp"

namespace skein::command {
namespace {

using namespace designer;

constexpr double kLookSeconds = 1;
constexpr double kUntilWatchedSeconds = 0.2;
constexpr std::size_t kLongestWarning = 1024;

std::optional<Plan> plan_in(const DesignerArguments& arguments) {
  if (arguments.profile.empty()) return std::nullopt;
  return plan_of(profile::read_mission_profile(arguments.profile,
                                               profile::parse_variables(arguments.variables)));
}

/// Shared by the thread that looks and those that serve requests.
class Shown {
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

view::WebSocketOptions socket_options(const DesignerArguments& arguments) {
  view::WebSocketOptions options;
  options.address = "127.0.0.1";
  options.port = arguments.port;
  options.max_clients = 64;
  options.max_message = std::size_t{64} << 10;
  options.handshake = std::chrono::seconds(5);
  options.patience = std::chrono::seconds(30);
  return options;
}

/// The listener with its address.
class OpenSite {
 public:
  OpenSite(const DesignerArguments& arguments, Site::Content content,
           const std::shared_ptr<PageHub>& hub)
      : site_(arguments.token.empty() ? view::random_token() : arguments.token, std::move(content)),
        listener_(
            socket_options(arguments),
            [this](const view::Visit& visit) { return site_.reply(visit); },
            [hub](view::Connection& connection) { return hub->open(connection); }) {
    site_.listens_at(listener_.port());
    std::printf("Open this in a browser. Whoever knows it may look%s.\n%s\n",
                arguments.watch ? ", and restart and stop missions" : "", site_.url().c_str());
    std::fflush(stdout);
    if (!arguments.no_browser) browser_.emplace(site_.url());
  }

 private:
  Site site_;
  const view::WebSocketListener listener_;
  std::optional<Browser> browser_;
};

int replay(const DesignerArguments& arguments) {
  const Interruption interruption;
  const RecordedStates states(arguments.replay);
  for (const std::string& problem : states.problems())
    std::fprintf(stderr, "skein: %s\n", printable(problem, kLongestWarning).c_str());
  const auto at = [&](std::optional<std::uint64_t> time) { return states.at(time.value_or(0)); };
  const OpenSite site(arguments, {at, states.times()}, nullptr);
  interruption.wait(0);
  return 0;
}

int watch_domain(const DesignerArguments& arguments) {
  const Interruption interruption;
  const std::optional<Plan> plan = plan_in(arguments);
  const std::uint32_t domain = arguments.watched_domain();
  Entity entity = join(arguments, "designer");
  Shown shown;
  const Actions actions{[&](int launcher, const std::string& request) {
                          shown.demand_launcher(launcher);
                          return launch::ask_launcher(launcher, request);
                        },
                        [&](const std::string& name, Place to) { shown.move(name, to); },
                        [&] { shown.forget(); }, arguments.faults};
  const auto hub = std::make_shared<PageHub>(PageHub::Obey{
      [&](std::string_view request) { return obey(request, actions); }, asks_launcher});
  const OpenSite site(arguments, {[&](auto) { return hub->look(); }}, hub);
  std::optional<DomainWatch> watch;  // none while nobody looks
  do {
    if (!hub->is_watched()) {
      if (watch) hub->publish(nullptr);
      watch.reset();
      continue;
    }
    if (!watch) watch.emplace(entity, domain, plan, interruption.gives_up());
    DomainState state = watch->look();
    state.faults = arguments.faults;
    if (plan) state.plan = plan->file;
    shown.arrange(state);
    if (const std::string elsewhere = missions_elsewhere(domain);
        state.entities.empty() && !elsewhere.empty())
      state.troubles.push_back(elsewhere);
    hub->publish(std::make_shared<const std::string>(idl::to_json(state)));
  } while (!interruption.wait(watch ? kLookSeconds : kUntilWatchedSeconds));
  hub->close();
  return 0;
}

}  // namespace

int serve_designer(const DesignerArguments& arguments) {
  return arguments.watch ? watch_domain(arguments) : replay(arguments);
}

}  // namespace skein::command
