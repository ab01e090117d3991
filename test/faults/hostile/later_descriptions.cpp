#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <vector>

#include "rogue.hpp"
#include "test/tools/log.hpp"

/// What a later version of Skein may describe: what this one does not know, and what it did not
/// expect.
using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;

namespace {

constexpr auto kMost = std::numeric_limits<std::uint32_t>::max();

bool holds(brokerless_discovery::Broker& broker, const ServiceDescription& description) {
  const auto all = broker.all();
  return std::ranges::any_of(all, [&](const auto& known) { return *known == description; });
}

/// The connection that stands, a new one, and one of an entity that comes now.
void check_reachable(Scene& scene) {
  CHECK(scene.echo.within(20s).echo("x") == "x");
  CHECK(scene.client->connect<LouderEcho>({.timeout = 20s}).echo("new") == "new");
  const auto late = entity_with_lease("late", Pairing::get().client, 1000ms);
  CHECK(late->connect<LouderEcho>({.timeout = 20s}).echo("late") == "late");
}

/// Nobody looks for it by this interface.
ServiceDescription another(const Rogue& rogue, std::uint32_t number, const std::string& entity) {
  auto description = rogue.describe(number, entity);
  description.service = "later/Service";
  description.bases.clear();
  return description;
}

std::vector<ServiceDescription> extremes(const Rogue& rogue) {
  std::vector<ServiceDescription> all;
  auto& most = all.emplace_back(another(rogue, 1, "most"));
  most.pid = kMost;
  most.operations.assign(brokerless_discovery::kMaxOperations,
                         {"", kMost, std::numeric_limits<std::uint64_t>::max()});
  most.growing.assign(brokerless_discovery::kMaxGrowing, {kMost, kMost, kMost, true});
  most.subcomponents.assign(brokerless_discovery::kMaxBases, "later/Part");

  auto& numbers = all.emplace_back(another(rogue, 2, "numbers"));
  for (const std::string name : {"latency", "quality"}) {
    for (const char* value : {"1e308 h", "-1e308", "inf", "-inf", "nan", "1e999", "-0", "1e-320",
                              "0x10", "", " ", "99999999999999999999999999"}) {
      numbers.attributes.push_back({name + std::to_string(numbers.attributes.size()), value});
    }
  }
  numbers.attributes.push_back({"latency", "1e308 h"});
  numbers.attributes.push_back({"quality", "-inf"});
  while (numbers.attributes.size() < brokerless_discovery::kMaxAttributes) {
    numbers.attributes.push_back({"latency", "inf"});
  }

  auto& least = all.emplace_back(another(rogue, 3, "."));
  least.operations.clear();
  least.host = least.vendor = least.component = least.process = "";
  least.attributes = {{"", ""}};

  // It comes first of those that offer what the client wants, and nobody answers there.
  auto& longest = all.emplace_back(rogue.describe(4, std::string(255, 'a')));
  longest.bases.push_back(longest.service);
  longest.service = "later/" + std::string(255 - 15, 'I');
  longest.host = longest.vendor = std::string(255, '\xff');
  longest.attributes = {{std::string(255, 'n'), std::string(4096, '9')}};
  longest.component.assign(40'000, '<');
  return all;
}

struct LaterVersion {
  dds::Vendor& vendor = vendor_of_rogue();
  Scene scene;
  Rogue rogue{vendor};
  const Log log;
};

}  // namespace

TEST_CASE_METHOD(
    LaterVersion,
    "of a later version's description what is known counts, and the rest is passed over", "[R25]") {
  std::uint32_t number = 0;
  for (const std::byte octet : {std::byte{0}, std::byte{0xff}}) {
    for (const std::size_t added : {1u, 4u, 5000u}) {
      ++number;
      const auto description = another(rogue, number, "later" + std::to_string(number));
      Bytes message = idl::encode_message(description);
      message.append(std::vector<std::byte>(added, octet));
      rogue.write(message, {description.provider});
      CHECK(scene.all([&](auto& broker) { return holds(broker, description); }));
    }
  }
  check_reachable(scene);
  CHECK(log.text().empty());
}

TEST_CASE_METHOD(LaterVersion,
                 "a description of the largest and oddest values that there may be stops nobody",
                 "[R25]") {
  for (const auto& description : extremes(rogue)) {
    CAPTURE(description.entity);
    rogue.write(description);
    CHECK(scene.all_know(description));
  }
  check_reachable(scene);
  for (const char* limit : {"1", "1 h", "inf", "-1e308"}) {
    for (const Relation relation : {Relation::AtMost, Relation::AtLeast, Relation::NotEqual}) {
      const ConnectOptions options{
          .name = "later::Service", .constraints = {{"latency", relation, limit}}, .timeout = 1ms};
      CHECK_THROWS_AS(scene.client->connect<LouderEcho>(options), Unavailable);
    }
  }
  for (const auto& description : extremes(rogue)) rogue.withdraw({description.provider});
  CHECK(scene.all([](auto& broker) { return broker.all().size() == 1; }));
  check_reachable(scene);
  CHECK(log.text().empty());
}

TEST_CASE_METHOD(
    LaterVersion,
    "a later version's description that cannot be taken is told once, and stops nobody", "[R25]") {
  for (std::uint32_t number = 1; number <= 3; ++number) {
    auto more = another(rogue, number, "more");  // than there may be of operations
    more.operations.resize(brokerless_discovery::kMaxOperations + number);
    rogue.write(more);
    CHECK(scene.all_refused(Refusal::Oversized, number));
  }
  // Not even the writer says that it is encoded otherwise.
  const auto grown = another(rogue, 4, "grown");
  Bytes message = idl::encode_message(grown);
  message.data()[1] = std::byte{9};
  rogue.write(message, {grown.provider});
  rogue.write(another(rogue, 5, "größe"));
  CHECK(scene.all_refused(Refusal::Malformed, 1));
  CHECK(scene.all_know(grown, false));
  // No vendor has topics of that name.
  auto reserved = rogue.describe(6, "aaa");
  reserved.bases.push_back(reserved.service);
  reserved.service = "DCPSEcho";
  rogue.write(reserved);
  CHECK(scene.all_refused(Refusal::Malformed, 2));
  CAPTURE(log.text());
  CHECK(log.count("refused a service description") == 2 * 2);  // each peer tells of each kind
  check_reachable(scene);
}

TEST_CASE("later versions whose descriptions cannot be heard are told of once, and stop nobody",
          "[R25]") {
  dds::Vendor& vendor = vendor_of_rogue();
  Scene scene;
  const Log log;
  dds::ParticipantOptions options;
  options.domain = 17;
  const auto participant = vendor.create_participant(options);
  std::vector<std::unique_ptr<dds::Writer>> writers;
  dds::Qos qos = description_qos();
  qos.representation = dds::DataRepresentation::Xcdr2;
  for (int i = 0; i < 3; ++i) {
    writers.push_back(participant->create_writer(description_topic(), qos));
  }
  CAPTURE(log.text());
  CHECK(eventually([&] { return log.count("the services of a peer stay unknown here") == 2; }));
  CHECK(log.count("the writer offers XCDR2, the reader requests XCDR1") == 2);
  check_reachable(scene);
}
