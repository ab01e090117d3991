#include <map>
#include <sstream>
#include <thread>

#include "calls/alone.hpp"
#include "calls/plain_echo.hpp"
#include "calls/skein_peer.hpp"
#include "rpc/client/local_channel.hpp"
#include "skein/head.hpp"

namespace skein::benchmarks {
namespace {

using benchmark::Echo;
using benchmark::Stopwatch;
using benchmark::Times;
using namespace std::chrono_literals;

constexpr std::size_t kContent = 16;

template <class Run>
Times timed_runs(std::uint32_t count, Run run) {
  Times times;
  times.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    run();
    times.push_back(std::chrono::nanoseconds(std::chrono::steady_clock::now() - begin).count());
  }
  return times;
}

/// The same implementation without a Head, on the caller's thread, too.
class DirectEcho {
 public:
  Echo::Proxy proxy() const {
    return Echo::Proxy(rpc::LocalChannel::open(service_, clock_, executor_, {}, nullptr), 10s);
  }

 private:
  static rpc::Service::Options options() {
    rpc::Service::Options options;
    options.thread = CallThread::Caller;
    return options;
  }

  const std::shared_ptr<SystemClock> clock_ = std::make_shared<SystemClock>();
  const std::shared_ptr<ThreadExecutor> executor_ = std::make_shared<ThreadExecutor>("direct");
  const std::shared_ptr<rpc::Service> service_ = std::make_shared<rpc::Service>(
      std::make_shared<Echo::Skeleton>(std::make_shared<PlainEcho>()), *executor_, *clock_,
      options());
};

class StopwatchBody final : public Stopwatch {
 public:
  explicit StopwatchBody(Head& head) : head_(head) {}

  Times direct(std::uint32_t count) override {
    auto echo = direct_.proxy();
    const Content content(kContent, 1);
    return timed_runs(count, [&] { echo.echo(content); });
  }

  Times perform(std::uint32_t count) override {
    const Content content(kContent, 1);
    Task<Echo, Content> task;
    task.run = [&](Echo::Proxy& echo, Duration) { return echo.echo(content); };
    return timed_runs(count, [&] { head_.perform(task); });
  }

 private:
  Head& head_;
  const DirectEcho direct_;
};

class Crew {
 public:
  Crew() {
    alone_.entity->provide<Stopwatch>(std::make_shared<StopwatchBody>(alone_.entity->head()));
  }

  std::string bind(std::size_t count) {
    while (csps_ < count) {
      ServiceOptions options;
      options.attributes = {{"latency", "1"}, {"quality", "0.5"}};
      options.thread = CallThread::Caller;
      alone_.entity->provide_csp<Echo>("csp" + std::to_string(++csps_), alone_.entity->id(),
                                       std::make_shared<PlainEcho>(), options);
    }
    return "bound";
  }

  std::string direct(std::uint32_t count) { return text_of(session({}).async_direct(count).get()); }

  std::string perform(const std::string& strategy, std::uint32_t count) {
    return text_of(session(strategy).async_perform(count).get());
  }

 private:
  Stopwatch::Proxy& session(const std::string& strategy) {
    const auto found = sessions_.find(strategy);
    if (found != sessions_.end()) return found->second;
    auto proxy = alone_.entity->connect<Stopwatch>({.strategy = strategy}).within(60s);
    return sessions_.emplace(strategy, std::move(proxy)).first->second;
  }

  static std::string text_of(const Times& times) {
    std::string text = "times";
    for (const std::int64_t time : times) text += ' ' + std::to_string(time);
    return text;
  }

  Alone alone_;
  std::size_t csps_ = 0;
  std::map<std::string, Stopwatch::Proxy> sessions_;
};

}  // namespace

void perform_tasks() {
  Crew crew;
  run_commands({{"bind", [&](const std::string& count) { return crew.bind(std::stoul(count)); }},
                {"direct",
                 [&](const std::string& count) {
                   return crew.direct(static_cast<std::uint32_t>(std::stoul(count)));
                 }},
                {"perform", [&](const std::string& what) {
                   std::istringstream words(what);
                   std::string strategy;
                   std::uint32_t count = 0;
                   words >> strategy >> count;
                   return crew.perform(strategy, count);
                 }}});
}

}  // namespace skein::benchmarks
