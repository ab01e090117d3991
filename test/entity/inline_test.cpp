#include <catch2/catch.hpp>

#include "../tools/parked_threads.hpp"
#include "office.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;

namespace {

/// Performs on its own thread, by a blocking call of the CSP.
class BlockingBody final : public crew::Desk {
 public:
  explicit BlockingBody(Head& head) : head_(head) {}

  std::string ask(const std::string& text) override {
    thread = std::this_thread::get_id();
    WorkTask task = Office::task(text);
    task.execution = execution;
    task.run = [text](crew::Worker::Proxy& worker, Duration) { return worker.work(text); };
    const std::string result = head_.perform(task);
    ++returned;
    return result;
  }

  std::atomic<std::thread::id> thread;
  std::atomic<Execution> execution{Execution::One};
  std::atomic<int> returned{0};

 private:
  Head& head_;
};

/// How a CSP is told to hang.
struct Moody {
  std::atomic<bool> hangs{false};
  std::atomic<bool> hangs_on_the_body{false};  // only where it runs on the Body's thread
  Hang hang;
};

/// An office with a Body and a client; what they and their CSPs did.
struct OpenOffice {
  /// By default a CSP counts as quick on the slowest machine, too.
  explicit OpenOffice(HeadOptions head = {.quick = 50ms})
      : office(std::make_unique<Office>(std::move(head))) {
    body = std::make_shared<BlockingBody>(office->owner->head());
    office->owner->provide<crew::Desk>(body);
    desk.emplace(client->connect<crew::Desk>());
  }

  /// A CSP that notes its thread and then does what `script` says.
  std::shared_ptr<ScriptedWorker> add(const std::string& name, const std::string& quality,
                                      ScriptedWorker::Script script) {
    return office->add(
        name, Place::Inside,
        [this, script = std::move(script)](const std::string& task) {
          csp_thread = std::this_thread::get_id();
          return script(task);
        },
        declared("1", quality));
  }

  std::shared_ptr<ScriptedWorker> add(Moody& moody) {
    return add("moody", "0.9", [this, &moody, hang = moody.hang.script()](const std::string& task) {
      if (moody.hangs || (moody.hangs_on_the_body && runs_on_the_bodys_thread())) return hang(task);
      return "moody did " + task;
    });
  }

  /// Asks until a CSP hangs on the Body's thread.
  bool loses_a_thread() {
    return eventually([&] {
      try {
        desk->within(500ms).ask("it");
        return false;
      } catch (const TimedOut&) {
        return true;
      }
    });
  }

  bool runs_on_the_bodys_thread() const { return csp_thread.load() == body->thread.load(); }
  bool ran_on_the_bodys_thread() {
    desk->ask("it");
    return runs_on_the_bodys_thread();
  }
  bool is_trusted() {
    return eventually([&] { return ran_on_the_bodys_thread(); });
  }

  Head& head() { return office->owner->head(); }
  Lines last_attempts() {
    office->record = head().decisions().back();
    return office->attempts();
  }

  std::atomic<std::thread::id> csp_thread;
  std::unique_ptr<Office> office;
  std::shared_ptr<BlockingBody> body;
  std::unique_ptr<Entity> client = make_client();
  std::optional<crew::Desk::Proxy> desk;
};

}  // namespace

TEST_CASE("a CSP that has shown to be quick runs on the thread of the Body that performs") {
  OpenOffice open;
  open.add("quick", "0.9", answer_as("quick"));
  CHECK_FALSE(open.ran_on_the_bodys_thread());
  CHECK(open.is_trusted());

  SECTION("not where several may work at a time") {
    open.body->execution = GENERATE(Execution::Staggered, Execution::All);
    CHECK_FALSE(open.ran_on_the_bodys_thread());
  }
  SECTION("not where little time is left") {
    // On a loaded machine so little may be too little.
    CHECK(eventually([&] {
      try {
        return !open.desk->within(90ms).ask("it").empty();
      } catch (const TimedOut&) {
        return false;
      }
    }));
    CHECK_FALSE(open.runs_on_the_bodys_thread());
  }
  SECTION("not on a thread that nobody could replace") {
    WorkTask task = Office::task();
    task.run = [](crew::Worker::Proxy& worker, Duration) { return worker.work("it"); };
    open.office->perform(task, 10s);
    CHECK(open.csp_thread.load() != std::this_thread::get_id());
  }
}

TEST_CASE("a CSP that is not quick keeps its own thread") {
  OpenOffice open(HeadOptions{.quick = 100us});
  open.add("slow", "0.9", [](const std::string& task) {
    const auto end = std::chrono::steady_clock::now() + 200us;
    while (std::chrono::steady_clock::now() < end) {
    }
    return "slow did " + task;
  });
  for (int i = 0; i < 30; ++i) CHECK_FALSE(open.ran_on_the_bodys_thread());
}

TEST_CASE("a CSP that is at work elsewhere is not entered by a second thread") {
  Moody moody;
  OpenOffice open;
  const auto worker = open.add(moody);
  REQUIRE(open.is_trusted());
  moody.hangs = true;
  std::string result;
  std::thread other([&] { result = open.head().perform(Office::task(), nullptr, 60s); });
  const bool entered = eventually([&] { return worker->inside == 1; });
  CHECK_THROWS_AS(open.desk->within(300ms).ask("it"), TimedOut);
  CHECK(worker->inside == 1);
  CHECK(open.csp_thread.load() != open.body->thread.load());
  moody.hang.release();
  other.join();
  REQUIRE(entered);
  CHECK(result == "too late");
}

TEST_CASE("a CSP that hangs on the Body's thread costs that thread, and nothing else") {
  const auto parked = parked_threads();
  Moody moody;
  OpenOffice open;
  open.add(moody);
  open.add("sound", "0.5", answer_as("sound"));
  moody.hangs_on_the_body = true;
  REQUIRE(open.loses_a_thread());
  REQUIRE(eventually([&] { return open.last_attempts() == Lines{"moody timed out"}; }));
  CHECK_THAT(open.office->record.failure, Catch::Contains("moody hangs"));
  CHECK(open.office->record.stuck == 1);
  CHECK(replay(open.office->record).size() == 1);
  CHECK(open.head().running().empty());

  // The next request is served.
  CHECK(open.desk->ask("it") == "sound did it");
  CHECK(open.last_attempts() == Lines{"sound accepted"});

  // What comes back goes no further, and the CSP is trusted never again.
  const int returned = open.body->returned;
  moody.hang.release();
  CHECK(eventually([&] { return parked_threads() == parked + 1; }));
  CHECK(open.body->returned == returned);
  CHECK(eventually([&] { return open.desk->ask("it") == "moody did it"; }));
  for (int i = 0; i < 30; ++i) CHECK_FALSE(open.ran_on_the_bodys_thread());
  CHECK(open.head().decisions().back().stuck == 1);
}

TEST_CASE("a Head that has lost as many threads as it may runs no CSP on others") {
  const auto parked = parked_threads();
  Moody moody;
  OpenOffice open(HeadOptions{.most_stuck = 1, .quick = 50ms});
  open.add(moody);
  CHECK_FALSE(open.head().degraded());
  moody.hangs_on_the_body = true;
  REQUIRE(open.loses_a_thread());
  CHECK(eventually([&] { return open.head().degraded(); }));
  open.add("sound", "0.5", answer_as("sound"));
  for (int i = 0; i < 30; ++i) CHECK_FALSE(open.ran_on_the_bodys_thread());
  moody.hang.release();
  CHECK(eventually([&] { return parked_threads() == parked + 1; }));
  CHECK(open.head().degraded());
}

TEST_CASE(
    "an entity ends although a CSP hangs on its Body's thread, and what comes back is parked") {
  const auto parked = parked_threads();
  Moody moody;
  OpenOffice open;
  const auto worker = open.add(moody);
  moody.hangs_on_the_body = true;
  SECTION("after the thread was written off") {
    REQUIRE(open.loses_a_thread());
    open.office.reset();
  }
  SECTION("before that") {
    std::optional<Call<std::string>> call;
    REQUIRE(eventually([&] {
      call.emplace(open.desk->within(60s).async_ask("it"));
      const auto hangs = [&] { return worker->inside == 1 && open.runs_on_the_bodys_thread(); };
      return eventually([&] { return call->ready() || hangs(); }) && hangs();
    }));
    open.office.reset();
    CHECK_THROWS_AS(call->get(), Error);
  }
  const int returned = open.body->returned;
  moody.hang.release();
  CHECK(eventually([&] { return parked_threads() == parked + 1; }));
  CHECK(open.body->returned == returned);
}
