#include <catch2/catch.hpp>
#include <future>

#include "call_port/dds_call_port.hpp"
#include "echo_service.hpp"
#include "entity/entity_access.hpp"
#include "pairing.hpp"
#include "rpc/client/remote_channel.hpp"
#include "rpc/server/remote_server.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

/// More than any queue takes.
constexpr std::size_t kMany = 6000;

/// Holds up an executor's only thread, and fills its queue, until it is told to let go.
class Blockade {
 public:
  explicit Blockade(Executor& executor) {
    std::promise<void> begun;
    executor.post([&begun, open = open_.get_future().share()] {
      begun.set_value();
      open.wait();
    });
    begun.get_future().wait();
    while (executor.post([] {})) {
    }
  }
  void lift() { open_.set_value(); }

 private:
  std::promise<void> open_;
};

}  // namespace

TEST_CASE("no continuation is lost, however many calls end while the executor is busy", "[wire]") {
  const auto server = make_server();
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  const auto client = make_client();
  auto echo = client->connect<Echo>().within(60s);
  Blockade blockade(echo.channel()->continuations());
  std::atomic<std::size_t> continued{0};
  for (std::size_t i = 0; i < kMany; ++i) {
    echo.async_echo("x").then([&](Call<std::string>) { ++continued; });
  }
  CHECK(continued == 0);
  blockade.lift();
  CHECK(eventually([&] { return continued == kMany; }, 60s));
}

TEST_CASE("each refusal reaches its caller, however full the server's control queue is", "[wire]") {
  const auto server = make_server();
  const auto client = make_client();
  ThreadExecutor control("control");
  ThreadExecutor executor("echo");
  const auto echo_service = std::make_shared<EchoService>();
  rpc::Service::Options options;
  options.queue = 2;
  const auto service = std::make_shared<rpc::Service>(
      std::make_shared<LouderEcho::Skeleton>(echo_service), executor, server->clock(), options);
  calls::DdsCallPort server_port(EntityAccess::participant(*server));
  const rpc::RemoteServer remote_server(server_port, control, server->clock(), service, {});
  calls::DdsCallPort client_port(EntityAccess::participant(*client));
  ThreadExecutor client_control("control");
  rpc::RemoteChannel::Options channel_options;
  channel_options.peer = "server";
  Echo::Proxy echo(rpc::RemoteChannel::open(
      client_port, client_control, std::make_shared<ThreadExecutor>("continue"),
      std::make_shared<SystemClock>(), {std::string(service->interface_info().name), service->id()},
      channel_options));

  auto running = echo.within(10min).async_wait(600'000);
  REQUIRE(eventually([&] { return echo_service->inside == 1; }));
  Blockade blockade(control);
  std::vector<Call<bool>> calls;
  for (int i = 0; i < 500; ++i) calls.push_back(echo.within(10min).async_wait(600'000));
  REQUIRE(eventually([&] { return remote_server.counters().refused >= 499; }));
  blockade.lift();
  const auto refused = [&] {
    return std::count_if(calls.begin(), calls.end(), [](const auto& call) { return call.ready(); });
  };
  CHECK(eventually([&] { return refused() >= 499; }));
  for (auto& call : calls) {
    if (call.ready()) CHECK_THROWS_AS(call.get(), Overloaded);
  }
}
