#include "entity/namesakes.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>

#include "skein/discovery.idl.hpp"
#include "skein/guid.hpp"

using namespace skein;
using brokerless_discovery::Change;
using Catch::Contains;
using skein::entity::Namesakes;

namespace {

discovery::ServiceDescription service_of(const std::string& host, pid_t process) {
  discovery::ServiceDescription service;
  service.system = "boat";
  service.entity = "tide";
  service.host = host;
  service.pid = static_cast<std::uint32_t>(process);
  return service;
}

Change added(const discovery::ServiceDescription& service) {
  return {Change::Kind::Added, std::make_shared<discovery::ServiceDescription>(service)};
}

const pid_t kOther = getppid();

}  // namespace

TEST_CASE("An entity of the same name in another process is told once") {
  Namesakes namesakes("boat", "tide", "here", static_cast<std::uint32_t>(getpid()));
  CHECK(namesakes.look_at(added(service_of("here", getpid()))).empty());
  CHECK_THAT(namesakes.look_at(added(service_of("here", kOther))),
             Contains("process " + std::to_string(kOther) + " runs an entity of the same name"));
  CHECK(namesakes.look_at(added(service_of("here", kOther))).empty());
  CHECK_THAT(namesakes.look_at(added(service_of("there", getpid()))), Contains("on another host"));
}

TEST_CASE("An entity that has another name, is managed, goes or is dead is no namesake") {
  Namesakes namesakes("boat", "tide", "here", static_cast<std::uint32_t>(getpid()));
  auto service = service_of("here", kOther);
  SECTION("another system") { service.system = "port"; }
  SECTION("another name") { service.entity = "chart"; }
  SECTION("a managed service") { service.owner = "boat/tide"; }
  SECTION("a service of Skein's own") { service.service = "skein/launch/ILiveParameters"; }
  SECTION("gone, though another process has its number") {
    service.process = "skein/" + Guid::random().hex();
  }
  CHECK(namesakes.look_at(added(service)).empty());
  CHECK(namesakes
            .look_at({Change::Kind::Removed,
                      std::make_shared<discovery::ServiceDescription>(service_of("here", kOther))})
            .empty());
}
