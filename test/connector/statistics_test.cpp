#include <catch2/catch.hpp>

#include "brokerless_discovery/broker.hpp"
#include "echo_pair.hpp"
#include "entity/entity_access.hpp"
#include "entity/statistics_topic.hpp"
#include "pairing.hpp"
#include "skein/detail/codec.hpp"
#include "skein/introspection.idl.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using introspection::OperationStatistics;
using introspection::ServiceStatistics;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

OperationStatistics of(const std::vector<ServiceStatistics>& services,
                       const std::string& operation) {
  for (const auto& service : services) {
    for (const auto& statistics : service.operations) {
      if (statistics.name == operation) return statistics;
    }
  }
  return {};
}

/// Tells statistics as that entity, of whichever service.
class Teller {
 public:
  explicit Teller(Entity& entity)
      : writer_(EntityAccess::participant(entity).create_writer(
            {"skein/statistics", "skein::introspection::ServiceStatistics", true}, qos())) {}

  void tell(const Guid& provider, const std::string& service) {
    ServiceStatistics statistics;
    statistics.provider = provider.bytes;
    statistics.service = service;
    writer_->write(idl::encode_message(statistics), key_hash(statistics));
  }
  void babble(const Guid& provider) {
    ServiceStatistics statistics;
    statistics.provider = provider.bytes;
    Bytes message = idl::encode_message(statistics);
    message.resize(message.size() / 2);
    writer_->write(message, key_hash(statistics));
  }

 private:
  static dds::Qos qos() {
    dds::Qos qos;
    qos.reliable = false;
    return qos;
  }
  std::unique_ptr<dds::Writer> writer_;
};

}  // namespace

TEST_CASE("each call is counted by its outcome, with the time that it waited and ran") {
  EchoPair pair(make_server(), make_client(), {.queue = 4});
  auto& [service, server, client, id, connected] = pair;
  auto echo = *connected;
  for (int i = 0; i < 5; ++i) echo.echo("x");
  std::int32_t remainder;
  CHECK_THROWS_AS(echo.divide(1, 0, remainder), ::test::DivisionByZero);
  CHECK(echo.divide(4, 2, remainder) == 2);
  CHECK_THROWS_AS(echo.fail("overloaded"), Overloaded);
  auto statistics = server->statistics();
  REQUIRE(statistics.size() == 1);
  CHECK(statistics[0].service == "test/LouderEcho");
  CHECK(statistics[0].entity == "server");
  CHECK(statistics[0].system == "uav-1");
  CHECK(of(statistics, "echo").received == 5);
  CHECK(of(statistics, "echo").answered == 5);
  CHECK(of(statistics, "echo").ran.count == 5);
  CHECK(of(statistics, "echo").waited.count == 5);
  CHECK(of(statistics, "echo").ran.p50 <= of(statistics, "echo").ran.greatest);
  CHECK(of(statistics, "divide").raised == 1);
  CHECK(of(statistics, "divide").answered == 1);
  CHECK(of(statistics, "fail").failed == 1);

  auto running = echo.within(60s).async_wait(60'000);
  REQUIRE(eventually([&] { return service->inside == 1; }));
  CHECK_THROWS_AS(echo.within(20ms).echo("too late"), TimedOut);
  std::vector<Call<std::string>> calls;
  for (int i = 0; i < 3; ++i) calls.push_back(echo.within(30s).async_echo("x"));
  REQUIRE(eventually([&] { return of(server->statistics(), "echo").refused == 2; }));
  CHECK(server->statistics()[0].running == 1);
  CHECK(server->statistics()[0].waiting == 2);
  running.cancel();
  CHECK(calls[0].get() == "x");
  CHECK(of(server->statistics(), "echo").received == 9);
  CHECK(of(server->statistics(), "echo").expired == 1);
  CHECK(of(server->statistics(), "wait").ran.greatest > 0);
}

TEST_CASE("a call on the caller's own thread is counted, and did not wait") {
  const auto process = std::make_shared<Process>();
  EchoPair pair(make_entity("server", Pairing::get().server, "uav-1", process),
                make_entity("client", Pairing::get().client, "uav-1", process),
                {.thread = CallThread::Caller});
  pair.echo->echo("x");
  CHECK(of(pair.server->statistics(), "echo").answered == 1);
  CHECK(of(pair.server->statistics(), "echo").waited.count == 0);
}

TEST_CASE(
    "statistics of all entities reach whoever reads their topic, and tell of later calls too") {
  EchoPair pair(make_server(), make_client());
  pair.echo->echo("x");
  const introspection::StatisticsReader reader(EntityAccess::participant(*pair.client));
  CHECK(eventually([&] { return of(reader.latest(), "echo").answered == 1; }));
  pair.echo->echo("x");
  CHECK(eventually([&] { return of(reader.latest(), "echo").answered == 2; }));
  CHECK(reader.latest().at(0).entity == "server");
}

TEST_CASE("a reader takes from each peer the statistics of that peer's own services alone",
          "[wire]") {
  const auto onlooker = make_client();
  const introspection::StatisticsReader reader(EntityAccess::participant(*onlooker));
  const auto peer = make_server("peer");
  const auto rogue = make_server("rogue");
  const Guid service = peer->broker().new_provider();
  const Guid other = rogue->broker().new_provider();
  const auto told = [&] {
    std::vector<std::string> services;
    for (const auto& statistics : reader.latest()) services.push_back(statistics.service);
    return services;
  };
  using Services = std::vector<std::string>;
  // Best effort: the first ones may come before the reader is known.
  auto speaker = std::make_optional<Teller>(*peer);
  REQUIRE(eventually([&] {
    speaker->tell(service, "true");
    return told() == Services{"true"};
  }));
  CHECK(reader.refused() == 0);

  Teller forger(*rogue);
  CHECK(eventually([&] {
    forger.tell(service, "forged");
    return reader.refused() > 0;
  }));
  CHECK(told() == Services{"true"});
  const auto before = reader.refused();
  CHECK(eventually([&] {
    forger.babble(other);
    return reader.refused() > before + 2;
  }));
  CHECK(told() == Services{"true"});
  CHECK(eventually([&] {
    forger.tell(other, "its own");
    return told() == Services{"its own", "true"};
  }));

  speaker.reset();
  CHECK(eventually([&] { return told() == Services{"its own"}; }));
}
