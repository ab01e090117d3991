#include <catch2/catch.hpp>

#include "mission/peer/peer.hpp"
#include "test/mission/profile/profile_folder.hpp"

using namespace skein;
using namespace std::chrono_literals;

TEST_CASE("What a profile says of a peer's Head is how its entity decides") {
  ProfileFolder folder;
  const auto mission = profile::read_mission_profile(folder.mission(
      R"(<peer name="n" component="n.xml" vendor="loopback" system="uav" strategy="learned"
           history="h.json" decision_log="d.jsonl" exploration="0.25" max_stuck="7"
           quarantine_after="2" first_quarantine="300 ms" longest_quarantine="5 s"/>)"));
  const EntityOptions options = launch::entity_options(mission, mission.peers.at(0));
  CHECK(options.system == "uav");
  CHECK(options.head.strategy == "learned");
  CHECK(options.head.history == "h.json");
  CHECK(options.head.log == "d.jsonl");
  CHECK(options.head.exploration == 0.25);
  CHECK(options.head.max_stuck == 7);
  CHECK(options.head.breaker.faults == 2);
  CHECK(options.head.breaker.first_quarantine == 300ms);
  CHECK(options.head.breaker.longest_quarantine == 5s);
}

TEST_CASE("Calls of a peer go through shared memory where its profile says so") {
  ProfileFolder folder;
  const auto mission = profile::read_mission_profile(folder.mission(
      R"(<peer name="plain" component="n.xml" vendor="loopback"/>
<peer name="shared" component="n.xml" vendor="loopback" shared_memory_calls="true"/>)"));
  CHECK(launch::entity_options(mission, mission.peers.at(0)).shared_memory_calls == std::nullopt);
  CHECK(launch::entity_options(mission, mission.peers.at(1)).shared_memory_calls == true);
}

TEST_CASE("What a profile says of a topic stands in place of what the code says of it") {
  ProfileFolder folder;
  const auto mission = profile::read_mission_profile(
      folder.mission(R"(<topic name="state" deadline="100 ms" history="all"/>
<topic name="goal" reliability="best-effort"/>
<topic name="wish" ownership="shared" durability="transient-local"/>
<peer name="f" component="f.xml" vendor="loopback"><topic name="goal" strength="7" lease="none"/>
</peer>)"));
  const EntityOptions options = launch::entity_options(mission, mission.peers.at(0));
  TopicQos state = TopicQos::state();
  options.adjust_topic("state", state);
  CHECK(state.deadline == 100ms);
  CHECK_FALSE(state.history_depth);
  CHECK(state.transient_local);
  TopicQos goal = TopicQos::command(2);
  options.adjust_topic("goal", goal);
  CHECK(goal.strength == 7);
  CHECK(goal.exclusive);
  CHECK(goal.reliable);
  CHECK_FALSE(goal.liveliness_lease);
  TopicQos wish = TopicQos::command(2);
  options.adjust_topic("wish", wish);
  CHECK_FALSE(wish.exclusive);
  CHECK(wish.strength == 0);
  CHECK(wish.transient_local);
  CHECK(wish.max_waiting == 0);
  TopicQos other;
  options.adjust_topic("other", other);
  CHECK_FALSE(other.deadline);
  CHECK(other.reliable);
}

TEST_CASE("Where a peer speaks and whom it asks follows from the profile") {
  ProfileFolder folder;
  const auto network_of = [&](const std::string& attributes) {
    const auto mission = profile::read_mission_profile(
        folder.mission(R"(<peer name="a" component="f.xml" host="10.0.0.1" )" + attributes +
                       R"(/><peer name="b" component="f.xml" host="10.0.0.2"/>
           <peer name="c" component="f.xml" host="10.0.0.2"/>
           <peer name="d" component="f.xml" host="localhost"/>
           <peer name="e" component="f.xml" host="10.0.0.1"/>)"));
    return launch::network_of(mission, mission.peers.at(0));
  };
  using Hosts = std::vector<std::string>;
  SECTION("without an interface: on this host alone") {
    CHECK(network_of("").interfaces.empty());
    CHECK(network_of("").peers.empty());
  }
  SECTION("with an interface alone: the mission's other hosts") {
    const auto network = network_of("interface='eth0'");
    CHECK(network.interfaces == Hosts{"eth0"});
    CHECK(network.peers == Hosts{"10.0.0.2"});
    CHECK_FALSE(network.multicast_discovery);
  }
  SECTION("with allowed sources: to those alone it listens, on whatever interface") {
    CHECK(network_of("allowed_sources='10.0.0.7 10.1.0.0/16'").allowed_sources ==
          Hosts{"10.0.0.7", "10.1.0.0/16"});
    CHECK(network_of("interface='eth0' allowed_sources='10.0.0.7'").allowed_sources ==
          Hosts{"10.0.0.7"});
  }
  SECTION("with peers: those") {
    CHECK(network_of("interface='eth0' peers='10.0.0.7, far'").peers == Hosts{"10.0.0.7", "far"});
  }
  SECTION("with multicast: nobody in particular") {
    const auto network = network_of("interface='eth0' multicast='true'");
    CHECK(network.multicast_discovery);
    CHECK(network.peers.empty());
  }
}
