#include <spawn.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "command/commands.hpp"
#include "command/print/interruption.hpp"
#include "layout.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "page_hub.hpp"
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

constexpr double kPeriodSeconds = 1;
constexpr double kUntilWatchedSeconds = 0.2;

std::optional<Plan> plan_in(const DesignerArguments& arguments) {
  if (arguments.profile.empty()) return std::nullopt;
  return plan_of(profile::read_mission_profile(arguments.profile,
                                               profile::parse_variables(arguments.variables)));
}

/// What the looking thread and that of requests share.
class SharedLayout {
 public:
  void arrange(DomainState& state) {
    std::lock_guard lock(mutex_);
    layout_.arrange(state.entities, state.links);
    if (!layout_.failure().empty()) state.troubles.push_back(layout_.failure());
  }
  void move(const std::string& entity, Place to) {
    std::lock_guard lock(mutex_);
    layout_.move(entity, to);
  }
  void forget() {
    std::lock_guard lock(mutex_);
    layout_.forget();
  }

 private:
  std::mutex mutex_;
  Layout layout_;
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

/// Where there is a desktop. Nobody waits for it.
void open_browser(const std::string& url) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
  std::string program = "xdg-open", argument = url;
  std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
  pid_t process = 0;
  ::posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ);
}

}  // namespace

int serve_designer(const DesignerArguments& arguments) {
  const Interruption interruption;
  const std::optional<Plan> plan = plan_in(arguments);
  const std::uint32_t domain = arguments.watched_domain();
  Entity entity = join(arguments, "designer");
  SharedLayout layout;
  const Powers powers{[](int launcher, const std::string& request) {
                        return launch::ask_launcher(launcher, request);
                      },
                      [&](const std::string& name, Place to) { layout.move(name, to); },
                      [&] { layout.forget(); }, arguments.faults};
  const auto hub =
      std::make_shared<PageHub>([&](std::string_view request) { return obey(request, powers); });
  Site site(arguments.token.empty() ? view::random_token() : arguments.token,
            [&] { return hub->look(); });
  const view::WebSocketListener listener(
      socket_options(arguments), [&](const view::Visit& visit) { return site.reply(visit); },
      [&](view::Connection& connection) { return hub->open(connection); });
  site.listens_at(listener.port());
  std::printf(
      "Open this in a browser. Whoever knows it may look, and restart and stop missions.\n%s\n",
      site.url().c_str());
  std::fflush(stdout);
  if (!arguments.no_browser) open_browser(site.url());
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
    layout.arrange(state);
    hub->publish(std::make_shared<const std::string>(idl::to_json(state)));
  } while (!interruption.wait(watch ? kPeriodSeconds : kUntilWatchedSeconds));
  hub->close();
  return 0;
}

}  // namespace skein::command
