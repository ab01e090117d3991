#include <catch2/catch.hpp>
#include <cstdio>

#include "navigator.hpp"
#include "site.hpp"

using namespace std::chrono_literals;

namespace {

double reliability(const skein::Candidate& candidate) {
  return candidate.learned ? candidate.learned->reliability : 1.0;
}

/// Whoever was accepted most often goes first, however long it takes.
class MostReliable : public skein::SelectionStrategy {
 public:
  std::string name() const override { return "most_reliable"; }

  skein::Selection select(const std::vector<skein::Candidate>& candidates,
                          const skein::Situation& situation) const override {
    std::size_t best = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i) {
      if (reliability(candidates[i]) > reliability(candidates[best])) best = i;
    }
    return {best, situation.remaining / 2, "it was accepted most often"};
  }
};

struct NavigatorSite : Site {
  NavigatorSite() {
    drone.provide_csp<survey::IPlanner>("Rows", drone.id(), std::make_shared<Rows>(),
                                        {.attributes = {{"latency", "20"}, {"quality", "0.9"}}});
    drone.provide<survey::INavigator>(std::make_shared<Navigator>(drone.head()));
    drone.provide_csp<survey::IPlanner>("Careless", drone.id(), std::make_shared<Careless>(),
                                        {.attributes = {{"latency", "1"}, {"quality", "0.95"}}});
  }
};

}  // namespace

TEST_CASE("the Head asks the next CSP where a result is not good enough, and says why") {
  NavigatorSite site;
  skein::Entity& drone = site.drone;
  auto navigator = site.station.connect<survey::INavigator>();
  CHECK(navigator.within(30s).plan(kField).planner == "Rows");

  const skein::introspection::Decision last = drone.head().decisions().back();
  std::fputs(skein::explain(last).c_str(), stdout);

  CHECK_THAT(skein::explain(last), Catch::Contains("rejected") &&
                                       Catch::Contains("by the check 'covers the area'") &&
                                       Catch::Contains("accepted"));
  CHECK(skein::replay(last).front().csp == "Careless");
}

TEST_CASE("where no result is good enough the Body says so in its interface's words") {
  Site site;
  site.drone.provide_csp<survey::IPlanner>("Careless", site.drone.id(),
                                           std::make_shared<Careless>());
  site.drone.provide<survey::INavigator>(std::make_shared<Navigator>(site.drone.head()));
  auto navigator = site.station.connect<survey::INavigator>();
  CHECK_THROWS_AS(navigator.within(30s).plan(kField), survey::NoTrack);
}

TEST_CASE("a client asks for a strategy of one's own by its name") {
  NavigatorSite site;
  skein::Entity& drone = site.drone;
  skein::Entity& station = site.station;

  drone.head().add_strategy(std::make_shared<MostReliable>());
  auto navigator = station.connect<survey::INavigator>({.strategy = "most_reliable"});

  CHECK(navigator.within(30s).plan(kField).planner == "Rows");
  CHECK(drone.head().decisions().back().strategy == "most_reliable");
}
