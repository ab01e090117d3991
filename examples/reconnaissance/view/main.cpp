// Shows the mission while it flies: in a terminal a whole screen, in a pipe a line for each phase.
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "entities/convert.hpp"
#include "entities/in_system.hpp"
#include "entities/mission_recorder.hpp"
#include "entities/stream.hpp"
#include "entities/topics.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "view/live_view.hpp"

using namespace std::chrono_literals;

namespace reconnaissance {
namespace {

volatile sig_atomic_t told_to_end = 0;

constexpr auto kFrame = 250ms;
// Without a sample of the aircraft the mission is over.
constexpr auto kSilence = 15s;

/// The whole screen of a terminal while this lives; what stood there is back afterwards.
class Screen {
 public:
  Screen() { std::fputs("\x1b[?1049h\x1b[?25l", stdout); }
  ~Screen() {
    std::fputs("\x1b[?25h\x1b[?1049l", stdout);
    std::fflush(stdout);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  void show(const std::vector<std::string>& lines) const {
    std::string text = "\x1b[H";
    for (std::size_t i = 0; i < lines.size(); ++i)
      text += lines[i] + "\x1b[K" + (i + 1 < lines.size() ? "\r\n" : "");
    std::fputs((text + "\x1b[J").c_str(), stdout);
    std::fflush(stdout);
  }
};

class Members {
 public:
  explicit Members(skein::Entity& entity)
      : healths_(entity.subscription<recon::Health>(topic::kHealth, skein::TopicQos::state(),
                                                    [this](const recon::Health& health) {
                                                      std::lock_guard lock(mutex_);
                                                      known_[health.entity] = health;
                                                    })) {}

  std::vector<MemberState> states(double now_s) const {
    std::lock_guard lock(mutex_);
    std::vector<MemberState> states;
    for (const auto& [name, health] : known_) {
      std::string condition = to_string(health.condition);
      if (seconds_of(health.tick) < now_s - 3) condition = "SILENT";
      states.push_back({name, condition});
    }
    return states;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, recon::Health> known_;
  skein::Subscription<recon::Health> healths_;
};

struct Arguments {
  std::uint32_t domain = 43;
  std::string vendor = "fastdds";
  std::string system = "uav-1";
};

std::optional<Arguments> parse(int count, char** values) {
  Arguments arguments;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = values[i], value = values[i + 1];
    if (name == "--domain") {
      char* end = nullptr;
      arguments.domain = static_cast<std::uint32_t>(std::strtoul(value.c_str(), &end, 10));
      if (value.empty() || *end != '\0') return std::nullopt;
    } else if (name == "--vendor") {
      arguments.vendor = value;
    } else if (name == "--system") {
      arguments.system = value;
    } else {
      return std::nullopt;
    }
  }
  return count % 2 == 1 ? std::optional(arguments) : std::nullopt;
}

std::pair<std::size_t, std::size_t> columns_and_lines() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return {80, 24};
  return {size.ws_col, size.ws_row};
}

/// Where the aircraft is first seen, or nothing if it is to end.
std::optional<LocalFrame> await_mission(skein::Entity& entity) {
  Stream<recon::Truth> truths(entity, topic::kTruth);
  while (!told_to_end) {
    if (const auto truth = truths.latest()) return LocalFrame(geodetic(truth->position));
    std::this_thread::sleep_for(kFrame);
  }
  return std::nullopt;
}

void show(skein::Entity& entity) {
  const bool terminal = isatty(STDOUT_FILENO);
  std::puts("Waits for the mission, until Ctrl-C.");
  std::fflush(stdout);
  const auto frame = await_mission(entity);
  if (!frame) return;
  const Recorder recorder(InSystem(entity), *frame);
  const Members members(entity);
  std::optional<Screen> screen;
  if (terminal) screen.emplace();
  std::size_t phases = 0;
  double last_s = -1;
  auto moved = std::chrono::steady_clock::now();
  while (!told_to_end) {
    const MissionRecord record = recorder.record();
    const double now_s = record.track.empty() ? 0 : record.track.back().time_s;
    if (now_s != last_s) moved = std::chrono::steady_clock::now();
    last_s = now_s;
    if (std::chrono::steady_clock::now() - moved > kSilence) return;
    if (screen) {
      const auto [columns, lines] = columns_and_lines();
      screen->show(live_view(record, members.states(now_s), columns, lines));
    }
    for (; !screen && phases < record.phases.size(); ++phases) {
      const Stage& phase = record.phases[phases];
      std::printf("%s  %s: %s\n", clock_text(phase.from_s).c_str(), phase.name.c_str(),
                  phase.reason.c_str());
      std::fflush(stdout);
    }
    std::this_thread::sleep_for(kFrame);
  }
}

}  // namespace
}  // namespace reconnaissance

int main(int count, char** values) {
  const auto arguments = reconnaissance::parse(count, values);
  if (!arguments) {
    std::fputs(
        "Shows the reconnaissance mission while it flies.\n"
        "reconnaissance_view [--domain 43] [--vendor fastdds] [--system uav-1]\n",
        stderr);
    return 64;
  }
  const auto end = [](int) { reconnaissance::told_to_end = 1; };
  signal(SIGINT, end);
  signal(SIGTERM, end);
  try {
    skein::Entity entity({.name = "live_view",
                          .system = arguments->system,
                          .vendor = skein::dds::load_vendor(arguments->vendor),
                          .domain = arguments->domain});
    reconnaissance::show(entity);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "reconnaissance_view: %s\n", error.what());
    return 1;
  }
}
