#include <catch2/catch.hpp>

#include "brokerless_discovery/admission.hpp"
#include "exposed_service.hpp"
#include "processes.hpp"
#include "skein/detail/codec.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using brokerless_discovery::Refusal;
using brokerless_discovery::Room;
using brokerless_discovery::ServiceDescription;
using ::test::LouderEcho;

namespace {

/// A participant that is no entity and writes descriptions as it likes.
class Rogue {
 public:
  explicit Rogue(dds::Vendor& vendor) {
    dds::ParticipantOptions options;
    options.domain = 17;
    options.name = "rogue";
    participant_ = vendor.create_participant(options);
    dds::Qos qos;
    qos.transient_local = true;
    qos.history_depth = 1;
    qos.liveliness_lease = 1000ms;
    qos.partitions = {""};
    writer_ = participant_->create_writer(
        {"skein/services", "skein::discovery::ServiceDescription", true}, qos);
    REQUIRE(eventually([&] { return writer_->matched_readers().size() == 2; }));
  }

  /// Of its own, under whatever name.
  ServiceDescription describe(std::uint32_t number, const std::string& entity) const {
    Guid provider = participant_->guid();
    for (int i = 0; i < 3; ++i) {
      provider.bytes[12 + i] = static_cast<std::uint8_t>(number >> 8 * i);
    }
    auto description = describe_echo(provider, entity);
    description.system = "uav-1";
    return description;
  }

  void write(const ServiceDescription& description) { write(description, {description.provider}); }
  void write(const ServiceDescription& description, const Guid& key) {
    writer_->write(idl::encode_message(description), key);
  }
  void withdraw(const Guid& provider) { writer_->dispose(provider); }

 private:
  std::unique_ptr<dds::Participant> participant_;
  std::unique_ptr<dds::Writer> writer_;
};

/// A provider and a client that calls it.
struct Scene {
  Scene() {
    REQUIRE(eventually([&] { return client->broker().knows(service.id()); }));
  }

  bool all(const std::function<bool(brokerless_discovery::Broker&)>& holds) {
    return eventually([&] { return holds(server->broker()) && holds(client->broker()); });
  }
  bool all_know(const ServiceDescription& description, bool known = true) {
    return all([&](auto& broker) { return broker.knows({description.provider}) == known; });
  }
  bool all_refused(Refusal why, std::uint64_t count) {
    return all([&](auto& broker) { return broker.refused(why) == count; });
  }

  std::unique_ptr<Entity> server = entity_with_lease("server", Pairing::get().server, 1000ms);
  std::unique_ptr<Entity> client = entity_with_lease("client", Pairing::get().client, 1000ms);
  ExposedService service{*server, std::make_shared<EchoService>()};
  LouderEcho::Proxy echo = client->connect<LouderEcho>({.provider = service.id(), .timeout = 20s});
};

dds::Vendor& vendor_of_rogue() { return *GENERATE(Pairing::get().server, Pairing::get().client); }

}  // namespace

TEST_CASE("a stranger withdraws nobody else's service, and takes none with him by claiming it",
          "[R23]") {
  dds::Vendor& vendor = vendor_of_rogue();
  Scene scene;
  auto rogue = std::make_unique<Rogue>(vendor);
  ServiceDescription victim;
  for (const auto& known : scene.client->broker().all()) victim = *known;
  REQUIRE(victim.provider == scene.service.id().bytes);
  const auto marker = rogue->describe(1, "marker");

  // One after the other has arrived: of one instance a writer keeps the newest sample only.
  rogue->write(marker);
  REQUIRE(scene.all_know(marker));
  rogue->withdraw(scene.service.id());
  CHECK(scene.all_refused(Refusal::Forged, 1));
  auto claimed = victim;
  claimed.process = "";
  rogue->write(claimed);
  CHECK(scene.all_refused(Refusal::Forged, 2));
  rogue->write(rogue->describe(3, "thief"), scene.service.id());
  CHECK(scene.all_refused(Refusal::Forged, 3));
  auto suicide = rogue->describe(4, "suicide");
  suicide.host = victim.host;
  suicide.process = victim.process;
  rogue->write(suicide);
  CHECK(scene.all_refused(Refusal::Forged, 4));
  rogue->write(claimed, {rogue->describe(2, "").provider});
  CHECK(scene.all_refused(Refusal::Malformed, 1));
  CHECK(scene.all_know(victim));
  CHECK(scene.client->broker().all().size() == 2);
  CHECK(scene.echo.within(20s).echo("x") == "x");

  rogue.reset();
  REQUIRE(scene.all_know(marker, false));
  CHECK(scene.all_know(victim));
  CHECK(scene.echo.within(20s).echo("x") == "x");
  CHECK(scene.client->connect<LouderEcho>({.timeout = 20s}).echo("new") == "new");
  const auto late = entity_with_lease("late", Pairing::get().client, 1000ms);
  CHECK(late->connect<LouderEcho>({.timeout = 20s}).echo("late") == "late");
}

TEST_CASE(
    "a flood of one participant's descriptions fills its own room and no more, and goes with it",
    "[R26]") {
  constexpr std::uint32_t kFlood = 3000;
  dds::Vendor& vendor = vendor_of_rogue();
  Scene scene;
  auto rogue = std::make_unique<Rogue>(vendor);
  for (std::uint32_t i = 1; i <= kFlood; ++i) {
    rogue->write(rogue->describe(i, "flood" + std::to_string(i)));
  }
  CHECK(scene.all([&](auto& broker) {
    return broker.refused(Refusal::NoRoom) >= kFlood - Room::kEntriesOfOne;
  }));
  CHECK(scene.all([](auto& broker) { return broker.all().size() == Room::kEntriesOfOne + 1; }));
  CHECK(scene.echo.within(20s).echo("x") == "x");

  const auto another = std::make_unique<Rogue>(vendor);
  const auto marker = another->describe(1, "marker");
  another->write(marker);
  CHECK(scene.all_know(marker));
  rogue.reset();
  CHECK(scene.all([](auto& broker) { return broker.all().size() == 2; }));
  CHECK(scene.echo.within(20s).echo("x") == "x");
}
