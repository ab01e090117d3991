#include <catch2/catch.hpp>
#include <limits>

#include "call_port/dds_call_port.hpp"
#include "office.hpp"
#include "rpc/server/remote_server.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "test/tools/describe.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

/// A CSP whose description says that it lives elsewhere; behind it is nothing until it is served.
class DistantWorker {
 public:
  /// `version` is added to the signature of its first operation: not 0, and no Head can call it.
  DistantWorker(const Office& office, const std::string& name, unsigned version = 0)
      : participant_(Pairing::get().client->create_participant(participant_options())),
        id_(participant_->guid().participant()) {
    id_.bytes[12] = 1;
    dds::Qos qos;
    qos.transient_local = true;
    qos.history_depth = 1;
    qos.liveliness_lease = 1000ms;
    qos.partitions = {"managed/" + office.owner->id()};
    writer_ = participant_->create_writer(
        {"skein/services", "skein::discovery::ServiceDescription", true}, qos);
    auto description = describe(crew::Worker::interface_info(), id_, name);
    description.system = "uav-1";
    description.owner = office.owner->id();
    description.host = "elsewhere";
    description.operations.at(0).signature += version;
    writer_->write(idl::encode_message(description), id_);
    if (version == 0) REQUIRE(eventually([&] { return office.is_available(name); }));
  }

  void serve(std::shared_ptr<crew::Worker> worker) {
    rpc::Service::Options options;
    options.id = id_;
    service_ = std::make_shared<rpc::Service>(
        std::make_shared<crew::Worker::Skeleton>(std::move(worker)), executor_, clock_, options);
    server_ = std::make_unique<rpc::RemoteServer>(
        port_, control_, clock_, service_, rpc::RemoteServer::Options{.foreign_clients = false});
  }

 private:
  static dds::ParticipantOptions participant_options() {
    dds::ParticipantOptions options;
    options.domain = 17;
    options.name = "distant";
    return options;
  }

  SystemClock clock_;
  ThreadExecutor control_{"control"};
  ThreadExecutor executor_{"distant"};
  std::unique_ptr<dds::Participant> participant_;
  calls::DdsCallPort port_{*participant_};
  Guid id_;
  std::shared_ptr<rpc::Service> service_;
  std::unique_ptr<rpc::RemoteServer> server_;
  std::unique_ptr<dds::Writer> writer_;
};

struct Slowest final : SelectionStrategy {
  std::string name() const override { return "slowest"; }
  Selection select(const std::vector<Candidate>& candidates,
                   const Situation& situation) const override {
    std::size_t slowest = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i) {
      if (candidates[i].latency > candidates[slowest].latency) slowest = i;
    }
    return {slowest, situation.remaining, "it is the slowest"};
  }
};

}  // namespace

TEST_CASE_METHOD(
    Office, "A CSP that holds another version of its interface is told once, with the difference") {
  const Log log;
  add("near", Place::Inside, answer_as("near"), declared("1", "1"));
  const DistantWorker stranger(*this, "stranger", 1);
  const auto ask = [&] { perform(Office::task(), 10s); };
  const std::string told =
      "CSP 'stranger' is never chosen for crew/Worker, since it holds another "
      "version of it: operation 'work' has another signature there (";
  REQUIRE(eventually([&] {
    ask();
    return log.count(told) > 0;
  }));
  ask();
  CHECK(log.count(told) == 1);
}

TEST_CASE_METHOD(Office, "the Head selects by declared quality among those that fit into the time",
                 "[wire]") {
  add("thorough", Place::Outside, answer_as("thorough"), declared("2000", "0.9"));
  add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  CHECK(perform(Office::task("a"), 10s) == "thorough did a");
  CHECK(perform(Office::task("b"), 1s) == "quick did b");
}

TEST_CASE_METHOD(Office,
                 "a decision's record holds candidates, choice, reason, outcome and times") {
  add("thorough", Place::Outside, answer_as("thorough"), declared("2000", "0.9"));
  add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  perform(Office::task(), 10s);
  CHECK(record.service == "crew/Worker");
  CHECK(record.strategy == "declared");
  CHECK(std::chrono::nanoseconds(record.available) == 10s);
  REQUIRE(record.candidates.size() == 2);
  for (const auto& candidate : record.candidates) {
    const bool quick = candidate.csp == "quick";
    CHECK(candidate.in_process == quick);
    CHECK(candidate.latency == std::vector<std::int64_t>{quick ? 10'000'000 : 2'000'000'000});
    CHECK(candidate.quality == (quick ? 0.5 : 0.9));
    CHECK(candidate.pid == static_cast<std::uint32_t>(getpid()));
  }
  REQUIRE(attempts() == std::vector<std::string>{"thorough accepted"});
  CHECK_THAT(record.attempts[0].reason, Catch::Contains("best declared quality"));
  CHECK(record.attempts[0].slice <= record.available - 10'000'000);
  CHECK(record.took >= record.attempts[0].took);
}

TEST_CASE_METHOD(
    Office, "a result whose quality is no number is rejected, told, and nothing of it is learned") {
  add("dazed", Place::Inside, answer_as("dazed"), declared("10", "0.9"));
  add("clear", Place::Inside, answer_as("clear"), declared("10", "0.5"));
  WorkTask task = Office::task("a");
  task.quality = [](const std::string& result) {
    return result.starts_with("dazed") ? std::numeric_limits<double>::quiet_NaN() : 0.5;
  };
  CHECK(perform(task, 10s) == "clear did a");
  CHECK(attempts() == std::vector<std::string>{"dazed rejected", "clear accepted"});
  CHECK(attempt_of("dazed").check == "quality");
  CHECK(attempt_of("dazed").text == "its quality is no finite number");
  CHECK(attempt_of("dazed").quality.empty());
}

TEST_CASE_METHOD(Office, "a declared quality or latency that is no finite number is refused") {
  for (const std::string quality : {"nan", "inf", "-inf", "much"}) {
    CHECK_THROWS_WITH(
        owner->provide_csp<crew::Worker>("dazed", owner->id(),
                                         std::make_shared<ScriptedWorker>(answer_as("dazed")),
                                         declared("10", quality)),
        Catch::Contains("the attribute quality of 'dazed' is '" + quality + "'; write a number"));
  }
  CHECK_THROWS_WITH(owner->provide_csp<crew::Worker>(
                        "dazed", owner->id(), std::make_shared<ScriptedWorker>(answer_as("dazed")),
                        declared("inf s", "0.5")),
                    Catch::Contains("the attribute latency of 'dazed' is 'inf s'"));
}

TEST_CASE_METHOD(Office, "a service without a thread is refused") {
  CHECK_THROWS_WITH(
      owner->provide<crew::Desk>(std::make_shared<OfficeBody>(owner->head()), {.threads = 0}),
      "the service of 'office' has 0 threads; give it 1 or more");
}

TEST_CASE("a declared latency is a number of milliseconds, or has any unit of time") {
  const std::vector<std::pair<std::string, Duration>> latencies{
      {"300", 300ms},          {"300 ms", 300ms},       {"300ms", 300ms}, {"0.3 s", 300ms},
      {"300000 us", 300ms},    {"300000000 ns", 300ms}, {"2 min", 2min},  {"1.5 h", 90min},
      {"0", Duration::zero()}, {"1e300 h", 365 * 24h}};
  Office office;
  for (std::size_t i = 0; i < latencies.size(); ++i) {
    office.add("csp" + std::to_string(i), Place::Inside, answer_as("it"),
               declared(latencies[i].first, "0.5"));
  }
  office.perform(Office::task(), 10s);
  REQUIRE(office.record.candidates.size() == latencies.size());
  for (const auto& candidate : office.record.candidates) {
    const auto& [text, latency] = latencies.at(std::stoul(candidate.csp.substr(3)));
    CAPTURE(text);
    REQUIRE_FALSE(candidate.latency.empty());
    CHECK(Duration(candidate.latency[0]) == latency);
  }
}

TEST_CASE_METHOD(Office, "the last 64 decisions are kept and numbered") {
  add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  for (int i = 0; i < 70; ++i) perform(Office::task(), 1s);
  const auto decisions = owner->head().decisions();
  REQUIRE(decisions.size() == 64);
  CHECK(decisions.front().number == 7);
  CHECK(decisions.back().number == 70);
}

TEST_CASE_METHOD(Office, "only the CSP that is asked for by name runs") {
  add("thorough", Place::Outside, answer_as("thorough"), declared("20", "0.9"));
  add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  WorkTask task = Office::task();
  task.only = "quick";
  CHECK(perform(task, 10s) == "quick did it");
  task.only = "nobody";
  CHECK_THROWS_AS(perform(task, 10s), Unavailable);
  CHECK_THROWS_WITH(perform(task, 10s),
                    Catch::Contains("'nobody'") && Catch::Contains("crew/Worker"));
}

TEST_CASE_METHOD(Office, "a task that does not say how to call a CSP is refused") {
  CHECK_THROWS_WITH(perform(WorkTask(), 1s), Catch::Contains("no `run`"));
}

TEST_CASE_METHOD(Office, "without any CSP a task is refused with the reason") {
  CHECK_THROWS_AS(perform(Office::task(), 1s), Unavailable);
  CHECK_THROWS_WITH(perform(Office::task(), 1s), Catch::Contains("crew/Worker"));
}

TEST_CASE("a Head's default may be a strategy that it was given") {
  HeadOptions options;
  options.strategy = "slowest";
  options.strategies = {std::make_shared<Slowest>()};
  Office office(options);
  office.add("slow", Place::Outside, answer_as("slow"), declared("60000", "0.1"));
  office.add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  CHECK(office.perform(Office::task(), 10s) == "slow did it");
  CHECK(office.record.strategy == "slowest");
}

TEST_CASE("a default that the Head does not know is refused with those that it knows") {
  HeadOptions options;
  options.strategy = "slowst";
  options.strategies = {std::make_shared<Slowest>()};
  CHECK_THROWS_AS(Office(options), InvalidArgument);
  CHECK_THROWS_WITH(Office(options), Catch::Contains("'slowst' (did you mean 'slowest'?)") &&
                                         Catch::Contains("there are: ") &&
                                         Catch::Contains(", slowest"));
}

TEST_CASE_METHOD(Office, "a client's session selects by the strategy that it asked for", "[wire]") {
  owner->head().add_strategy(std::make_shared<Slowest>());
  add("slow", Place::Outside, answer_as("slow"), declared("60000", "0.1"));
  add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  owner->provide<crew::Desk>(std::make_shared<OfficeBody>(owner->head()));
  const auto client = make_client();
  auto by_default = client->connect<crew::Desk>();
  auto by_own = client->connect<crew::Desk>({.strategy = "slowest"});
  CHECK(by_default.ask("a") == "quick did a");
  CHECK(by_own.ask("b") == "slow did b");
  CHECK(by_default.ask("c") == "quick did c");
}

TEST_CASE_METHOD(Office, "the time of a task is the caller's, whatever the Body would give") {
  add("thorough", Place::Outside, answer_as("thorough"), declared("3000", "0.9"));
  add("quick", Place::Inside, answer_as("quick"), declared("1", "0.5"));
  owner->provide<crew::Desk>(std::make_shared<OfficeBody>(owner->head()));
  const auto client = make_client();
  auto desk = client->connect<crew::Desk>();
  CHECK(desk.within(2s).ask("a") == "quick did a");
  CHECK(desk.within(20s).ask("b") == "thorough did b");
}

TEST_CASE_METHOD(Office,
                 "who works for the Head now is known while it works, where its description says",
                 "[wire]") {
  Hang hang;
  const bool elsewhere = GENERATE(false, true);
  std::optional<DistantWorker> distant;
  std::shared_ptr<ScriptedWorker> worker;
  if (elsewhere) {
    worker = std::make_shared<ScriptedWorker>(hang.script());
    distant.emplace(*this, "slow").serve(worker);
  } else {
    worker = add("slow", Place::Outside, hang.script(), declared("10", "0.5"));
  }
  std::thread other([&] { perform(Office::task(), 60s); });
  const bool entered = eventually([&] { return worker->inside == 1; });
  const auto running = owner->head().running();
  hang.release();
  other.join();
  REQUIRE(entered);
  REQUIRE(running.size() == 1);
  CHECK(running[0].csp == "slow");
  CHECK((running[0].host == "elsewhere") == elsewhere);
  if (!elsewhere) CHECK(running[0].pid == static_cast<std::uint32_t>(getpid()));
  CHECK(owner->head().running().empty());
}

TEST_CASE_METHOD(Office, "a client changes its strategy by disconnecting and connecting again") {
  add("a", Place::Inside, answer_as("a"), declared("10", "0.1"));
  add("b", Place::Inside, answer_as("b"), declared("10", "0.9"));
  owner->provide<crew::Desk>(std::make_shared<OfficeBody>(owner->head()));
  const auto client = make_client();
  const std::string first =
      owner->broker().find_service(owner->broker().query("crew/Worker")).front()->entity;
  for (const std::string& strategy : StrategyFactory().names()) {
    auto desk = client->connect<crew::Desk>({.strategy = strategy});
    CHECK(desk.ask("it") == (strategy == "fixed_order" ? first : "b") + " did it");
    CHECK(owner->head().decisions().back().strategy == strategy);
    desk.disconnect();
  }
}

TEST_CASE_METHOD(Office, "a Body may call the CSP that the Head selects beforehand itself") {
  const Place place = GENERATE(Place::Inside, Place::Outside);
  add("better", place, answer_as("better"), declared("10", "0.9"));
  add("other", Place::Inside, answer_as("other"), declared("10", "0.5"));
  auto worker = owner->head().preselect<crew::Worker>();
  CHECK(worker.work("a") == "better did a");
  CHECK(worker.work("b") == "better did b");
  REQUIRE(owner->head().decisions().size() == 1);
  record = owner->head().decisions().front();
  CHECK(attempts() == std::vector<std::string>{"better preselected"});
  CHECK_THAT(explain(record), Catch::Contains("for the Body to call itself") &&
                                  Catch::Contains("better has the best declared quality"));
  CHECK(replay(record).front().csp == "better");
}

TEST_CASE_METHOD(Office,
                 "where nothing can be selected beforehand, that is recorded with the reason") {
  std::optional<DistantWorker> silent;
  std::vector<std::string> made;
  SECTION("as there is no CSP") {
    CHECK_THROWS_WITH(owner->head().preselect<crew::Worker>(),
                      Catch::Contains("crew/Worker") &&
                          Catch::Contains("a CSP for it, by provide_csp() or by <csp>"));
  }
  SECTION("as the CSP does not answer") {
    silent.emplace(*this, "silent");
    CHECK_THROWS_AS(owner->head().preselect<crew::Worker>({}, 100ms), Unavailable);
    made = {"silent failed"};
  }
  REQUIRE(owner->head().decisions().size() == 1);
  record = owner->head().decisions().front();
  CHECK(attempts() == made);
  CHECK_FALSE(record.failure.empty());
  CHECK_THAT(explain(record),
             Catch::Contains("for the Body to call itself") && Catch::Contains("  failed after"));
}

TEST_CASE_METHOD(Office, "a task that no CSP could fulfil is refused with what is wrong in it") {
  const auto quick = add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  const auto refused = [&](const WorkTask& task, const std::string& text) {
    CHECK_THROWS_AS(perform(task, 1s), InvalidArgument);
    CHECK_THROWS_WITH(perform(task, 1s), text);
  };
  WorkTask task = Office::task();
  task.width = 0;
  refused(task, "the task's `width` is 0, so that no CSP may work on it; give 1 or more");
  task = Office::task();
  task.enough = 0;
  refused(task, "the task's `enough` is 0, which no result is needed for; give 1 or more, or kAll");
  task = Office::task();
  task.utility.good_enough = std::numeric_limits<double>::quiet_NaN();
  refused(task, "the task's `utility.good_enough` is no finite number");
  task = Office::task();
  task.features = {{"cells", 1}, {"area", std::numeric_limits<double>::quiet_NaN()}};
  refused(task, "the feature 'area' of the task is no finite number");
  task.features = {{"cells", std::numeric_limits<double>::infinity()}};
  refused(task, "the feature 'cells' of the task is no finite number");
  task.features = {{"cells", 1}, {"area", 2}, {"cells", 1}};
  refused(task, "the feature 'cells' of the task stands there twice");
  CHECK_THROWS_WITH(owner->head().preselect<crew::Worker>(task.features),
                    "the feature 'cells' of the task stands there twice");
  CHECK(quick->calls == 0);
}

TEST_CASE_METHOD(Office, "an attribute that is almost one which a Head reads is told of") {
  const Log log;
  ServiceOptions options;
  options.attributes = {{"latancy", "10"}, {"Quality", "0.5"}, {"cost", "3"}, {"quantity", "3"}};
  add("quick", Place::Inside, answer_as("quick"), options);
  CHECK(log.count("uav-1/office: 'quick' declares the attribute 'latancy', which no Head reads "
                  "(did you mean 'latency'?)") == 1);
  CHECK(log.count("the attribute 'Quality', which no Head reads (did you mean 'quality'?)") == 1);
  CHECK(log.count("\n") == 2);
}

TEST_CASE("a skeleton without an implementation is refused when it is made") {
  CHECK_THROWS_AS(crew::Worker::Skeleton(nullptr), InvalidArgument);
  CHECK_THROWS_WITH(crew::Worker::Skeleton(nullptr),
                    "a service of crew/Worker has no implementation: null");
}

TEST_CASE("a task may have more time than any clock counts, whatever the strategy") {
  Office office(HeadOptions{.strategy = GENERATE(from_range(StrategyFactory().names()))});
  office.add("quick", Place::Inside, answer_as("quick"), declared("10", "0.5"));
  office.add("other", Place::Inside, answer_as("other"), declared("10", "0.5"));
  auto task = Office::task();
  task.execution = GENERATE(Execution::One, Execution::Staggered, Execution::All);
  for (int i = 0; i < 2; ++i) CHECK_NOTHROW(office.perform(task, Duration::max()));
}

TEST_CASE_METHOD(Office,
                 "a task that waits for more results than there are CSPs is told of, once") {
  const Log log;
  add("quick", Place::Inside, answer_as("quick"), declared("1", "0.5"));
  auto task = Office::task();
  task.enough = 3;
  for (int i = 0; i < 2; ++i) CHECK(perform(task, 10s) == "quick did it");
  CHECK(log.count("a task waits for `enough` = 3 results, but crew/Worker has 1 CSPs") == 1);
}

TEST_CASE_METHOD(Office, "a declared quality that is not on the common scale is told of") {
  const Log log;
  add("boaster", Place::Inside, answer_as("boaster"), declared("1", "1.5"));
  CHECK(log.count("'boaster' declares a quality of 1.5; the scale is 0 to 1") == 1);
}
