#include "entity/head/head_learning.hpp"

#include <catch2/catch.hpp>

using namespace skein;
using namespace std::chrono_literals;
using entity::RunEnding;
using introspection::Outcome;

namespace {

struct Learning {
  entity::HeadLearning learning{"uav-1/office", ""};
  InterfaceInfo interface = {"crew::Worker", {}, {}, {}};
  std::shared_ptr<const Features> features = std::make_shared<const Features>();
  std::vector<Candidate> candidates = std::vector<Candidate>(1);

  Learning() { candidates[0].name = "worker"; }

  /// Whether the history has a prediction for the CSP after a run that ended so.
  bool learns_from(const RunEnding& ending) {
    learning.add(interface, candidates[0], features, ending);
    learning.predict(interface, *features, candidates);
    return candidates[0].learned.has_value();
  }
};

}  // namespace

TEST_CASE_METHOD(Learning, "a Head learns from each run that shows how long a CSP takes") {
  CHECK(learns_from(
      GENERATE(RunEnding{.outcome = Outcome::Accepted, .took = 1ms},
               RunEnding{.outcome = Outcome::Rejected, .took = 1ms},
               RunEnding{.outcome = Outcome::TimedOut, .took = 1ms},
               // It was late when another one's result was enough.
               RunEnding{.outcome = Outcome::Cancelled, .took = 3ms, .expected = 2ms})));
}

TEST_CASE_METHOD(Learning, "a Head learns nothing from a run that was not the CSP's to end") {
  CHECK_FALSE(
      learns_from(GENERATE(RunEnding{.outcome = Outcome::Cancelled, .took = 1ms, .expected = 2ms},
                           RunEnding{.outcome = Outcome::Cancelled, .took = 1ms},
                           // The task's own function threw.
                           RunEnding{.outcome = Outcome::Failed, .took = 1ms, .own = true})));
}

TEST_CASE_METHOD(Learning, "requests and explorations are counted by interface") {
  CHECK(learning.begin_request("crew::Worker").made == 0);
  learning.end_request("crew::Worker", true);
  learning.end_request("crew::Worker", false);
  CHECK(learning.begin_request("crew::Worker").made == 1);
  CHECK(learning.begin_request("crew::Worker").explored == 1);
  CHECK(learning.begin_request("crew::Cook").made == 0);
}
