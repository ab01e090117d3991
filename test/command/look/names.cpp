// By which names people may mean what is on a domain, and where they look for it.
#include <catch2/catch.hpp>

#include "command/look/service_names.hpp"
#include "command/mission/missions_elsewhere.hpp"
#include "skein/discovery.idl.hpp"

using namespace skein;
using namespace skein::command;
using Catch::Contains;

TEST_CASE("a service is meant by its interface, the last part of that, and its entity") {
  discovery::ServiceDescription service;
  service.service = "AE_navigator/INavigator";
  service.system = "uav-1";
  service.entity = "navigator";
  for (const char* name : {"AE_navigator/INavigator", "AE_navigator::INavigator", "INavigator",
                           "navigator", "uav-1/navigator"}) {
    CAPTURE(name);
    CHECK(is_named(service, name));
  }
  for (const char* name : {"", "AE_navigator", "uav-2/navigator", "Navigator"}) {
    CAPTURE(name);
    CHECK_FALSE(is_named(service, name));
  }
}

TEST_CASE("of an entity with several services one must be named") {
  const auto service = [](const char* name) {
    auto described = std::make_shared<discovery::ServiceDescription>();
    described->service = name;
    described->system = "hq";
    described->entity = "desk";
    return described;
  };
  CHECK(choice_among({}).empty());
  CHECK(choice_among({service("crew/Desk")}).empty());
  CHECK(choice_among({service("crew/Desk"), service("crew/Bell")}) ==
        "hq/desk provides crew::Desk, crew::Bell; name one of them, with --system hq");
}

TEST_CASE("a type is meant by its name and by the last parts of that") {
  CHECK(is_type_named("boat::Pose", "boat::Pose"));
  CHECK(is_type_named("boat::Pose", "Pose"));
  CHECK_FALSE(is_type_named("boat::Pose", "ose"));
  CHECK_FALSE(is_type_named("boat::Pose", ""));
}

TEST_CASE("missions on other domains are told where none flies on this one") {
  CHECK(missions_elsewhere(0, {42}) == "missions fly here on domain 42");
  CHECK(missions_elsewhere(0, {42, 7, 42}) == "missions fly here on domain 7, 42");
  CHECK(missions_elsewhere(42, {42, 7}).empty());
  CHECK(missions_elsewhere(0, {}).empty());
}

TEST_CASE("who launches a mission where others fly is told by which processes") {
  CHECK(missions_beside(48, std::vector<doctor::Launcher>{}).empty());
  CHECK(missions_beside(48, {{47, {12, "skein"}}}).empty());
  CHECK_THAT(missions_beside(48, {{47, {12, "skein"}}, {48, {13, "skein"}}, {48, {}}}),
             Contains("flies on domain 48 (process 13, another user's launcher), and the peers of "
                      "both meet"));
}
