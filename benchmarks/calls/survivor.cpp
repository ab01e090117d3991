#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "calls/plain_echo.hpp"
#include "calls/skein_peer.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

using benchmark::Echo;
using namespace std::chrono_literals;

/// A call that nobody answers ends after so long; one that is sent when all is well again has its
/// answer long before.
constexpr auto kDeadline = 100ms;
constexpr auto kPatience = 25s;
constexpr auto kStable = 300ms;

/// When `holds` last began to be true; it has stayed so for `stable`.
template <class Condition>
std::string time_since(const char* title, Duration stable, Condition&& holds) {
  std::string began;
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (Instant since;;) {
    const Instant now = std::chrono::steady_clock::now();
    if (!holds()) {
      began.clear();
    } else if (began.empty()) {
      began = now_text();
      since = now;
    }
    if (!began.empty() && now - since >= stable) return title + (' ' + began);
    if (now > end) throw Internal(std::string(title) + ": not within 25 s of the fault's end");
    std::this_thread::sleep_for(1ms);
  }
}

// Who wakes still believes its table, then doubts it, then knows.
std::string complete(const brokerless_discovery::Broker& broker) {
  return time_since("complete", kStable, [&] {
    return broker.find_service(broker.query("benchmark::Echo")).size() == 2;
  });
}

std::string answered(Echo::Proxy proxy) {
  return time_since("answered", Duration::zero(), [&] {
    try {
      proxy.echo({});
      return true;
    } catch (const Error&) {
      return false;
    }
  });
}

std::string overdue(Echo::Proxy proxy, std::size_t count) {
  std::string times = "times";
  for (std::size_t i = 0; i < count; ++i) {
    const Instant deadline = std::chrono::steady_clock::now() + kDeadline;
    try {
      proxy.echo({});
      throw Internal("a call to a stopped provider was answered");
    } catch (const TimedOut&) {
      const auto late = std::chrono::steady_clock::now() - deadline;
      times += ' ' + std::to_string(std::chrono::nanoseconds(late).count());
    }
  }
  return times;
}

}  // namespace

void survive(const SkeinPeer& peer) {
  Entity entity(entity_options(peer));
  entity.provide<Echo>(std::make_shared<PlainEcho>());
  Commands commands{{"complete", [&](const std::string&) { return complete(entity.broker()); }}};
  if (peer.role == "server") return run_commands(commands);
  const auto proxy = entity.connect<Echo>({.name = "server", .timeout = 20s}).within(kDeadline);
  commands.emplace_back("answered", [&](const std::string&) { return answered(proxy); });
  commands.emplace_back(
      "overdue", [&](const std::string& count) { return overdue(proxy, std::stoul(count)); });
  run_commands(commands);
}

}  // namespace skein::benchmarks
