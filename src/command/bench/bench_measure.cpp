#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>

#include "bench.hpp"
#include "bench.idl.hpp"
#include "command/print/interruption.hpp"
#include "core/threads/thread_settings.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "statistics.hpp"

namespace skein::command::bench {
namespace {

using benchmarks::Summary;
using skein_bench_service::Mirror;
using Content = std::vector<std::uint8_t>;
using namespace std::chrono_literals;

constexpr Duration kCallTimeout = 20s;
constexpr std::size_t kDiscoveries = 20;

class MirrorBody final : public Mirror {
 public:
  Content reflect(const Content& content) override { return content; }
};

/// The transport that the entity's one connection has. Throws Unavailable where another one was
/// asked for.
std::string transport_of(Entity& entity, const BenchArguments& arguments) {
  const ConnectionInfo connection = entity.connector().connections().at(0);
  if (arguments.transport == "shared-memory" && connection.transport == "DDS")
    throw Unavailable("calls do not go through shared memory: " + connection.not_faster);
  return connection.transport;
}

Mirror::Proxy connected(Entity& entity) {
  return entity.connect<Mirror>({.timeout = kCallTimeout}).within(kCallTimeout);
}

double microseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
      .count();
}

Rows row(const char* what, const BenchArguments& arguments, const std::string& transport,
         const std::vector<double>& times_us) {
  const Summary summary = benchmarks::summarize(times_us);
  return {{"what", what},           {"vendor", vendors_of(arguments)},
          {"transport", transport}, {"samples", summary.samples},
          {"p50_us", summary.p50},  {"p90_us", summary.p90},
          {"p99_us", summary.p99}};
}

// Payloads of which `count` would take minutes are sent less often.
std::size_t count_for(const BenchArguments& arguments, std::size_t payload) {
  constexpr std::size_t kManyOctets = 64 << 20;
  return std::max<std::size_t>(
      20, std::min(arguments.count, kManyOctets / std::max<std::size_t>(payload, 1)));
}

using Measure =
    std::function<std::vector<double>(Mirror::Proxy&, const Content&, std::size_t count)>;

Rows measure_each_payload(const BenchArguments& arguments, const char* what,
                          const Measure& measure) {
  const Side side = side_of(arguments, Role::Caller);
  if (side.lock_memory) lock_memory();
  Entity entity(side.entity);
  auto proxy = connected(entity);
  const std::string transport = transport_of(entity, arguments);
  Rows rows = Rows::array();
  for (const std::size_t payload : arguments.payloads) {
    const Content content(payload, 7);
    const std::size_t count = count_for(arguments, payload);
    measure(proxy, content, count / 10 + 1);  // wakes everything up
    Rows one = row(what, arguments, transport, measure(proxy, content, count));
    one["payload_bytes"] = payload;
    rows.push_back(std::move(one));
  }
  return rows;
}

}  // namespace

void serve(const BenchArguments& arguments) {
  const Interruption interruption;
  const Side side = side_of(arguments, Role::Provider);
  if (side.lock_memory) lock_memory();
  Entity entity(side.entity);
  entity.provide<Mirror>(std::make_shared<MirrorBody>(), side.service);
  interruption.wait(0);
}

Rows measure_latency(const BenchArguments& arguments) {
  return measure_each_payload(arguments, "latency",
                              [](Mirror::Proxy& proxy, const Content& content, std::size_t count) {
                                std::vector<double> times(count);
                                for (double& time : times) {
                                  const auto begin = std::chrono::steady_clock::now();
                                  proxy.reflect(content);
                                  time = microseconds_since(begin);
                                }
                                return times;
                              });
}

Rows measure_throughput(const BenchArguments& arguments) {
  const std::size_t depth = arguments.in_flight;
  return measure_each_payload(
      arguments, "throughput",
      [depth](Mirror::Proxy& proxy, const Content& content, std::size_t count) {
        std::vector<double> times;
        std::deque<Call<Content>> waiting;
        for (std::size_t sent = 0; sent < count; sent += depth) {
          const auto begin = std::chrono::steady_clock::now();
          for (std::size_t i = 0; i < depth; ++i) {
            if (waiting.size() == depth) {
              waiting.front().get();
              waiting.pop_front();
            }
            waiting.push_back(proxy.async_reflect(content));
          }
          times.push_back(microseconds_since(begin) / static_cast<double>(depth));
        }
        for (auto& call : waiting) call.get();
        if (times.size() > 1) times.erase(times.begin());  // nothing was waited for yet
        return times;
      });
}

Rows measure_discovery(const BenchArguments& arguments) {
  const Side side = side_of(arguments, Role::Caller);
  std::vector<double> times(kDiscoveries);
  std::string transport;
  for (double& time : times) {
    const auto begin = std::chrono::steady_clock::now();
    Entity entity(side.entity);
    auto proxy = connected(entity);
    proxy.reflect({});
    time = microseconds_since(begin);
    transport = transport_of(entity, arguments);
  }
  return Rows::array({row("discovery", arguments, transport, times)});
}

}  // namespace skein::command::bench
