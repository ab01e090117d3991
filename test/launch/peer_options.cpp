#include <catch2/catch.hpp>

#include "profile_folder.hpp"
#include "skein/launch/peer.hpp"

using namespace skein;
using namespace std::chrono_literals;

TEST_CASE("What a profile says of a peer's Head is how its entity decides") {
  ProfileFolder folder;
  const auto mission = profile::read_mission_profile(folder.mission(
      R"(<peer name="n" component="n.xml" vendor="loopback" system="uav" strategy="learned"
           history="h.json" decision_log="d.jsonl" exploration="0.25" most_stuck="7"
           quarantine_after="2" first_quarantine="300 ms" longest_quarantine="5"/>)"));
  const EntityOptions options = launch::entity_options(mission, mission.peers.at(0));
  CHECK(options.system == "uav");
  CHECK(options.head.strategy == "learned");
  CHECK(options.head.history == "h.json");
  CHECK(options.head.log == "d.jsonl");
  CHECK(options.head.exploration == 0.25);
  CHECK(options.head.most_stuck == 7);
  CHECK(options.head.breaker.faults == 2);
  CHECK(options.head.breaker.first_quarantine == 300ms);
  CHECK(options.head.breaker.longest_quarantine == 5s);
}
