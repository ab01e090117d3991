// What people do wrong in profiles, components and plugins that can all be read: the message is the
// one that they need, nothing is started, and the exit code says that the configuration is wrong.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>

#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/places.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::test;
using Catch::Contains;

namespace fs = std::filesystem;

namespace {

const std::string kPlugin = "skein_broken_components";

/// A folder with a dictionary and the plugin's components, as they should be.
class Town {
 public:
  Town() {
    write("dictionary.xml", R"(<dictionary>
<attribute name="latency" type="duration" unit="ms" min="0" max="60000">How long a call takes.</attribute>
<attribute name="isolated" type="boolean">Whether it needs a process of its own.</attribute>
<parameter name="Speed" type="real" unit="m/s" min="1" max="100">How fast.</parameter>
<parameter name="Patience" type="duration" unit="ms" min="1">How long to wait.</parameter>
<parameter name="Route" type="text">The way through the town.</parameter>
</dictionary>)");
    component("office", "<type>crew/Desk</type>");
    component("quiet", "<type>crew/Desk</type>");
    component("clerk", "<type>crew/Desk</type>");
    component("herald", "");
    component("client", "");
  }

  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }

  /// `inner`: of <implements>; empty for a component that implements nothing.
  void component(const std::string& name, const std::string& inner) const {
    write(name + ".xml",
          "<component name=\"" + name + "\">" +
              (inner.empty() ? ""
                             : "<interfaces><implements>" + inner + "</implements></interfaces>") +
              "</component>");
  }

  std::string profile(const std::string& peers) const {
    return folder_
        .write("town.xml", "<mission name=\"town\" domain=\"54\" plugin=\"" + kPlugin + "\">\n" +
                               peers + "</mission>\n")
        .string();
  }

  /// A copy of the plugin, in a folder of its own.
  fs::path copy_of_plugin() const {
    const fs::path copy = folder_.path() / "plugins" / ("lib" + kPlugin + ".so");
    fs::create_directories(copy.parent_path());
    fs::copy_file(built_library("lib" + kPlugin + ".so"), copy);
    return copy;
  }

  const fs::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

struct Broken {
  std::string what;
  std::string peers;
  std::string message;
  std::map<std::string, std::string> files = {};
  std::string plugin_breaks = {};
};

const std::string kOffice = "<peer name=\"office\" component=\"office.xml\"/>\n";

std::string component(const std::string& content) {
  return "<component name=\"office\">\n" + content + "</component>";
}

const std::string kManager =
    "<component name=\"office\"><interfaces><implements>crew/Desk</implements></interfaces>"
    "<subcomponents><subcomponent>crew/Worker</subcomponent></subcomponents></component>";

/// A CSP for what kManager has as its subcomponent.
std::string csp(const std::string& name) {
  return "<component name=\"" + name +
         "\"><interfaces><implements>crew/Worker</implements></interfaces></component>";
}

/// A peer that takes a route.
std::string with_route(const std::string& value) {
  return "<peer name=\"h\" component=\"herald.xml\">\n<parameter name=\"Route\" value=\"" + value +
         "\"/></peer>\n";
}

std::vector<Broken> broken_missions() {
  return {
      // code
      {"a component is misspelt",
       kOffice,
       "the plugin 'skein_broken_components' has no implementation of the component 'ofice' (did "
       "you mean 'office'?)",
       {{"office.xml",
         "<component name=\"ofice\"><interfaces><implements>crew/Desk</implements>"
         "</interfaces></component>"}}},
      {"a mission without the role", R"(<peer name="c" component="client.xml"/>)",
       "no code would run for the activity 'client': it is registered by add_mission, not by "
       "add_activity; write role=\"mission\""},
      {"a service whose description says nothing",
       kOffice,
       "no code would run for the activity 'office': it is registered by add_body, not by "
       "add_activity; add what it implements to <interfaces> in its description",
       {{"office.xml", "<component name=\"office\"/>"}}},
      {"a description of a service that is none",
       R"(<peer name="h" component="herald.xml"/>)",
       "no code would run for the component 'herald': it is registered by add_activity, not by "
       "add_body",
       {{"herald.xml",
         "<component name=\"herald\"><interfaces><implements>crew/Desk</implements>"
         "</interfaces></component>"}}},
      {"a CSP as a peer", R"(<peer name="c" component="clerk.xml"/>)",
       "no code would run for the component 'clerk': it is registered by add_csp, not by add_body; "
       "write it as a <csp>"},
      {"a peer as a CSP",
       R"(<peer name="o" component="office.xml"><csp component="quiet.xml"/></peer>)",
       "no code would run for the CSP 'quiet': it is registered by add_body, not by add_csp",
       {{"office.xml",
         "<component name=\"office\"><interfaces><implements>crew/Desk</implements>"
         "</interfaces><subcomponents><subcomponent>crew/Desk</subcomponent>"
         "</subcomponents></component>"}}},
      {"a service that is to run the mission",
       R"(<peer name="o" component="office.xml" role="mission"/>)",
       "\"o\" has role=\"mission\" and provides crew/Desk"},
      {"no plugin", R"(<peer name="h" component="herald.xml" plugin=""/>)",
       "no plugin is named for the activity 'herald'; name the one that implements it"},
      // interfaces
      {"an interface is misspelt",
       kOffice,
       "office.xml:1:42: error: 'office' declares crew/Dsk, which its code does not implement (did "
       "you mean 'crew/Desk'?); its code implements crew/Desk",
       {{"office.xml",
         "<component name=\"office\"><interfaces>    <implements>crew/Dsk"
         "</implements></interfaces></component>"}}},
      {"a second interface that the code lacks",
       kOffice,
       "office.xml:3:1: error: 'office' declares crew/Worker, which its code does not implement",
       {{"office.xml", component("<interfaces><implements>crew/Desk</implements>\n"
                                 "<implements>crew/Worker</implements></interfaces>")}}},
      {"a CSP of another interface",
       R"(<peer name="o" component="office.xml"><csp component="clerk.xml"/></peer>)",
       "'clerk' declares crew/Worker, which its code does not implement; its code implements "
       "crew/Desk",
       {{"office.xml",
         "<component name=\"office\"><interfaces><implements>crew/Desk</implements>"
         "</interfaces><subcomponents><subcomponent>crew/Worker</subcomponent>"
         "</subcomponents></component>"},
        {"clerk.xml",
         "<component name=\"clerk\"><interfaces><implements>crew/Worker</implements>"
         "</interfaces></component>"}}},
      {"a plugin that is not there",
       R"(<peer name="h" component="herald.xml" plugin="skein_brokn"/>)",
       "the plugin 'skein_brokn': no libskein_brokn.so in "},
      {"a plugin that is a text",
       R"(<peer name="h" component="herald.xml" plugin="FOLDER/text.so"/>)",
       "text.so cannot be loaded: ",
       {{"text.so", "I am a plugin."}}},
      {"a plugin that is something else",
       R"(<peer name="h" component="herald.xml" plugin="libdl.so.2"/>)",
       "the plugin 'libdl.so.2': no liblibdl.so.2.so in "},
      {"a plugin that is a static library",
       R"(<peer name="h" component="herald.xml" plugin="FOLDER/libstatic.a"/>)",
       "libstatic.a is a static library; make the plugin a module: add_library(NAME MODULE ...)",
       {{"libstatic.a", "!<arch>\n"}}},
      {"a plugin beside which there is only a static library",
       R"(<peer name="h" component="herald.xml" plugin="FOLDER/libstatic.so"/>)",
       "libstatic.a is a static library; make the plugin a module: add_library(NAME MODULE ...)",
       {{"libstatic.a", "!<arch>\n"}}},
      {"a library that was not made for Skein",
       R"(<peer name="h" component="herald.xml" plugin="skein"/>)",
       "exports no skein_plugin_abi: it was not made for Skein, or for another version; a plugin "
       "needs the line extern \"C\" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }"},
      {"a plugin of another version",
       R"(<peer name="h" component="herald.xml"/>)",
       "this is ABI ",
       {},
       "is old"},
      {"a plugin that crashes",
       R"(<peer name="h" component="herald.xml"/>)",
       "town.xml:2:1: error: loading the plugin 'skein_broken_components' ends its process by "
       "signal 6 (Aborted); look at what runs then: its skein_register_components",
       {},
       "aborts"},
      {"a plugin that ends the process",
       R"(<peer name="h" component="herald.xml"/>)",
       "loading the plugin 'skein_broken_components' ends its process with exit code 0",
       {},
       "exits"},
      {"a plugin that throws",
       R"(<peer name="h" component="herald.xml"/>)",
       "libskein_broken_components.so, while it registered its components: no licence",
       {},
       "throws"},
      {"a plugin that registers a component twice",
       R"(<peer name="h" component="herald.xml"/>)",
       "two implementations of component 'office' are registered; this plugin registers it twice",
       {},
       "registers twice"},
      {"a plugin that registers nothing",
       R"(<peer name="o" component="office.xml">
<csp component="stranger.xml" plugin="skein_changed_components"/></peer>)",
       "the plugin 'skein_broken_components' registers no component at all, and is to implement "
       "the component 'office'; register it in the plugin's skein_register_components",
       {{"office.xml", kManager}, {"stranger.xml", csp("stranger")}},
       "registers nothing"},
      {"a component that another plugin of the peer would not have either",
       R"(<peer name="o" component="office.xml">
<csp component="clerk.xml" plugin="skein_changed_components"/>
<csp component="missing.xml" plugin="skein_changed_components"/></peer>)",
       "the plugin 'skein_changed_components' has no implementation of the CSP 'missing'; it "
       "implements stranger\n",
       {{"office.xml", kManager}, {"clerk.xml", csp("stranger")}, {"missing.xml", csp("missing")}}},
      // values that only the plugin can judge
      {"a value of a peer", with_route("the sea"),
       "town.xml:3:1: error: \"Route\": 'the sea' is no road; write NAME street; it is defined "
       "at "},
      {"a value of a CSP with a process of its own",
       R"(<peer name="o" component="office.xml"><csp component="clerk.xml" process="own">
<parameter name="Route" value="the sea"/></csp></peer>)",
       "town.xml:3:1: error: \"Route\": 'the sea' is no road",
       {{"office.xml", kManager},
        {"clerk.xml",
         "<component name=\"worker\"><interfaces><implements><type>crew/Worker</type><optional>"
         "<parameter name=\"Route\"/></optional></implements></interfaces></component>"}}},
      {"a variable's value",
       "<variable name=\"way\" default=\"the sea\"/>\n" + with_route("${way}"),
       "town.xml:2:1: error: \"Route\": 'the sea' is no road"},
      {"a value from a file",
       with_route("@roads.txt"),
       "roads.txt:2:1: error: \"Route\": 'the sea' is no road",
       {{"roads.txt", "High street\nthe sea\nLow street\n"}}},
      {"a value from a file that is not there",
       with_route("@road.txt"),
       "road.txt: error: cannot be opened: No such file or directory; check the path (did you mean "
       "'roads.txt'?)",
       {{"roads.txt", "High street\n"}}},
      {"a value that crashes what checks it", with_route("abyss"),
       "town.xml:2:1: error: checking the values of 'h' ends its process by signal 6 (Aborted); "
       "look at the checks that its plugin adds by add_check"},
      // names and files
      {"a system with a blank", R"(<peer name="h" component="herald.xml" system="uav 1"/>)",
       "town.xml:2:39: error: \"uav 1\" is no name of a system; use letters, digits, '_', '-' and "
       "'.'"},
      {"a system for all", R"(<peer name="h" component="herald.xml" system="*"/>)",
       "\"*\" is no name of a system"},
      {"a system with a slash", R"(<peer name="h" component="herald.xml" system="uav/1"/>)",
       "\"uav/1\" is no name of a system"},
      {"one history, written in two ways",
       R"(<peer name="a" component="office.xml" history="h.json"/>
<peer name="b" component="office.xml" history="./h.json"/>)",
       "town.xml:3:1: error: the file of a history or decision_log \"h.json\" is there twice; the "
       "first is at "},
      {"a history that is the log, too",
       R"(<peer name="a" component="office.xml" history="d" decision_log="d"/>)",
       "the file of a history or decision_log \"d\" is there twice"},
      {"a history in no folder", R"(<peer name="a" component="office.xml" history="past/h.json"/>)",
       "town.xml:2:1: error: the folder of the history or decision_log \"past/h.json\" is not "
       "there; "
       "make it, or start the mission where it is"},
      {"loopback between processes",
       R"(<peer name="a" component="office.xml" vendor="loopback"/>
<peer name="h" component="herald.xml" role="mission"/>)",
       "town.xml:2:1: error: \"a\" is on loopback, a network inside of one process, and the "
       "mission has more processes, which will not see it; write fastdds or cyclonedds"},
      {"a strategy that nobody has", R"(<peer name="a" component="office.xml" strategy="larned"/>)",
       "unknown selection strategy 'larned' (did you mean 'learned'?)"},
  };
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const auto at = text.find(part);
  return at == std::string::npos ? text : text.replace(at, part.size(), by);
}

}  // namespace

TEST_CASE("A broken mission is refused with the message that a person needs, and nothing starts") {
  for (const Broken& broken : broken_missions()) {
    CAPTURE(broken.what);
    const Town town;
    for (const auto& [name, text] : broken.files) town.write(name, text);
    const std::string profile =
        town.profile(replaced(broken.peers, "FOLDER", town.path().string()));
    CommandOptions options;
    options.prepare = [&] {
      if (!broken.plugin_breaks.empty()) setenv("BROKEN_PLUGIN", broken.plugin_breaks.c_str(), 1);
    };
    for (const std::string command : {"check", "launch"}) {
      CAPTURE(command);
      std::vector<std::string> words{command, profile};
      if (command == "launch") words.emplace_back("--verbose");  // it would tell what it starts
      CommandRun run(words, options);
      CHECK(run.wait() == 78);
      CHECK_THAT(run.output(), Contains(broken.message) && !Contains("started as process"));
    }
  }
}

TEST_CASE("Two plugins that hold two versions of an interface are told, with the difference") {
  const Town town;
  town.write("office.xml", kManager);
  town.write("worker.xml", csp("worker"));
  town.write("stranger.xml", csp("stranger"));
  const std::string process = GENERATE("in", "own");
  const std::string profile = town.profile(R"(<peer name="o" component="office.xml">
<csp component="worker.xml"/>
<csp component="stranger.xml" plugin="skein_changed_components" process=")" +
                                           process + R"("/></peer>
<peer name="h" component="herald.xml" role="mission"/>)");
  const std::string told =
      "the plugins 'skein_broken_components' and 'skein_changed_components' hold two versions of "
      "crew/Worker, and neither calls what the other implements: ";
  const std::string remedy = "; build both from the same IDL";
  CommandRun check({"check", profile});
  CHECK(check.wait() == 0);
  CHECK_THAT(check.output(), Contains("town.xml:4:1: warning: " + told) && Contains(remedy) &&
                                 Contains("operation 'work': parameter 'task' is a string in "
                                          "'skein_broken_components' and a double in "
                                          "'skein_changed_components'"));
  if (!installed("fastdds")) return;
  CommandRun launch({"launch", profile});
  CHECK(launch.wait() == 0);
  CHECK_THAT(launch.output(), Contains("town.xml:4:1: warning: " + told));
  if (process == "own") return;
  CommandRun peer({"peer", profile, "o"});
  CHECK(peer.writes("warning: default/o: " + told));
}

TEST_CASE("A peer whose plugin ends its process says which, and does not end as if all were well") {
  if (!installed("fastdds")) return;
  const Town town;
  const std::string profile = town.profile(R"(<peer name="h" component="herald.xml"/>)");
  const auto [how, code, told] = GENERATE(table<std::string, int, std::string>({
      {"aborts", 128 + SIGABRT, "skein: dies of signal 6 while it "},
      {"exits in order", 71, "skein: is ended by a call of exit() while it "},
  }));
  CommandOptions options;
  options.prepare = [how = how] { setenv("BROKEN_PLUGIN", how.c_str(), 1); };
  CommandRun peer({"peer", profile, "h"}, options);
  CHECK(peer.wait() == code);
  CHECK_THAT(peer.output(), Contains(told + "loads the plugin 'skein_broken_components'"));
}

TEST_CASE("A plugin that every user may replace is not loaded, neither to check nor to run it") {
  const Town town;
  const fs::path plugin = town.copy_of_plugin();
  const bool whole_folder = GENERATE(false, true);
  const fs::path open = whole_folder ? plugin.parent_path() : plugin;
  const std::string profile = town.profile("<peer name=\"h\" component=\"herald.xml\" plugin=\"" +
                                           plugin.string() + "\" role=\"mission\"/>");
  CommandRun sound({"check", profile});
  CHECK(sound.wait() == 0);
  fs::permissions(open, fs::perms::others_write, fs::perm_options::add);
  // Were it loaded, it would end the process.
  const CommandOptions options{.prepare = [] { setenv("BROKEN_PLUGIN", "exits", 1); }};
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"check", profile}, {"launch", profile}, {"peer", profile, "h"}}) {
    CAPTURE(words.front());
    CommandRun run(words, options);
    CHECK(run.wait() == 78);
    CHECK_THAT(run.output(), Contains("is not loaded, since every user may write to " +
                                      fs::canonical(open).string() + "; "));
  }
}

TEST_CASE("A vendor whose module is missing is a finding, and nothing is started") {
  const Town town;
  // A folder with libskein alone; modules are looked for beside it.
  const fs::path lonely = town.path() / "lib";
  fs::create_directories(lonely);
  fs::create_symlink(built_library(SKEIN_LIBRARY_SONAME), lonely / SKEIN_LIBRARY_SONAME);
  const std::string profile = town.profile(
      "<peer name=\"h\" component=\"herald.xml\" vendor=\""
      "cyclonedds\" plugin=\"" +
      built_library("lib" + kPlugin + ".so") + "\" role=\"mission\"/>");
  const CommandOptions options{.prepare = [&] { setenv("LD_LIBRARY_PATH", lonely.c_str(), 1); }};
  for (const std::string command : {"check", "launch"}) {
    CommandRun run({command, profile}, options);
    CHECK(run.wait() == 78);
    CHECK_THAT(run.output(),
               Contains("town.xml:2:1: error: the vendor 'cyclonedds': no libskein_cyclonedds.so"));
  }
}

TEST_CASE("What could not be checked is said, and is no error") {
  const Town town;
  CommandRun quiet({"check", town.profile(R"(<peer name="q" component="quiet.xml"/>)")});
  CHECK(quiet.wait() == 0);
  CHECK_THAT(quiet.output(),
             Contains("quiet.xml:1:1: note: whether the code of 'quiet' implements what its "
                      "description says was not checked") &&
                 Contains("complete: every dependency is resolved; see the notes"));
  CommandRun elsewhere({"check", town.profile(R"(<peer name="h" component="herald.xml">
<environment name="SKEIN_MODULE_PATH" value="/elsewhere"/></peer>)")});
  CHECK(elsewhere.wait() == 0);
  CHECK_THAT(elsewhere.output(),
             Contains("town.xml:2:1: note: the vendor and the plugins of 'h' were not checked"));
  CommandRun hosts({"check", "--host", "192.0.2.1",
                    town.profile(R"(<peer name="a" component="office.xml" host="192.0.2.1"
interface="lo"/><peer name="b" component="office.xml" host="192.0.2.2" interface="lo"/>)")});
  CHECK(hosts.wait() == 0);
  CHECK_THAT(hosts.output(),
             Contains("note: of the host '192.0.2.2' only the profile was checked"));
  CommandRun all({"check", town.profile(kOffice)});
  CHECK(all.wait() == 0);
  CHECK_THAT(all.output(), !Contains("note") && Contains("complete"));
}

TEST_CASE("A value from the command line counts as the profile's") {
  const Town town;
  town.write("herald.xml",
             "<component name=\"herald\"><required><parameter name=\"Patience\"/></required>"
             "</component>");
  const std::string profile =
      town.profile(R"(<peer name="h" component="herald.xml" role="mission"/>)");
  CommandRun check({"check", profile, "--set", "h.Patience=1 s"});
  CHECK(check.wait() == 0);
  if (!installed("fastdds")) return;
  CommandRun launch({"launch", profile, "--set", "h.Patience=1 s"});
  CHECK(launch.wait() == 0);
}

TEST_CASE("A wrong value from the command line is told to be from there") {
  const Town town;
  const std::string profile =
      town.profile("<variable name=\"way\" default=\"High street\"/>\n" + with_route("${way}"));
  town.write("roads.txt", "High street\nthe sea\n");
  const auto [option, given, place] = GENERATE(table<std::string, std::string, std::string>(
      {{"--variable", "way=the sea", "--variable way"},
       {"--variable", "way=@FOLDER/roads.txt", "roads.txt:2:1"},
       {"--set", "h.Route=the sea", "the command line"},
       {"--set", "h.Route=@FOLDER/roads.txt", "roads.txt:2:1"}}));
  const std::string value = replaced(given, "FOLDER", town.path().string());
  for (const std::string command : {"check", "launch", "peer"}) {
    CAPTURE(command, option, value);
    std::vector<std::string> words{command, profile, option, value};
    if (command == "peer") words.insert(words.begin() + 2, "h");
    CommandRun run(words);
    CHECK(run.wait() == 78);
    CHECK_THAT(run.output(), Contains(place + ": error: \"Route\": 'the sea' is no road"));
  }
}

TEST_CASE("A list that is longer than a command line is taken from a file") {
  if (!installed("fastdds")) return;
  const Town town;
  std::string roads;
  for (int i = 0; i < 20'000; ++i) roads += "Long and winding street\n";
  town.write("roads.txt", roads);
  CommandRun run({"launch", town.profile("<variable name=\"way\"/>\n" + with_route("${way}")),
                  "--variable", "way=@" + (town.path() / "roads.txt").string()});
  CHECK(run.wait() == 0);
}

TEST_CASE("A process that ends with a wrong configuration is not started again") {
  const Town town;
  CommandRun run({"launch", town.profile(R"(<peer name="p" program="sh" restart="always">
<argument value="-c"/><argument value="echo tried; exit 78"/></peer>)")});
  CHECK(run.wait() == 78);
  const std::string output = run.output();
  CHECK_THAT(output, Contains("p ended with exit code 78"));
  CHECK(output.find("tried") != std::string::npos);
  CHECK(output.find("tried") == output.rfind("tried"));
}
