#include "skein/component_registry.hpp"

#include <catch2/catch.hpp>
#include <future>

#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/loopback.hpp"
#include "skein/process.hpp"
#include "skein/selection.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

class First final : public SelectionStrategy {
 public:
  explicit First(std::string name) : name_(std::move(name)) {}
  std::string name() const override { return name_; }
  Selection select(const std::vector<Candidate>&, const Situation& situation) const override {
    return {0, situation.remaining, "it is the first"};
  }

 private:
  const std::string name_;
};

}  // namespace

TEST_CASE("strategies that are registered stand in the order in which they came") {
  ComponentRegistry registry;
  CHECK(registry.strategies().empty());
  registry.add_strategy(std::make_shared<First>("steady"));
  registry.add_strategy(std::make_shared<First>("bold"));
  REQUIRE(registry.strategies().size() == 2);
  CHECK(registry.strategies()[0]->name() == "steady");
  CHECK(registry.strategies()[1]->name() == "bold");
  CHECK(registry.names().empty());
}

TEST_CASE("a second strategy of one name is refused, and so is one with a name of Skein's own") {
  ComponentRegistry registry;
  registry.add_strategy(std::make_shared<First>("steady"));
  CHECK_THROWS_AS(registry.add_strategy(std::make_shared<First>("steady")), InvalidArgument);
  CHECK_THROWS_WITH(registry.add_strategy(std::make_shared<First>("steady")),
                    Catch::Contains("'steady'") && Catch::Contains("load only one"));
  CHECK_THROWS_WITH(registry.add_strategy(std::make_shared<First>("learned")),
                    Catch::Contains("'learned' is one of Skein's own"));
  CHECK(registry.strategies().size() == 1);
}

TEST_CASE("the name of an activity is a component's, too") {
  ComponentRegistry registry;
  const auto idle = [](Entity&, const ParameterValues&, const std::stop_token&) { return 0; };
  registry.add_activity("Beacon", idle);
  CHECK(registry.find_activity("Beacon") != nullptr);
  CHECK(registry.find_mission("Beacon") == nullptr);
  CHECK(registry.names() == std::vector<std::string>{"Beacon"});
  CHECK_THROWS_AS(registry.add_mission("Beacon", [](Entity&, const ParameterValues&) { return 0; }),
                  InvalidArgument);
}

TEST_CASE("an activity is made before it runs, or is one function that does both") {
  const auto clock = std::make_shared<ManualClock>();
  dds::LoopbackNetwork network(*clock);
  Entity entity(
      {.name = "a", .vendor = network.vendor(), .process = std::make_shared<Process>(clock)});
  ComponentRegistry registry;
  std::string told;
  registry.add_activity("two steps", [&](Entity&, const ParameterValues&) {
    told += "made ";
    return [&](const std::stop_token&) { return told += "run ", 1; };
  });
  registry.add_activity("one step", [&](Entity&, const ParameterValues&, const std::stop_token&) {
    return told += "both ", 2;
  });
  const auto first = (*registry.find_activity("two steps"))(entity, {});
  const auto second = (*registry.find_activity("one step"))(entity, {});
  CHECK(told == "made ");
  CHECK(first({}) == 1);
  CHECK(second({}) == 2);
  CHECK(told == "made run both ");
}

TEST_CASE("all checks of a parameter must take its value, if it is of their type") {
  ComponentRegistry registry;
  registry.add_check<std::int64_t>("Rate", [](std::int64_t rate) {
    if (rate % 2 != 0) throw InvalidArgument("it is odd");
  });
  registry.add_check<std::int64_t>("Rate", [](std::int64_t rate) {
    if (rate > 10) throw InvalidArgument("it is high");
  });
  CHECK_NOTHROW(registry.check_value("Rate", std::int64_t{10}));
  CHECK_THROWS_WITH(registry.check_value("Rate", std::int64_t{9}), "it is odd");
  CHECK_THROWS_WITH(registry.check_value("Rate", std::int64_t{12}), "it is high");
  CHECK_NOTHROW(registry.check_value("Rate", std::string("11")));
  CHECK_NOTHROW(registry.check_value("Height", std::int64_t{11}));
}

TEST_CASE("an activity waits by the clock of its entity, until it is told to end") {
  const auto clock = std::make_shared<ManualClock>();
  dds::LoopbackNetwork network(*clock);
  Entity entity(
      {.name = "a", .vendor = network.vendor(), .process = std::make_shared<Process>(clock)});
  std::stop_source told;
  CHECK_FALSE(await_end(entity, told.get_token(), Duration::zero()));
  auto patient = std::async([&] { return await_end(entity, told.get_token(), 1h); });
  REQUIRE(test::eventually([&] {
    clock->advance(30min);
    return patient.wait_for(0s) == std::future_status::ready;
  }));
  CHECK_FALSE(patient.get());
  auto endless = std::async([&] { return await_end(entity, told.get_token()); });
  clock->advance(24h);
  told.request_stop();
  CHECK(endless.get());
  CHECK(await_end(entity, told.get_token(), 1h));
}
