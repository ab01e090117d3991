// A mission while it is composed: the effect of each request on its text and on the page.
#include "command/compose/composer.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "core/system/whole_file.hpp"
#include "mission_text.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein;
using namespace skein::command;
using namespace skein::command::compose;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

const std::string kDictionary = R"(<dictionary>
  <parameter name="Rate" type="integer" unit="Hz" min="1" max="50">How often.</parameter>
</dictionary>)";

const std::string kPilot = R"(<component name="Pilot">
  <interfaces><implements><type>IDL:boat/IPilot</type>
    <required><parameter name="Rate"/></required></implements></interfaces>
  <dependencies><depends>IDL:boat/IWatcher</depends></dependencies>
  <subcomponents><subcomponent>IDL:boat/ICourse</subcomponent></subcomponents>
</component>)";

const std::string kWatcher = R"(<component name="Watcher">
  <interfaces><implements>IDL:boat/IWatcher</implements></interfaces>
</component>)";

const std::string kCareful = R"(<component name="CarefulCourse">
  <interfaces><implements>IDL:boat/ICourse</implements></interfaces>
</component>)";

std::string content(const std::filesystem::path& file) {
  return read_whole_file("the file", file, 1 << 20);
}

/// A folder with three components, and a mission that is composed there.
class Desk {
 public:
  Desk() {
    ::setenv("XDG_STATE_HOME", (folder.path() / "state").c_str(), 1);
    folder.write("dictionary.xml", kDictionary);
    folder.write("pilot.xml", kPilot);
    folder.write("watcher.xml", kWatcher);
    folder.write("careful.xml", kCareful);
    folder.write("other.xml",
                 "<mission name=\"other\" plugin=\"boats\"><peer name=\"p\" "
                 "component=\"pilot.xml\"/></mission>");
  }

  void open() {
    composer.reset();
    composer.emplace(Composer::Options{file, {folder.path()}},
                     [this](const auto& published) { json = published; });
  }

  DesignState state() const { return idl::from_json<DesignState>(*json); }

  std::string ask(const std::string& what, Json members = Json::object()) {
    members["do"] = what;
    if (!members.contains("version")) members["version"] = state().version;
    return composer->obey(members.dump());
  }

  std::string component(const std::string& name) const { return (folder.path() / name).string(); }

  void add(const std::string& name, Json members = Json::object()) {
    members["component"] = component(name);
    ask("add_entity", std::move(members));
  }

  std::int32_t element(const std::string& entity) const {
    const DesignState now = state();
    for (const PartState& part : now.parts)
      if (part.entity == entity && part.csp.empty()) return part.element;
    throw std::out_of_range(entity);
  }

  designer::EntityState entity(const std::string& name) const {
    const DesignState now = state();
    for (const auto& each : now.entities)
      if (each.name == name) return each;
    throw std::out_of_range(name);
  }

  std::vector<std::string> errors() const {
    std::vector<std::string> problems;
    const DesignState now = state();
    for (const FindingState& finding : now.findings)
      if (finding.severity == "error") problems.push_back(finding.problem);
    return problems;
  }

  TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "mission.xml";
  std::shared_ptr<const std::string> json;
  std::optional<Composer> composer;
};

}  // namespace

TEST_CASE("a mission that is not there yet begins empty, and is there once it is saved") {
  Desk desk;
  desk.open();
  CHECK(desk.state().changed);
  CHECK(desk.errors() == std::vector<std::string>{"the mission has no <peer>"});
  CHECK_FALSE(std::filesystem::exists(desk.file));
  desk.ask("save");
  CHECK(content(desk.file) ==
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<mission name=\"mission\">\n</mission>\n");
  CHECK_FALSE(desk.state().changed);
}

TEST_CASE(
    "a component has the plugin that the project of skein new builds, or that a mission names") {
  Desk desk;
  desk.folder.write("CMakeLists.txt",
                    "add_library(watcher_component MODULE watcher.cpp)\n"
                    "add_library(pilot MODULE pilot.cpp)\n");
  desk.folder.write("boat.idl", "");
  desk.folder.write("boat.dds.idl", "");
  desk.open();
  desk.add("watcher.xml");
  desk.add("pilot.xml");
  CHECK_THAT(desk.state().text, Contains("component=\"watcher.xml\" plugin=\"watcher_component\""));
  CHECK_THAT(desk.state().text, Contains("component=\"pilot.xml\" plugin=\"boats\""));
  CHECK(desk.composer->idl_folders() == std::vector{desk.folder.path()});
}

TEST_CASE("what an entity lacks is told until it is there") {
  Desk desk;
  desk.open();
  desk.add("pilot.xml");
  CHECK_THAT(desk.state().text,
             Contains("  <peer name=\"pilot\" component=\"pilot.xml\" plugin=\"boats\"/>\n"));
  CHECK(desk.errors().size() == 3);  // the watcher, a CSP, the rate
  CHECK(desk.entity("default/pilot").state == "incomplete");
  CHECK(desk.entity("default/pilot").services[1].state == "needed");
  CHECK(desk.entity("default/pilot").services[2].state == "slot");

  desk.add("watcher.xml");
  CHECK(desk.state().links.front().target == "default/watcher");
  desk.ask("add_csp", {{"element", desk.element("default/pilot")},
                       {"component", desk.component("careful.xml")}});
  CHECK(desk.errors().size() == 1);
  desk.ask("parameter",
           {{"element", desk.element("default/pilot")}, {"name", "Rate"}, {"value", "100"}});
  CHECK_THAT(desk.errors().at(0), Contains("100"));
  desk.ask("parameter",
           {{"element", desk.element("default/pilot")}, {"name", "Rate"}, {"value", "10"}});
  CHECK(desk.errors().empty());
  CHECK(desk.entity("default/pilot").state == "planned");
  CHECK_THAT(desk.state().text,
             Contains("    <csp component=\"careful.xml\" process=\"in\"/>\n"
                      "    <parameter name=\"Rate\" value=\"10\"/>\n  </peer>\n"));
}

TEST_CASE("a second entity of a component has another name, and stands where it is dropped") {
  Desk desk;
  desk.open();
  desk.add("watcher.xml");
  desk.add("watcher.xml", {{"x", 300}, {"y", 40}});
  CHECK(desk.entity("default/watcher_2").x == 300);
  CHECK(desk.entity("default/watcher_2").y == 40);
}

TEST_CASE("only a CSP that fits can be added") {
  Desk desk;
  desk.open();
  desk.add("pilot.xml");
  desk.add("watcher.xml");
  const auto add = [&](const std::string& entity, const std::string& csp) {
    return desk.ask("add_csp",
                    {{"element", desk.element(entity)}, {"component", desk.component(csp)}});
  };
  CHECK_THROWS_WITH(add("default/pilot", "watcher.xml"),
                    Contains("Watcher does not fit peer pilot, whose CSPs implement boat/ICourse"));
  CHECK_THROWS_WITH(add("default/watcher", "careful.xml"), Contains("which has no CSPs"));
  add("default/pilot", "careful.xml");
  add("default/pilot", "careful.xml");
  CHECK_THAT(desk.state().text, Contains("name=\"careful_course\" process=\"in\""));
}

TEST_CASE(
    "what the notation does not have is refused with a suggestion, and what is there can go") {
  Desk desk;
  desk.folder.write("mission.xml", "<mission name=\"m\"><peer nme=\"x\"/></mission>");
  desk.open();
  CHECK_THROWS_WITH(desk.ask("set", {{"element", 1}, {"attribute", "vendr"}, {"value", "x"}}),
                    Contains("did you mean 'vendor'?"));
  CHECK_THROWS_WITH(desk.ask("set", {{"element", 7}, {"attribute", "vendor"}, {"value", "x"}}),
                    Contains("no such element"));
  CHECK_THROWS_WITH(
      desk.ask("add", {{"element", 1}, {"child", "group"}, {"attributes", Json::object()}}),
      Contains("can stand in a peer"));
  CHECK_THROWS_WITH(desk.ask("add_entity", {{"component", "/etc/passwd"}}), Contains("is known"));
  desk.ask("set", {{"element", 1}, {"attribute", "nme"}, {"value", nullptr}});
  desk.ask("add", {{"element", 0}, {"child", "variable"}, {"attributes", {{"name", "v"}}}});
  CHECK(desk.state().text == "<mission name=\"m\"><peer/>\n  <variable name=\"v\"/>\n</mission>");
}

TEST_CASE("what is typed is undone at once, what is chosen one by one, and all is done again") {
  Desk desk;
  desk.folder.write("mission.xml", kMissionText);
  desk.open();
  const auto set = [&](const char* attribute, const char* value) {
    desk.ask("set", {{"element", 2}, {"attribute", attribute}, {"value", value}});
  };
  for (const char* typed : {"f", "fa", "fast", "fastdds"}) set("vendor", typed);
  set("host", "bow");
  const std::string last = desk.state().text;
  CHECK(desk.state().undo == "change host of peer pilot");
  desk.ask("undo");
  desk.ask("undo");
  CHECK(desk.state().text == kMissionText);
  CHECK_FALSE(desk.state().changed);
  CHECK_THROWS_WITH(desk.ask("undo"), Contains("nothing to undo"));
  desk.ask("redo");
  desk.ask("redo");
  CHECK(desk.state().text == last);
  CHECK(desk.state().redo.empty());
}

TEST_CASE("an edit that others have overtaken means the element that it meant") {
  Desk desk;
  desk.open();
  for (int i = 0; i < 3; ++i) desk.add("watcher.xml");
  const std::uint64_t version = desk.state().version;
  const auto rename = [&](int element, const char* name) {
    desk.ask("set",
             {{"element", element}, {"attribute", "name"}, {"value", name}, {"version", version}});
  };
  rename(1, "a longer name than it had");
  desk.ask("remove", {{"element", 2}, {"version", version}});
  rename(3, "third");
  CHECK(desk.state().entities.size() == 2);
  CHECK(desk.entity("default/third").name == "default/third");
  CHECK_THROWS_WITH(rename(2, "nobody"), Contains("the element is gone"));
  desk.ask("undo");
  desk.ask("undo");
  CHECK_THROWS_WITH(rename(2, "nobody"), Contains("the element is gone"));
  rename(1, "last");
  CHECK(desk.entity("default/last").name == "default/last");
  CHECK_THROWS_AS(desk.ask("text", {{"text", "<mission/>"}, {"version", version}}), Unavailable);
  CHECK_THROWS_WITH(rename(9, "nobody"), Contains("the element is gone"));
}

TEST_CASE("after another text, an edit of one of two alike elements never means the other") {
  Desk desk;
  desk.folder.write("mission.xml",
                    "<mission name=\"m\"><peer name=\"ab\"><argument value=\"1\"/></peer>"
                    "<peer name=\"ac\"><argument value=\"2\"/></peer></mission>");
  desk.open();
  const DesignState before = desk.state();
  const std::string first = "<peer name=\"ab\"><argument value=\"1\"/></peer>";
  std::string text = before.text;
  text.erase(text.find(first), first.size());
  desk.ask("text", {{"text", text}});
  for (const int element : {1, 2, 3}) {
    CAPTURE(element);
    CHECK_THROWS_WITH(desk.ask("remove", {{"element", element}, {"version", before.version}}),
                      Contains("gone, or another one"));
  }
  desk.ask("set",
           {{"element", 0}, {"attribute", "name"}, {"value", "n"}, {"version", before.version}});
  desk.ask("remove", {{"element", 4}, {"version", before.version}});
  CHECK(desk.state().text == R"(<mission name="n"><peer name="ac"></peer></mission>)");
}

TEST_CASE("what others write meanwhile is told, never overwritten unasked, and can be taken") {
  Desk desk;
  desk.folder.write("mission.xml", kMissionText);
  desk.open();
  desk.ask("set", {{"element", 0}, {"attribute", "name"}, {"value", "mine"}});
  const std::string theirs = "<mission name=\"theirs\"/>";
  desk.folder.write("mission.xml", theirs);
  desk.composer->look_at_disk();
  CHECK(desk.state().disk == "changed");
  CHECK_THROWS_WITH(desk.ask("save"), Contains("changed by somebody else"));
  CHECK(content(desk.file) == theirs);
  desk.ask("load");
  CHECK(desk.state().text == theirs);
  CHECK_FALSE(desk.state().changed);
  desk.ask("undo");
  CHECK_THAT(desk.state().text, Contains("name=\"mine\""));
  desk.folder.write("mission.xml", "<mission name=\"again\"/>");
  desk.ask("save", {{"over", true}});
  CHECK_THAT(content(desk.file), Contains("name=\"mine\""));
  std::filesystem::remove(desk.file);
  desk.composer->look_at_disk();
  CHECK(desk.state().disk == "gone");
  desk.ask("save");
  CHECK(std::filesystem::exists(desk.file));
}

TEST_CASE("where boxes stand is kept, and is no change of the mission") {
  Desk desk;
  desk.open();
  desk.add("watcher.xml");
  desk.ask("save");
  const std::string saved = content(desk.file);
  desk.ask("move", {{"entity", "default/watcher"}, {"x", 17}, {"y", -4}});
  CHECK_FALSE(desk.state().changed);
  desk.ask("set", {{"element", 1}, {"attribute", "name"}, {"value", "lookout"}});
  CHECK(desk.entity("default/lookout").x == 17);
  desk.ask("undo");
  CHECK(desk.entity("default/watcher").x == 17);
  desk.open();
  CHECK(desk.entity("default/watcher").x == 17);
  CHECK(desk.entity("default/watcher").y == -4);
  CHECK(content(desk.file) == saved);
}

TEST_CASE("while the text is no XML, boxes stay, and nothing else than the text changes") {
  Desk desk;
  desk.open();
  desk.add("watcher.xml");
  const std::string good = desk.state().text;
  desk.ask("text", {{"text", good + "<"}});
  CHECK(desk.entity("default/watcher").state == "planned");
  CHECK_THAT(desk.errors().at(0), Contains("malformed XML"));
  CHECK_THROWS_WITH(desk.ask("remove", {{"element", 1}}), Contains("no well-formed XML"));
  desk.ask("undo");
  CHECK(desk.state().text == good);
  CHECK(desk.element("default/watcher") == 1);
}

TEST_CASE("what was not saved is there again when the program ends, however it does") {
  Desk desk;
  desk.folder.write("mission.xml", kMissionText);
  desk.open();
  desk.ask("set", {{"element", 0}, {"attribute", "name"}, {"value", "mine"}});
  const std::string unsaved = desk.state().text;
  desk.open();
  CHECK(desk.state().text == unsaved);
  CHECK(desk.state().undo == "take up unsaved changes");
  CHECK_THAT(desk.state().troubles.at(0), Contains("unsaved changes of the last time"));
  desk.ask("save");
  desk.open();
  CHECK(desk.state().undo.empty());
}

TEST_CASE("what others have written since then is told, and kept") {
  Desk desk;
  desk.folder.write("mission.xml", kMissionText);
  desk.open();
  desk.ask("set", {{"element", 0}, {"attribute", "name"}, {"value", "mine"}});
  desk.composer.reset();
  desk.folder.write("mission.xml", "<mission name=\"theirs\"/>");
  desk.open();
  CHECK_THAT(desk.state().text, Contains("name=\"mine\""));
  CHECK(desk.state().disk == "changed");
  CHECK_THROWS_AS(desk.ask("save"), Unavailable);
  desk.ask("load");
  desk.open();
  CHECK(desk.state().text == "<mission name=\"theirs\"/>");
}

TEST_CASE("one at a time composes a mission") {
  Desk desk;
  desk.open();
  CHECK_THROWS_WITH(
      Composer(Composer::Options{desk.file, {desk.folder.path()}}, [](const auto&) {}),
      Contains("another `skein designer` composes"));
}

TEST_CASE("what is refused has changed nothing") {
  Desk desk;
  desk.folder.write("mission.xml", kMissionText);
  desk.open();
  const auto refuse = [&](const std::string& what, const Json& members) {
    CAPTURE(what, members.dump());
    CHECK_THROWS_AS(desk.ask(what, members), Error);
    CHECK(desk.state().text == kMissionText);
    desk.ask("look");
    CHECK(desk.state().text == kMissionText);
  };
  refuse("add_entity", {{"component", desk.component("watcher.xml")}, {"x", 1}});
  refuse("add_entity", {{"component", desk.component("watcher.xml")}, {"x", 1e9}, {"y", 1}});
  refuse("set", {{"element", 1.5}, {"attribute", "name"}, {"value", "x"}});
  refuse("set", {{"element", 1}, {"attribute", "name"}, {"value", "\xEF\xBF\xBF"}});
  refuse("set", {{"element", 1}, {"attribute", "default"}, {"value", std::string(9 << 20, 'x')}});
  refuse("text", {{"text", "x"}, {"version", 77}});
}

TEST_CASE("a file that becomes a pipe, or is nested without end, or is no UTF-8, harms nobody") {
  Desk desk;
  std::string deep;
  for (int i = 0; i < 200'000; ++i) deep += "<a>";
  for (int i = 0; i < 200'000; ++i) deep += "</a>";
  desk.folder.write("mission.xml", deep);
  desk.open();
  CHECK_FALSE(desk.errors().empty());
  desk.ask("text", {{"text", "<mission name=\"m\"/>"}});
  REQUIRE(std::filesystem::remove(desk.file));
  REQUIRE(::mkfifo(desk.file.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(desk.ask("save", {{"over", true}}), Contains("no regular file any more"));
  std::filesystem::remove(desk.file);
  desk.ask("save");
  desk.folder.write("mission.xml", "<!-- caf\xE9 --><mission name=\"m\"/>");
  desk.ask("load");
  CHECK_THROWS_WITH(desk.ask("text", {{"text", "<mission name=\"n\"/>"}}), Contains("UTF-8"));
}

TEST_CASE("what only this machine tells takes the place of the findings, for that text alone") {
  Desk desk;
  desk.open();
  desk.add("watcher.xml");
  const auto unchecked = desk.composer->unchecked();
  REQUIRE(unchecked);
  CHECK(content(unchecked->file) == desk.state().text);
  const profile::Finding missing{
      profile::Severity::Error, {desk.file.string(), 3, 3}, "there is no plugin 'boats'", ""};
  desk.composer->tell_check(unchecked->version, {{missing}});
  CHECK(desk.state().checked);
  CHECK(desk.entity("default/watcher").reason == "there is no plugin 'boats'");
  REQUIRE(desk.composer->unchecked());  // it may be built meanwhile
  desk.composer->tell_check(unchecked->version, {});
  CHECK(desk.errors().empty());
  CHECK_FALSE(desk.composer->unchecked());
  desk.ask("set", {{"element", 1}, {"attribute", "host"}, {"value", "bow"}});
  CHECK(desk.errors().empty());
  desk.composer->tell_check(unchecked->version, {});
  CHECK_FALSE(desk.state().checked);
  desk.composer->tell_check(desk.state().version, {{}, "it takes too long"});
  CHECK_FALSE(desk.state().checked);
  CHECK(desk.state().troubles == std::vector<std::string>{"it takes too long"});
  CHECK(desk.composer->unchecked());
  desk.folder.write("mission.xml", "<mission name=\"theirs\"/>");
  CHECK(content(desk.composer->unchecked()->file) == desk.state().text);
}

TEST_CASE("through another's name, and a text that is no mission, boxes keep their places") {
  Desk desk;
  desk.open();
  desk.add("watcher.xml", {{"x", 300}, {"y", 40}});
  desk.add("watcher.xml", {{"x", 500}, {"y", 80}});
  for (const char* name : {"watche", "watcher", "watchers"})
    desk.ask("set", {{"element", 2}, {"attribute", "name"}, {"value", name}});
  CHECK(desk.entity("default/watcher").x == 300);
  desk.ask("text", {{"text", "<mission"}});
  desk.open();
  desk.ask("look");
  desk.ask("text", {{"text",
                     "<mission name=\"m\" dictionary=\"dictionary.xml\"><peer name=\"watcher\" "
                     "component=\"watcher.xml\"/></mission>"}});
  CHECK(desk.entity("default/watcher").x == 300);
}

TEST_CASE("line ends of a file stay while its text is edited") {
  Desk desk;
  desk.folder.write("mission.xml", "<mission name=\"m\">\r\n</mission>\r\n");
  desk.open();
  desk.ask("text", {{"text", "<mission name=\"n\">\n</mission>\n"}});
  CHECK(desk.state().text == "<mission name=\"n\">\r\n</mission>\r\n");
}

TEST_CASE("an entity that is removed and comes back stands where it stood") {
  Desk desk;
  desk.open();
  desk.add("watcher.xml", {{"x", 300}, {"y", 40}});
  desk.ask("remove", {{"element", 1}});
  desk.ask("undo");
  CHECK(desk.entity("default/watcher").x == 300);
}

TEST_CASE("entities of a part of the profile are shown, and belong to another file") {
  Desk desk;
  desk.folder.write("part.xml", "<part><peer name=\"w\" component=\"watcher.xml\"/></part>");
  desk.folder.write("mission.xml", "<mission name=\"m\"><include file=\"part.xml\"/></mission>");
  desk.open();
  CHECK(desk.entity("default/w").state == "planned");
  CHECK(desk.element("default/w") == -1);
}

TEST_CASE("components that cannot be read say why, and are not added") {
  Desk desk;
  desk.folder.write("broken.xml", "<component name=\"Broken\"><interface/></component>");
  desk.open();
  const DesignState state = desk.state();
  const auto broken =
      std::ranges::find(state.components, desk.component("broken.xml"), &ComponentState::file);
  REQUIRE(broken != state.components.end());
  CHECK_THAT(broken->failure, Contains("<interface> is unknown"));
  CHECK_THROWS_AS(desk.add("broken.xml"), InvalidArgument);
}

TEST_CASE("what differs from another mission of these folders is told, also after further edits") {
  Desk desk;
  desk.folder.write("mission.xml", kMissionText);
  desk.open();
  const auto differences = [&] {
    std::vector<std::string> texts;
    const DesignState now = desk.state();
    for (const DifferenceState& each : now.differences)
      texts.push_back(each.kind + " " + each.entity + (each.whole ? " (whole): " : ": ") +
                      each.text);
    return texts;
  };
  desk.ask("compare", {{"with", desk.file.string()}});
  CHECK(differences().empty());
  desk.ask("set", {{"element", 2}, {"attribute", "restart"}, {"value", nullptr}});
  desk.ask("parameter",
           {{"element", desk.element("default/pilot")}, {"name", "Rate"}, {"value", "7"}});
  desk.ask("remove", {{"element", desk.element("default/watcher")}});
  desk.add("pilot.xml");
  CHECK(differences() ==
        std::vector<std::string>{
            "gone default/watcher (whole): peer watcher is gone",
            "gone default/pilot: pilot: restart is not given, was \"never\"",
            "changed default/pilot: pilot, parameter Rate: value is \"7\", was \"${rate}\"",
            "new default/pilot_2 (whole): peer pilot_2 is new"});
  desk.ask("compare", {{"with", nullptr}});
  CHECK(differences().empty());
  CHECK_THROWS_WITH(desk.ask("compare", {{"with", "../../etc/passwd"}}),
                    Contains("none of the folders that this page may read"));
  CHECK_THROWS_WITH(desk.ask("compare", {{"with", "nobody.xml"}}), Contains("nobody.xml"));
}

TEST_CASE("any edits, undone, done again and saved, leave the text that they should") {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    const auto any = [&](std::size_t below) { return static_cast<int>(random() % below); };
    Desk desk;
    desk.folder.write("mission.xml", kMissionText);
    desk.open();
    std::vector<std::string> texts{kMissionText};  // by step
    std::size_t now = 0;
    std::string saved = kMissionText;
    const auto edit = [&](const std::string& what, const Json& members) {
      const std::string before = desk.state().text;
      try {
        desk.ask(what, members);
      } catch (const InvalidArgument&) {  // that cannot be done there
        CHECK(desk.state().text == before);
        return;
      }
      const std::string after = desk.state().text;
      if (after == before) return;
      texts.resize(++now);
      texts.push_back(after);
    };
    for (int step = 0; step < 40; ++step) {
      const int elements = static_cast<int>(desk.state().elements.size());
      switch (any(9)) {
        case 0:
          desk.add("pilot.xml"), texts.resize(++now), texts.push_back(desk.state().text);
          break;
        case 1:
          edit("add_csp",
               {{"element", any(elements)}, {"component", desk.component("careful.xml")}});
          break;
        case 2:
          edit("remove", {{"element", any(elements)}});
          break;
        case 3:
          edit("add",
               {{"element", any(elements)}, {"child", "topic"}, {"attributes", {{"name", "a&b"}}}});
          break;
        case 4: {  // with another attribute between, so that none is one with the one before
          const std::string name = step % 2 == 0 ? "host" : "plugin";
          edit("set",
               {{"element", any(elements)}, {"attribute", name}, {"value", std::to_string(step)}});
          break;
        }
        case 5:
          edit("parameter",
               {{"element", any(elements)}, {"name", "P" + std::to_string(step)}, {"value", "1"}});
          break;
        case 6:
          if (now > 0) desk.ask("undo"), --now;
          break;
        case 7:
          if (now + 1 < texts.size()) desk.ask("redo"), ++now;
          break;
        default:
          desk.ask("save"), saved = texts[now];
      }
      REQUIRE(desk.state().text == texts[now]);
      REQUIRE(content(desk.file) == saved);
      CHECK(desk.state().changed == (texts[now] != saved));
    }
    while (now > 0) desk.ask("undo"), --now;
    CHECK(desk.state().text == kMissionText);
  }
}
