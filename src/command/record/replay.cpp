#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "command/commands.hpp"
#include "command/mission/missions_elsewhere.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "core/printable.hpp"
#include "recording/player.hpp"
#include "skein/entity.hpp"

namespace skein::command {
namespace {

/// Until those who listen have found the replay.
constexpr double kDiscovery = 1.5;

void print_replayed(const recording::Player& player, std::uint64_t published, std::uint32_t domain,
                    bool json) {
  if (json) {
    print_json({{"topics", player.topics()},
                {"published", published},
                {"domain", domain},
                {"subscribers", player.subscribers()}},
               false);
  } else {
    std::printf("%llu values published on domain %u, to %zu subscriber%s\n",
                static_cast<unsigned long long>(published), domain, player.subscribers(),
                player.subscribers() == 1 ? "" : "s");
  }
}

}  // namespace

int replay_recording(const ReplayArguments& arguments) {
  if (arguments.decisions) {
    DecisionsArguments decisions;
    decisions.log = arguments.file;
    decisions.replays = true;
    decisions.json = arguments.json;
    decisions.plugins = arguments.plugins;
    return show_decisions(decisions);
  }
  const Interruption interruption;
  const recording::Reader reader(arguments.file);
  Entity entity = join(arguments, "replay");
  recording::Player player(entity, reader, {arguments.topics, arguments.rate});
  const std::uint32_t domain = arguments.watched_domain();
  for (const std::string& topic : player.topics()) {
    std::fprintf(stderr, "skein: publishes %s\n", printable(topic).c_str());
  }
  if (mission_flies_on(domain)) {
    std::fprintf(stderr,
                 "skein: a mission flies on domain %u: its peers hear what is replayed beside what "
                 "they publish\n",
                 domain);
  }
  if (interruption.wait(kDiscovery)) {
    throw Interrupted("interrupted before it published", interruption.signal());
  }
  const std::uint64_t published = player.play([&](Duration time) {
    return interruption.came() || (time > Duration::zero() &&
                                   interruption.wait(std::chrono::duration<double>(time).count()));
  });
  print_replayed(player, published, domain, arguments.json);
  if (player.subscribers() == 0) tell_missions_elsewhere(arguments);
  if (interruption.signal() != 0) {
    throw Interrupted("interrupted before all was published", interruption.signal());
  }
  return 0;
}

}  // namespace skein::command
