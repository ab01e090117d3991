#include "designer.hpp"

#include <cstdio>
#include <optional>
#include <string>

#include "command/print/interruption.hpp"
#include "core/printable.hpp"
#include "live_domain.hpp"
#include "mission/profile/mission_profile.hpp"
#include "page_hub.hpp"
#include "recorded_states.hpp"
#include "requests.hpp"
#include "site.hpp"

namespace skein::command::designer {
namespace {

constexpr double kLookSeconds = 1;
constexpr double kUntilWatchedSeconds = 0.2;
constexpr std::size_t kLongestWarning = 1024;
constexpr std::size_t kLargestRequest = std::size_t{64} << 10;

std::optional<Plan> plan_in(const DesignerArguments& arguments) {
  if (arguments.profile.empty()) return std::nullopt;
  return plan_of(profile::read_mission_profile(arguments.profile,
                                               profile::parse_variables(arguments.variables)));
}

}  // namespace

int replay(const DesignerArguments& arguments) {
  const Interruption interruption;
  const RecordedStates states(arguments.replay);
  for (const std::string& problem : states.problems())
    std::fprintf(stderr, "skein: %s\n", printable(problem, kLongestWarning).c_str());
  const auto at = [&](std::optional<std::uint64_t> time) { return states.at(time.value_or(0)); };
  const ServedSite site(
      {arguments.port, arguments.token, arguments.no_browser, kLargestRequest, "look"},
      {at, states.times()}, nullptr);
  interruption.wait(0);
  return 0;
}

int watch_domain(const DesignerArguments& arguments) {
  const Interruption interruption;
  LiveDomain domain(arguments, plan_in(arguments), interruption.gives_up());
  const Actions actions = domain.actions();
  const auto hub = std::make_shared<PageHub>(PageHub::Obey{
      [&](std::string_view request) { return obey(request, actions); }, asks_launcher});
  const ServedSite site({arguments.port, arguments.token, arguments.no_browser, kLargestRequest,
                         "look, and restart and stop missions"},
                        {[&](auto) { return hub->look(); }}, hub);
  do {
    if (hub->is_watched()) {
      hub->publish(PageHub::Kind::Domain, domain.look());
    } else if (!domain.rests()) {
      hub->publish(PageHub::Kind::Domain, nullptr);
      domain.rest();
    }
  } while (!interruption.wait(domain.rests() ? kUntilWatchedSeconds : kLookSeconds));
  hub->close();
  return 0;
}

}  // namespace skein::command::designer
