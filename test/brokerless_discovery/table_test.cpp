#include "brokerless_discovery/table.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "descriptions.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::brokerless_discovery;
using skein::test::description;
using skein::test::guid;

namespace {

const Guid kWriter = guid(200);
const Guid kOtherWriter = guid(201);
/// A writer of another participant.
const Guid kStranger = guid(200, *Guid::from_hex("0102030405060708090a0b0c00000000"));

Query query(const std::string& name) {
  Query query;
  query.name = name;
  query.system = "uav-1";
  query.asker = "uav-1/tester";
  return query;
}

std::vector<std::string> entities(const Table& table, const Query& query) {
  std::vector<std::string> names;
  for (const auto& found : table.find(query)) names.push_back(found->entity);
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("a description is found by its interface, its bases and its entity", "[R1]") {
  Table table;
  auto navigator = description(1, "A/INavigator", "navigator");
  navigator.bases = {"A/IService"};
  table.on_description(navigator, kWriter);
  CHECK(entities(table, query("A/INavigator")) == Names{"navigator"});
  CHECK(entities(table, query("A/IService")) == Names{"navigator"});
  CHECK(entities(table, query("navigator")) == Names{"navigator"});
  CHECK(entities(table, query("A/IOther")).empty());
}

TEST_CASE("what Skein provides beside an entity's own is not found by the entity's name", "[R1]") {
  Table table;
  table.on_description(description(1, "skein/launch/ILiveParameters", "navigator"), kWriter);
  CHECK(entities(table, query("navigator")).empty());
  CHECK(entities(table, query("skein/launch/ILiveParameters")) == Names{"navigator"});
}

TEST_CASE("all spellings of an interface's name are one", "[R2]") {
  Table table;
  table.on_description(description(1, "IDL:A/INavigator:1.0", "navigator"), kWriter);
  for (const char* spelling :
       {"IDL:A/INavigator", "A/INavigator", "A::INavigator", "IDL:A/INavigator:1.0"}) {
    CAPTURE(spelling);
    CHECK(entities(table, query(spelling)) == Names{"navigator"});
  }
}

TEST_CASE("an interface's last part is enough where it is unambiguous", "[R3]") {
  Table table;
  table.on_description(description(1, "A/IPlanner", "one"), kWriter);
  CHECK(entities(table, query("IPlanner")) == Names{"one"});

  table.on_description(description(2, "B/IPlanner", "two"), kWriter);
  CHECK_THROWS_WITH(table.find(query("IPlanner")), Catch::Contains("ambiguous") &&
                                                       Catch::Contains("A/IPlanner") &&
                                                       Catch::Contains("B/IPlanner"));
  CHECK(entities(table, query("B/IPlanner")) == Names{"two"});

  table.on_withdrawn(guid(1), kWriter);
  CHECK(entities(table, query("IPlanner")) == Names{"two"});
}

TEST_CASE("a later description of the same provider replaces the earlier one", "[R4]") {
  Table table;
  CHECK(table.on_description(description(1, "A/I", "old"), kWriter).at(0).kind ==
        Change::Kind::Added);
  CHECK(table.on_description(description(1, "A/I", "new"), kWriter).at(0).kind ==
        Change::Kind::Updated);
  CHECK(entities(table, query("A/I")) == Names{"new"});
  CHECK(table.find(query("old")).empty());
  CHECK(table.on_description(description(1, "A/I", "new"), kWriter).empty());
}

TEST_CASE("a look-up stays in its own system unless told otherwise", "[R5]") {
  Table table;
  auto other = description(1, "A/I", "far");
  other.system = "uav-2";
  table.on_description(other, kWriter);
  table.on_description(description(2, "A/I", "near"), kWriter);
  CHECK(entities(table, query("A/I")) == Names{"near"});
  Query there = query("A/I");
  there.system = "uav-2";
  CHECK(entities(table, there) == Names{"far"});
  there.system = std::nullopt;
  CHECK(entities(table, there) == Names{"far", "near"});
}

TEST_CASE("a managed service is found by its owner and by nobody else", "[R6]") {
  Table table;
  auto csp = description(1, "A/IPlanner", "AStar");
  csp.owner = "uav-1/navigator";
  table.on_description(csp, kWriter);
  CHECK(entities(table, query("A/IPlanner")).empty());
  CHECK_THAT(table.explain(query("A/IPlanner")), Catch::Contains("managed by uav-1/navigator"));
  Query owner = query("A/IPlanner");
  owner.asker = "uav-1/navigator";
  CHECK(entities(table, owner) == Names{"AStar"});
}

TEST_CASE("a stranger is told whose a managed interface is even without its description",
          "[R6][R9]") {
  Table table;
  auto navigator = description(1, "A/INavigator", "navigator");
  navigator.subcomponents = {"IDL:A/IPlanner"};
  table.on_description(navigator, kWriter);
  CHECK_THAT(
      table.explain(query("A/IPlanner")),
      Catch::Contains("managed interface of navigator") && Catch::Contains("only that entity"));
  CHECK_THAT(table.explain(query("IPlanner")), Catch::Contains("managed interface of navigator"));
  Query owner = query("IPlanner");
  owner.asker = "uav-1/navigator";
  CHECK_THAT(table.explain(owner), Catch::EndsWith("of this entity, of which no CSP is there"));
}

TEST_CASE("a provider that lacks one of the client's operations is not offered", "[R7]") {
  const OperationInfo wanted[] = {
      {"plan", 11, 1000, false, false, false, nullptr, nullptr, {}, ""}};
  const InterfaceInfo client{"A/IPlanner", {}, wanted, ""};
  Query asked = query("A/IPlanner");
  asked.client = &client;
  Table table;
  auto provider = description(1, "A/IPlanner", "planner");

  SECTION("no such operation") {}
  SECTION("another signature") { provider.operations = {{"plan", 11, 1001}}; }
  table.on_description(provider, kWriter);
  CHECK(entities(table, asked).empty());
  CHECK_THAT(table.explain(asked), Catch::Contains("another version") && Catch::Contains("'plan'"));

  provider.operations = {{"plan", 11, 1000}, {"newer", 12, 7}};
  table.on_description(provider, kWriter);
  CHECK(entities(table, asked) == Names{"planner"});
}

TEST_CASE("a provider may lack an @optional operation, and may not have another one of its name",
          "[R7]") {
  const OperationInfo wanted[] = {
      {"plan", 11, 1000, false, false, false, nullptr, nullptr, {}, ""},
      {"improve", 12, 2000, false, false, false, nullptr, nullptr, {}, "", true}};
  const InterfaceInfo client{"A/IPlanner", {}, wanted, ""};
  Query asked = query("A/IPlanner");
  asked.client = &client;
  Table table;
  auto provider = description(1, "A/IPlanner", "planner");
  provider.operations = {{"plan", 11, 1000}};
  table.on_description(provider, kWriter);
  CHECK(entities(table, asked) == Names{"planner"});

  provider.operations = {{"plan", 11, 1000}, {"improve", 12, 2001}};
  table.on_description(provider, kWriter);
  CHECK(entities(table, asked).empty());
  CHECK_THAT(table.explain(asked), Catch::Contains("operation 'improve' has another signature"));
}

TEST_CASE("types that may grow may differ by what has grown, and by nothing else", "[R7]") {
  constexpr std::uint32_t kProblem = 5;
  const OperationInfo wanted[] = {
      {"plan", 11, 1000, false, false, false, nullptr, nullptr, {}, ""}};
  const GrowingMember known[] = {{kProblem, 0, 70, false, "A::Problem.goal"},
                                 {kProblem, 1, 71, false, "A::Problem.speed"}};
  const InterfaceInfo client{"A/IPlanner", {}, wanted, "", known};
  Query asked = query("A/IPlanner");
  asked.client = &client;
  auto provider = description(1, "A/IPlanner", "planner");
  provider.operations = {{"plan", 11, 1000}};
  Table table;
  const auto explained = [&](std::vector<discovery::GrowingMember> growing) {
    provider.growing = std::move(growing);
    table.on_description(provider, kWriter);
    return entities(table, asked).empty() ? table.explain(asked) : "found";
  };

  CHECK(explained({{kProblem, 0, 70, false}, {kProblem, 1, 71, false}}) == "found");
  CHECK(explained({{kProblem, 0, 70, false}}) == "found");
  CHECK(explained({{kProblem, 2, 72, false}, {kProblem, 1, 71, false}, {kProblem, 0, 70, false}}) ==
        "found");
  CHECK(explained({{kProblem + 1, 0, 9, true}}) == "found");  // of a type that is not known here
  CHECK_THAT(explained({{kProblem, 0, 70, false}, {kProblem, 1, 72, false}}),
             Catch::Contains("the member A::Problem.speed has another name or type there "
                             "(00000048, here 00000047)"));
  CHECK_THAT(explained({{kProblem, 0, 70, false}, {kProblem, 7, 72, true}}),
             Catch::Contains("a member of A::Problem that must be understood there is not known"));
}

TEST_CASE("what is found comes by entity, then by provider, in whatever order it came", "[R8]") {
  Table table;
  table.on_description(description(3, "A/I", "b"), kWriter);
  table.on_description(description(2, "A/I", "c"), kWriter);
  table.on_description(description(9, "A/I", "a"), kWriter);
  table.on_description(description(1, "A/I", "b"), kWriter);
  CHECK(entities(table, query("A/I")) == Names{"a", "b", "b", "c"});
  CHECK(Guid{table.find(query("A/I")).at(1)->provider} == guid(1));
}

TEST_CASE("where nothing is found the reason is given", "[R9]") {
  Table table;
  table.on_description(description(1, "A/INavigator", "navigator"), kWriter);

  CHECK_THAT(table.explain(query("A/INavigater")),
             Catch::Contains("nothing of that name") && Catch::Contains("INavigator"));
  CHECK_THAT(table.explain(query("navigater")), Catch::Contains("did you mean 'navigator'"));
  table.on_description(description(2, "A/ILift", "hoist"), kWriter);
  CHECK_THAT(table.explain(query("ILfit")), Catch::Contains("did you mean 'ILift'"));

  Query elsewhere = query("A/INavigator");
  elsewhere.system = "uav-7";
  CHECK_THAT(table.explain(elsewhere), Catch::Contains("only navigator (uav-1) offers it"));

  table.on_writer_alive(kWriter, false);
  CHECK_THAT(table.explain(query("A/INavigator")), Catch::Contains("has not been heard of"));
}

TEST_CASE("an entity of the wanted name with another interface is said to offer that", "[R7][R9]") {
  const OperationInfo wanted[] = {
      {"plan", 11, 1000, false, false, false, nullptr, nullptr, {}, ""}};
  const InterfaceInfo client{"A/IPlanner", {}, wanted, ""};
  Query asked = query("navigator");
  asked.client = &client;
  Table table;
  table.on_description(description(1, "A/INavigator", "navigator"), kWriter);
  CHECK_THAT(table.explain(asked),
             Catch::Contains("navigator (uav-1) offers A::INavigator, not A::IPlanner"));
}

TEST_CASE("a withdrawn description goes at once", "[R10]") {
  Table table;
  table.on_description(description(1, "A/I", "one"), kWriter);
  const auto changes = table.on_withdrawn(guid(1), kWriter);
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].kind == Change::Kind::Removed);
  CHECK(changes[0].departure == Departure::Left);
  CHECK(table.find(query("A/I")).empty());
  CHECK(table.on_withdrawn(guid(1), kWriter).empty());
}

TEST_CASE("a provider whose lease expired is kept but not offered", "[R11]") {
  Table table;
  table.on_description(description(1, "A/I", "one"), kWriter);
  table.on_description(description(2, "A/I", "two"), kOtherWriter);
  CHECK(table.on_writer_alive(kWriter, false).at(0).kind == Change::Kind::Suspect);
  CHECK(entities(table, query("A/I")) == Names{"two"});
  CHECK(table.all().size() == 2);
  CHECK(table.on_writer_alive(kWriter, false).empty());
}

TEST_CASE("a provider that is about to leave is kept but not offered, and look-ups say why",
          "[R28]") {
  Table table;
  auto leaving = description(1, "A/I", "one");
  leaving.attributes = {{"latency", "3"}};
  table.on_description(leaving, kWriter);
  mark_leaving(leaving);
  const auto changes = table.on_description(leaving, kWriter);
  CHECK(changes.at(0).kind == Change::Kind::Updated);
  CHECK(is_leaving(*changes.at(0).description));
  CHECK(table.is_leaving(guid(1)));
  CHECK(table.find(query("A/I")).empty());
  CHECK_THAT(table.explain(query("A/I")), Catch::Contains("one (uav-1) is about to leave"));
  CHECK(table.all().size() == 1);
  SECTION("until it says otherwise") {
    table.on_description(description(1, "A/I", "one"), kWriter);
    CHECK(entities(table, query("A/I")) == Names{"one"});
  }
}

TEST_CASE("a provider of another wire is kept but not offered, and look-ups say why", "[R30]") {
  Table table;
  auto later = description(1, "A/I", "later");
  later.attributes = {{"skein:wire", "7"}};
  table.on_description(later, kWriter);
  CHECK(table.all().size() == 1);
  CHECK(table.find(query("A/I")).empty());
  CHECK_THAT(table.explain(query("A/I")),
             Catch::Contains("later (uav-1) runs a version of Skein whose wire is number 7") &&
                 Catch::Contains("here it is number 1"));
  SECTION("a provider beside it that gives the same number, or none, is offered") {
    auto same = description(2, "A/I", "same");
    same.attributes = {{"skein:wire", std::string(kWire)}};
    table.on_description(same, kWriter);
    table.on_description(description(3, "A/I", "silent"), kWriter);
    CHECK(entities(table, query("A/I")) == Names{"same", "silent"});
  }
  SECTION("until it gives the same number") {
    later.attributes = {{"skein:wire", std::string(kWire)}};
    table.on_description(later, kWriter);
    CHECK(entities(table, query("A/I")) == Names{"later"});
  }
}

TEST_CASE("a suspect provider that is heard of again is offered again", "[R12]") {
  Table table;
  table.on_description(description(1, "A/I", "one"), kWriter);
  table.on_writer_alive(kWriter, false);
  SECTION("its writer is alive again") {
    CHECK(table.on_writer_alive(kWriter, true).at(0).kind == Change::Kind::Trusted);
  }
  SECTION("it describes itself again") {
    CHECK(table.on_description(description(1, "A/I", "one"), kWriter).at(0).kind ==
          Change::Kind::Trusted);
  }
  CHECK(entities(table, query("A/I")) == Names{"one"});
}

TEST_CASE("when a writer is gone for good so are its descriptions", "[R13]") {
  Table table;
  table.on_description(description(1, "A/I", "one"), kWriter);
  table.on_description(description(2, "A/J", "one"), kWriter);
  table.on_description(description(3, "A/I", "two"), kOtherWriter);
  const auto changes = table.on_writer_gone(kWriter);
  REQUIRE(changes.size() == 2);
  CHECK(changes[0].departure == Departure::Lost);
  CHECK(entities(table, query("A/I")) == Names{"two"});
}

TEST_CASE("when a process has ended so have all its descriptions", "[R14]") {
  Table table;
  table.on_description(description(1, "A/I", "one"), kWriter);
  table.on_description(description(2, "A/I", "two"), kOtherWriter);
  const auto changes = table.on_process_ended("skein/process-of-one");
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].departure == Departure::Died);
  CHECK(entities(table, query("A/I")) == Names{"two"});
}

TEST_CASE("a description that arrives after its process's death is not believed", "[R15]") {
  Table table;
  table.on_process_ended("skein/process-of-one");
  CHECK(table.on_description(description(1, "A/I", "one"), kWriter).empty());
  CHECK(table.all().empty());
}

TEST_CASE("a description with a malformed interface name is refused") {
  Table table;
  CHECK_THROWS_AS(table.on_description(description(1, "A//I", "one"), kWriter), InvalidArgument);
  CHECK(table.all().empty());
}

TEST_CASE("a provider is offered only if its attributes meet all constraints", "[R18]") {
  Table table;
  auto slow = description(1, "A/I", "slow");
  slow.attributes = {{"latency", "1000"}, {"quality", "1.0"}, {"reach", "2 min"}, {"kind", "grid"}};
  table.on_description(slow, kWriter);
  auto fast = description(2, "A/I", "fast");
  fast.attributes = {{"latency", "90"}, {"quality", "0.5"}, {"reach", "30 s"}, {"kind", "tree"}};
  table.on_description(fast, kWriter);
  table.on_description(description(3, "A/I", "plain"), kWriter);

  const auto with = [&](std::vector<Constraint> constraints) {
    Query asked = query("A/I");
    asked.constraints = std::move(constraints);
    return entities(table, asked);
  };
  CHECK(with({{"latency", Relation::AtMost, "300"}}) == Names{"fast"});
  CHECK(with({{"latency", Relation::AtLeast, "90.0"}}) == Names{"fast", "slow"});
  CHECK(with({{"quality", Relation::Equal, "1"}}) == Names{"slow"});
  CHECK(with({{"kind", Relation::Equal, "tree"}}) == Names{"fast"});
  CHECK(with({{"kind", Relation::NotEqual, "tree"}}) == Names{"slow"});
  CHECK(with({{"reach", Relation::AtMost, "1 min"}}) == Names{"fast"});
  CHECK(with({{"latency", Relation::AtMost, "2000"}, {"quality", Relation::AtLeast, "0.9"}}) ==
        Names{"slow"});
}

TEST_CASE("numbers do not compare with lengths of time, nor words by order", "[R18]") {
  Table table;
  auto provider = description(1, "A/I", "one");
  provider.attributes = {{"latency", "100 ms"}, {"kind", "grid"}};
  table.on_description(provider, kWriter);
  Query asked = query("A/I");
  asked.constraints = {{"latency", Relation::AtMost, "300"}};
  CHECK(table.find(asked).empty());
  asked.constraints = {{"latency", Relation::AtMost, "0.3 s"}};
  CHECK(table.find(asked).size() == 1);
  asked.constraints = {{"kind", Relation::AtMost, "300"}};
  CHECK(table.find(asked).empty());
  asked.constraints = {{"latency", Relation::AtMost, "fast"}};
  CHECK_THROWS_WITH(table.find(asked), Catch::Contains("'fast' is no number"));
}

TEST_CASE("for each provider that was passed over the reason is given", "[R9][R18]") {
  Table table;
  auto slow = description(1, "A/I", "slow");
  slow.attributes = {{"latency", "1000"}};
  table.on_description(slow, kWriter);
  table.on_description(description(2, "A/I", "plain"), kWriter);
  table.on_description(description(3, "A/I", "silent"), kOtherWriter);
  table.on_writer_alive(kOtherWriter, false);
  Query asked = query("A/I");
  asked.constraints = {{"latency", Relation::AtMost, "300"}};
  CHECK_THAT(
      table.explain(asked),
      Catch::Contains(
          "plain (uav-1) does not suit: it declares no latency, which must be at most 300") &&
          Catch::Contains("slow (uav-1) does not suit: its latency is 1000, not at most 300") &&
          Catch::Contains("silent (uav-1) has not been heard of"));
}

TEST_CASE("providers on the preferred host come first, others follow", "[R19]") {
  Table table;
  for (const auto& [number, entity, host] :
       {std::tuple{1, "a", "far"}, {2, "b", "near"}, {3, "c", "far"}, {4, "d", "near"}}) {
    auto provider = description(static_cast<std::uint8_t>(number), "A/I", entity);
    provider.host = host;
    table.on_description(provider, kWriter);
  }
  Query asked = query("A/I");
  asked.preferred_host = "near";
  CHECK(entities(table, asked) == Names{"b", "d", "a", "c"});
  asked.preferred_host = "nowhere";
  CHECK(entities(table, asked) == Names{"a", "b", "c", "d"});
}

namespace {

/// Whether the table refuses an event, for that reason.
template <class Event>
bool refused(Refusal why, Event event) {
  try {
    event();
  } catch (const Refused& refusal) {
    return refusal.why == why;
  }
  return false;
}

}  // namespace

TEST_CASE("who is no part of a provider's participant neither describes nor withdraws it",
          "[R23]") {
  Table table;
  const auto forged = description(1, "A/I", "forged");

  CHECK(refused(Refusal::Forged, [&] { table.on_description(forged, kStranger); }));
  CHECK(table.all().empty());  // the first to claim it gains nothing

  table.on_description(description(1, "A/I", "one"), kWriter);
  CHECK(refused(Refusal::Forged, [&] { table.on_description(forged, kStranger); }));
  CHECK(refused(Refusal::Forged, [&] { table.on_withdrawn(guid(1), kStranger); }));
  CHECK(table.on_writer_gone(kStranger).empty());
  CHECK(table.on_writer_alive(kStranger, false).empty());
  CHECK(entities(table, query("A/I")) == Names{"one"});
}

TEST_CASE("a participant's new writer takes over what its earlier one described", "[R13][R23]") {
  Table table;
  table.on_description(description(1, "A/I", "one"), kWriter);
  table.on_description(description(1, "A/I", "one"), kOtherWriter);
  CHECK(table.on_writer_gone(kWriter).empty());
  CHECK(entities(table, query("A/I")) == Names{"one"});
  CHECK(table.on_writer_gone(kOtherWriter).size() == 1);
}

TEST_CASE("a peer knows its own services by itself, and notes what others are told otherwise",
          "[R24]") {
  const Guid itself;
  Table table;
  table.on_description(description(1, "A/I", "own"), itself);

  CHECK(table.on_description(description(1, "A/I", "own"), kWriter).empty());
  CHECK(table.take_contradicted().empty());

  SECTION("withdrawn") { CHECK(table.on_withdrawn(guid(1), kWriter).empty()); }
  SECTION("described otherwise") {
    CHECK(table.on_description(description(1, "A/I", "other"), kWriter).empty());
  }
  CHECK(entities(table, query("A/I")) == Names{"own"});
  CHECK(table.take_contradicted() == std::set<Guid>{guid(1)});
  CHECK(table.take_contradicted().empty());
  CHECK(table.on_withdrawn(guid(1), itself).size() == 1);
}

TEST_CASE("what no participant may say of a service is refused with the reason", "[R25]") {
  const Guid participant = guid(0);
  const auto good = description(1, "A/I", "one");
  auto bad = good;
  bad.process = "";
  CHECK_NOTHROW(check_description(bad, participant));
  const auto refuses = [&](Refusal why) {
    return refused(why, [&] { check_description(bad, participant); });
  };
  SECTION("another's provider") {
    bad.provider = guid(1, kStranger).bytes;
    CHECK(refuses(Refusal::Forged));
  }
  SECTION("another's process") {
    bad.process = "skein/" + kStranger.hex();
    CHECK(refuses(Refusal::Forged));
  }
  SECTION("what is no process's address") {
    bad.process = "/run/dbus/system_bus_socket";
    CHECK(refuses(Refusal::Forged));
  }
  SECTION("a name that is none") {
    bad.entity = GENERATE("", "two words", "\x1b[2J", "a/b", "*");
    CHECK(refuses(Refusal::Malformed));
  }
  SECTION("a system that is none") {
    bad.system = "uav 1";
    CHECK(refuses(Refusal::Malformed));
  }
  SECTION("an owner that is none") {
    bad.owner = GENERATE("navigator", "uav-1/", "/navigator", "uav-1/navi*");
    CHECK(refuses(Refusal::Malformed));
  }
  SECTION("an interface of which there can be no topics") {
    bad.service = GENERATE("DCPSPublication", "IDL:DCPS/I:1.0");
    CHECK(refuses(Refusal::Malformed));
  }
  SECTION("control characters") {
    const std::string control = GENERATE("\x1b[31m", "\n", "\x7f", "\xc2\x9b");
    switch (GENERATE(0, 1, 2, 3, 4)) {
      case 0:
        bad.host = "here" + control;
        break;
      case 1:
        bad.vendor = control;
        break;
      case 2:
        bad.attributes = {{"kind", control}};
        break;
      case 3:
        bad.attributes = {{control, "kind"}};
        break;
      case 4:
        bad.operations = {{control, 1, 2}};
        break;
    }
    CHECK(refuses(Refusal::Malformed));
  }
  SECTION("a name of a megabyte") {
    bad.entity = std::string(1 << 20, 'a');
    CHECK(refuses(Refusal::Oversized));
  }
  SECTION("too many bases") {
    bad.bases.assign(kMaxBases + 1, "A/IBase");
    CHECK(refuses(Refusal::Oversized));
  }
  SECTION("too many operations") {
    bad.operations.resize(kMaxOperations + 1);
    CHECK(refuses(Refusal::Oversized));
  }
  SECTION("too many attributes") {
    bad.attributes.resize(kMaxAttributes + 1);
    CHECK(refuses(Refusal::Oversized));
  }
  SECTION("too much XML") {
    bad.component.assign(kMaxDescriptionBytes + 1, ' ');
    CHECK(refuses(Refusal::Oversized));
  }
}

TEST_CASE("a description may hold what people write", "[R25]") {
  auto good = description(1, "A/I", "one");
  good.process = "";
  good.component = "<component>\r\n\t<note>Größe</note>\n</component>";
  good.attributes = {{"note", "schnell, für kurze Wege"}};
  CHECK_NOTHROW(check_description(good, guid(0)));
}

namespace {

/// The n-th provider of a participant.
Guid numbered(std::size_t number, Guid participant = {}) {
  for (std::size_t i = 0; i < 4; ++i) {
    participant.bytes[12 + i] = static_cast<std::uint8_t>(number >> 8 * i);
  }
  return participant;
}

/// How many descriptions by a writer the table takes before it refuses the first.
std::size_t fill(Table& table, const Guid& writer, const std::string& xml = {}) {
  for (std::size_t count = 0;; ++count) {
    auto one = description(1, "A/I" + std::to_string(count), "one");
    one.provider = numbered(count, writer.participant()).bytes;
    one.component = xml;
    if (refused(Refusal::NoRoom, [&] { table.on_description(one, writer); })) return count;
  }
}

}  // namespace

TEST_CASE("a participant has room for so many descriptions, and what goes makes room", "[R26]") {
  Table table;
  CHECK(fill(table, kWriter) == Room::kEntriesOfOne);
  CHECK_FALSE(table.take_room_again());

  auto other = description(1, "B/I", "other");
  other.provider = guid(1, kStranger).bytes;
  table.on_description(other, kStranger);
  CHECK(entities(table, query("B/I")) == Names{"other"});

  table.on_withdrawn(numbered(7), kWriter);
  CHECK(table.take_room_again());
  CHECK_FALSE(table.take_room_again());
  auto last = description(1, "C/I", "last");
  last.provider = numbered(5000).bytes;
  CHECK_NOTHROW(table.on_description(last, kWriter));
}

TEST_CASE("a participant has room for so many bytes", "[R26]") {
  Table table;
  const std::string xml(kMaxDescriptionBytes, ' ');
  const std::size_t count = fill(table, kWriter, xml);
  CHECK(count < Room::kEntriesOfOne);
  CHECK(count * xml.size() <= Room::kBytesOfOne);
}

TEST_CASE("a full table changes what it has", "[R4][R26]") {
  Table table;
  fill(table, kWriter);
  auto changed = description(1, "A/I0", "changed");
  changed.provider = numbered(0).bytes;
  CHECK_NOTHROW(table.on_description(changed, kWriter));
  CHECK(entities(table, query("A/I0")) == Names{"changed"});
  CHECK(table.all().size() == Room::kEntriesOfOne);
}

TEST_CASE("all participants together have room for so many descriptions, and this peer for its own",
          "[R26]") {
  Table table;
  std::size_t count = 0;
  for (std::uint8_t number = 1; number <= 20; ++number) {
    Guid participant;
    participant.bytes[0] = number;
    count += fill(table, participant);
  }
  CHECK(count == Room::kEntriesOfAll);
  CHECK_NOTHROW(table.on_description(description(1, "B/I", "own"), Guid{}));
  CHECK(entities(table, query("B/I")) == Names{"own"});
  Guid first;
  first.bytes[0] = 1;
  CHECK(table.on_writer_gone(first).size() == Room::kEntriesOfOne);
  CHECK(table.take_room_again());
}

TEST_CASE("so many processes that have ended are remembered, the oldest are forgotten first",
          "[R15][R27]") {
  Table table;
  for (std::size_t i = 0; i <= Table::kMaxEnded; ++i) {
    table.on_process_ended("skein/process-of-" + std::to_string(i));
  }
  CHECK(table.on_description(description(1, "A/I", "1"), kWriter).empty());
  CHECK(table.on_description(description(2, "A/I", "0"), kWriter).size() == 1);
}

namespace {

/// Descriptions and queries by chance, out of few words, so that they often have something in
/// common.
class Lottery {
 public:
  discovery::ServiceDescription draw_description(std::uint8_t number) {
    auto drawn = description(number, "A/I", draw({"a", "b", "c"}));
    drawn.system = draw({"uav-1", "uav-2"});
    drawn.owner = draw({"", "", "", "uav-1/tester", "uav-1/other"});
    for (const char* name : {"latency", "kind", "latency"}) {
      if (chance(3) > 0) drawn.attributes.push_back({name, draw_value()});
    }
    return drawn;
  }

  Query draw_query() {
    Query drawn = query("A/I");
    if (chance(2) == 0) drawn.system = std::nullopt;
    if (chance(8) == 0) drawn.provider = guid(static_cast<std::uint8_t>(chance(60)));
    for (std::size_t count = chance(3); count > 0; --count) {
      const auto relation = static_cast<Relation>(chance(4));
      const bool order = relation == Relation::AtMost || relation == Relation::AtLeast;
      drawn.constraints.push_back({draw({"latency", "kind", "colour"}), relation,
                                   order ? draw({"1", "2", "2 s", "-inf"}) : draw_value()});
    }
    return drawn;
  }

  std::size_t chance(std::size_t count) { return random_() % count; }

 private:
  std::string draw(std::vector<std::string> from) { return from[chance(from.size())]; }
  std::string draw_value() {
    return draw({"1", "1.0", "2", "3", "-0", "0", "inf", "nan", "1 s", "1000 ms", "2 min", "grid",
                 "tree", ""});
  }

  std::minstd_rand random_{7};
};

}  // namespace

TEST_CASE("constraints find what a look at each description would find", "[R5][R8][R18]") {
  Lottery lottery;
  Table table;
  for (int round = 0; round < 2000; ++round) {
    const auto number = static_cast<std::uint8_t>(lottery.chance(60));
    if (lottery.chance(4) == 0) {
      table.on_withdrawn(guid(number), kWriter);
    } else {
      table.on_description(lottery.draw_description(number), kWriter);
    }
    const Query asked = lottery.draw_query();
    Table::Found expected = table.all();
    std::erase_if(expected, [&](const auto& provider) {
      return (asked.system && *asked.system != provider->system) ||
             (!provider->owner.empty() && provider->owner != asked.asker) ||
             (!asked.provider.is_nil() && asked.provider.bytes != provider->provider) ||
             !std::all_of(
                 asked.constraints.begin(), asked.constraints.end(),
                 [&](const Constraint& constraint) { return meets(*provider, constraint); });
    });
    std::stable_sort(expected.begin(), expected.end(),
                     [](const auto& a, const auto& b) { return a->entity < b->entity; });
    REQUIRE(table.find(asked) == expected);
  }
}

TEST_CASE("what is known in another system alone is not taken for the short name of something else",
          "[R3][R5]") {
  Table table;
  auto far = description(1, "B/IOther", "IPlanner");
  far.system = "uav-2";
  table.on_description(far, kWriter);
  table.on_description(description(2, "A/IPlanner", "near"), kWriter);
  CHECK(entities(table, query("IPlanner")).empty());
}
