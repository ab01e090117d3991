#include <catch2/catch.hpp>

#include "direct_channel.hpp"
#include "planner.idl.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"
#include "skein/stream.hpp"

using namespace test_planner;

namespace {

class Planner final : public IPlanner {
 public:
  std::string name() override { return "north"; }
  std::string echo(const std::string& text) override { return text; }
  double margin_m() override { return margin_; }
  void margin_m(double value) override { margin_ = value; }
  Route plan(const Problem& problem) override {
    if (problem.speed == Speed::Slow) throw NoRoute("fog", 7);
    if (problem.speed == Speed::Fast) throw Busy();
    seen = problem.terrain.data();
    return {{problem.start, problem.goal}, 12.5, "fine"};
  }
  Statistics statistics(Speed, std::string& text, test_geometry::Path& path) override {
    text = "out";
    path.push_back({1, 2, 3});
    return {4, 0.5};
  }
  void reset() override { margin_ = 0; }
  void note(const std::string& text) override { noted = text; }
  void observe(const skein::Reference<IObserver>& observer,
               skein::Reference<IPlanner>& self) override {
    self = skein::Reference<IPlanner>(observer);
  }
  Blob blob(const Blob& content) override { return content; }

  const std::uint8_t* seen = nullptr;
  std::string noted;

 private:
  double margin_ = IPlanner::kDefaultMargin;
};

/// Has one route, and implements no stream.
class Improver : public IImprover {
 public:
  Route plan(const Problem& problem) override {
    if (problem.speed == Speed::Slow) throw NoRoute("fog", 7);
    return {{problem.start, problem.goal}, 12.5, "the only one"};
  }
};

/// Has another one before it.
class BusyImprover final : public Improver {
 public:
  void improve(const Problem& problem, skein::StreamSink<Route>& sink) override {
    sink.push({{problem.start}, 20, "a draft"});
    sink.push(plan(problem));
  }
};

/// The remarks of the routes that a stream brings through the skeleton.
class Remarks final : public skein::StreamWriter {
 public:
  explicit Remarks(std::shared_ptr<IImprover> improver) : skeleton_(std::move(improver)) {}

  std::vector<std::string> of(const Problem& problem) {
    remarks_.clear();
    for (const auto& operation : IImprover::interface_info().operations) {
      const IImprover_improve_In in{problem};
      if (operation.stream) skeleton_.dispatch(operation, &in, static_cast<StreamWriter*>(this));
    }
    return remarks_;
  }

 private:
  bool put(const void* out, bool) override {
    remarks_.push_back(static_cast<const IImprover_improve_Out*>(out)->return_.remark);
    return true;
  }

  IImprover::Skeleton skeleton_;
  std::vector<std::string> remarks_;
};

struct Fixture {
  std::shared_ptr<Planner> planner = std::make_shared<Planner>();
  std::shared_ptr<DirectChannel> channel =
      std::make_shared<DirectChannel>(std::make_shared<IPlanner::Skeleton>(planner));
  IPlanner::Proxy proxy{channel};
  Problem problem{{0, 0, 0}, {1, 1, 1}, Speed::Normal, {1, 2, 3}};
};

}  // namespace

TEST_CASE_METHOD(Fixture,
                 "a call through proxy and skeleton returns what the implementation returns") {
  const Route route = proxy.plan(problem);
  CHECK(route.points == test_geometry::Path{problem.start, problem.goal});
  CHECK(route.length_m == 12.5);
  CHECK(proxy.async_plan(problem).get() == route);
}

TEST_CASE_METHOD(Fixture,
                 "an argument reaches an implementation in the same process without a copy") {
  proxy.plan(problem);
  CHECK(planner->seen == problem.terrain.data());
}

TEST_CASE_METHOD(Fixture, "exceptions declared in IDL arrive as their C++ types") {
  problem.speed = Speed::Slow;
  try {
    proxy.plan(problem);
    FAIL("nothing was thrown");
  } catch (const NoRoute& error) {
    CHECK(error == NoRoute("fog", 7));
    CHECK(std::string(error.what()) == "test_planner::NoRoute{reason=\"fog\", explored=7}");
  }
  problem.speed = Speed::Fast;
  CHECK_THROWS_AS(proxy.plan(problem), Busy);
  CHECK_THROWS_AS(proxy.async_plan(problem).get(), Busy);
}

TEST_CASE_METHOD(Fixture, "an exception can be raised again from what its info knows") {
  const NoRoute original("ice", 2);
  const skein::UserException& base = original;
  CHECK(base.info().name == "test_planner::NoRoute");
  CHECK_THROWS_AS(base.info().raise(base.value()), NoRoute);
}

TEST_CASE_METHOD(
    Fixture,
    "out and inout parameters come back, in the out struct where the call is asynchronous") {
  std::string text;
  test_geometry::Path path{{0, 0, 0}};
  CHECK(proxy.statistics(Speed::Fast, text, path) == IPlanner::Statistics{4, 0.5});
  CHECK(text == "out");
  CHECK(path == test_geometry::Path{{0, 0, 0}, {1, 2, 3}});

  const IPlanner_statistics_Out out = proxy.async_statistics(Speed::Fast, {}).get();
  CHECK(out.return_.calls == 4);
  CHECK(out.text == "out");
  CHECK(out.path == test_geometry::Path{{1, 2, 3}});
}

TEST_CASE_METHOD(Fixture, "attributes are read and written by calls") {
  CHECK(proxy.margin_m() == 2.5);
  proxy.margin_m(4);
  CHECK(proxy.margin_m() == 4);
  proxy.reset();
  CHECK(proxy.async_margin_m().get() == 0);
  CHECK(proxy.name() == "north");
}

TEST_CASE_METHOD(Fixture, "an interface inherits the operations of its base") {
  INamed& named = proxy;
  CHECK(named.echo("hello") == "hello");
  CHECK(IPlanner::interface_info().bases.size() == 1);
  CHECK(IPlanner::interface_info().bases[0] == &INamed::interface_info());
}

TEST_CASE_METHOD(Fixture, "a oneway call and a void call return nothing") {
  proxy.note("remember");
  CHECK(planner->noted == "remember");
  proxy.async_note("again").get();
  CHECK(planner->noted == "again");
}

TEST_CASE_METHOD(Fixture, "a parameter of an interface's type is a service reference") {
  const skein::Reference<IObserver> observer(
      {"test_planner/IObserver", skein::Guid::random(), "one"});
  skein::Reference<IPlanner> self;
  proxy.observe(observer, self);
  CHECK(self.provider == observer.provider);
}

TEST_CASE_METHOD(Fixture,
                 "a stream that names an operation brings its result, unless it is implemented") {
  Remarks by_default(std::make_shared<Improver>());
  CHECK(by_default.of(problem) == std::vector<std::string>{"the only one"});
  Remarks implemented(std::make_shared<BusyImprover>());
  CHECK(implemented.of(problem) == std::vector<std::string>{"a draft", "the only one"});
  problem.speed = Speed::Slow;
  CHECK_THROWS_AS(by_default.of(problem), NoRoute);
}

TEST_CASE_METHOD(Fixture, "within() makes a proxy of the same channel") {
  auto patient = proxy.within(std::chrono::minutes(1));
  CHECK(patient.channel() == proxy.channel());
  CHECK(patient.name() == "north");
}

TEST_CASE("the metadata of an operation says how it is called and documents it") {
  const skein::InterfaceInfo& info = IPlanner::interface_info();
  CHECK(info.name == "test_planner/IPlanner");
  CHECK(info.documentation == "Plans routes.");
  const auto find = [&](std::string_view name) {
    for (const auto& operation : info.operations) {
      if (operation.name == name) return &operation;
    }
    throw std::runtime_error("no such operation");
  };
  CHECK(find("plan")->documentation == "Plans a route from start to goal.\nTakes 5 µs → or more.");
  CHECK(find("plan")->raises.size() == 2);
  CHECK(find("plan")->idempotent);
  CHECK(find("echo")->idempotent);
  CHECK_FALSE(find("reset")->idempotent);
  CHECK(find("note")->oneway);
  CHECK_FALSE(find("plan")->oneway);
  CHECK(find("_get_margin_m")->hash != find("_set_margin_m")->hash);
  CHECK(info.find_operation(find("reset")->hash) == find("reset"));
  CHECK(info.find_operation(1) == nullptr);
}

TEST_CASE("the hash of an operation is the first four bytes of its name's MD5, little-endian") {
  // echo -n reset | md5sum: 86266ee9...
  for (const auto& operation : IPlanner::interface_info().operations) {
    if (operation.name == "reset") CHECK(operation.hash == 0xe96e2686U);
  }
}

TEST_CASE_METHOD(Fixture,
                 "a skeleton refuses an operation that it does not know and suggests a near one") {
  IPlanner::Skeleton skeleton(planner);
  skein::OperationInfo unknown = IPlanner::interface_info().operations[0];
  unknown.name = "plam";
  unknown.hash = 1;
  try {
    skeleton.dispatch(unknown, nullptr, nullptr);
    FAIL("nothing was thrown");
  } catch (const skein::Unimplemented& error) {
    CHECK(std::string(error.what()) ==
          "test_planner/IPlanner has no operation 'plam' (did you mean 'plan'?)");
  }
}
