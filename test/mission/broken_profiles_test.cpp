// What people do wrong in profiles, and what the commands tell them: all of it at once, each with
// its place, its cause and what to write instead. Nothing is started.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../tools/temporary_folder.hpp"
#include "command_run.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

/// A folder with the components of an office that needs a clerk and asks an archive, and a client.
class Office {
 public:
  Office() {
    write("dictionary.xml", R"(<dictionary>
  <attribute name="latency" type="duration" unit="ms" min="0" max="60000">How long a call takes.</attribute>
  <attribute name="isolated" type="boolean">Whether it needs a process of its own.</attribute>
  <parameter name="Speed" type="real" unit="m/s" min="1" max="100">How fast.</parameter>
  <parameter name="Patience" type="duration" unit="ms" min="1">How long to wait.</parameter>
  <parameter name="Archive" type="service" interface="city/Archive">Whom to ask.</parameter>
</dictionary>)");
    write("parts/office.xml", component("office", "city/Desk", "city/Archive", "city/Clerk",
                                        R"(<optional><parameter name="Speed"/>
<parameter name="Patience"/><parameter name="Archive"/></optional>)"));
    write("parts/archive.xml", component("archive", "city/Archive", "", ""));
    write("parts/clerk.xml", component("clerk", "city/Clerk", "", ""));
    write("parts/client.xml", component("client", "", "city/Desk", ""));
  }

  static std::string component(const std::string& name, const std::string& implements,
                               const std::string& depends, const std::string& subcomponent,
                               const std::string& more = "") {
    const auto list = [](const std::string& outer, const std::string& inner,
                         const std::string& content) {
      return content.empty() ? ""
                             : "<" + outer + ">\n<" + inner + ">" + content + "</" + inner + "></" +
                                   outer + ">";
    };
    return "<component name=\"" + name + "\">" +
           list("interfaces", "implements",
                implements.empty() ? "" : "<type>" + implements + "</type>" + more) +
           list("dependencies", "depends", depends) +
           list("subcomponents", "subcomponent", subcomponent) + "</component>";
  }

  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_.path() / name).parent_path());
    return folder_.write(name, text).string();
  }

  std::string profile() const { return (folder_.path() / "city.xml").string(); }

  std::string without_folder(std::string text) const {
    const std::string prefix = folder_.path().string() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) {
      text.erase(at, prefix.size());
    }
    return text;
  }

 private:
  TemporaryFolder folder_;
};

const std::string kArchive = R"(<peer name="archive" component="parts/archive.xml"/>)"
                             "\n";
const std::string kClerk = R"(<csp component="parts/clerk.xml"/>)";
const std::string kOffice =
    R"(<peer name="office" component="parts/office.xml">)" + kClerk + "</peer>\n";
const std::string kClient = R"(<peer name="client" component="parts/client.xml" role="mission"/>)"
                            "\n";

/// A mission whose first peer is in line 2.
std::string mission(const std::string& peers) {
  return "<mission name=\"city\" plugin=\"no_plugin\">\n" + peers + "</mission>\n";
}

struct Broken {
  std::string what;
  std::string profile;
  std::vector<std::string> findings;              ///< The beginning of each, in their order.
  std::map<std::string, std::string> files = {};  ///< Besides the profile.
  /// Whose plugin is missing, too; empty where the profile has no peer that could be read.
  std::string first_peer = "city.xml:2:1";
};

std::vector<Broken> broken_profiles() {
  return {
      {"a component's file is misspelled",
       mission(R"(<peer name="archive" component="parts/archve.xml"/>)"
               "\n" +
               kOffice),
       {"city.xml:2:22: error: the component \"parts/archve.xml\" cannot be read; the next finding "
        "says why",
        "parts/archve.xml: error: cannot be opened: No such file or directory; check the path (did "
        "you mean 'archive.xml'?)",
        "parts/office.xml:4:1: error: \"office\" depends on city/Archive, which no peer of "
        "\"city\" implements; add a peer that does, unless one whose component cannot be read "
        "does"}},
      {"nobody provides what a peer needs",
       mission(kOffice + kClient),
       {"parts/office.xml:4:1: error: \"office\" depends on city/Archive, which no peer of "
        "\"city\" implements; add a peer that does"}},
      {"only another's CSP provides what a peer needs",
       mission(kArchive + kOffice + R"(<peer name="boss" component="boss.xml"/>)"),
       {"boss.xml:2:1: error: \"boss\" depends on city/Clerk, which only the CSP "
        "\"office/clerk\" implements; a CSP serves its own peer alone; depend on that peer's "
        "interface"},
       {{"boss.xml", Office::component("boss", "", "city/Clerk", "")}}},
      {"peers need each other",
       mission(kOffice + R"(<peer name="vault" component="vault.xml"/>)"),
       {"parts/office.xml:4:1: error: a cycle of dependencies: office -> vault -> office; remove "
        "one of them, or add a provider outside of the cycle"},
       {{"vault.xml", Office::component("vault", "city/Archive", "city/Desk", "")}}},
      {"a CSP fits no slot",
       mission(kArchive + R"(<peer name="office" component="parts/office.xml">)" + kClerk + "\n" +
               R"(  <csp component="parts/archive.xml"/></peer>)"),
       {"city.xml:4:3: error: the CSP \"archive\" implements no subcomponent of \"office\"; it "
        "must "
        "implement one of them: "}},
      {"a slot is empty",
       mission(kArchive + R"(<peer name="office" component="parts/office.xml"/>)"),
       {"city.xml:3:1: error: \"office\" has no CSP for its subcomponent city/Clerk"}},
      {"a value is out of range, one has an unknown unit, one is no number",
       mission(kArchive + R"(<peer name="office" component="parts/office.xml">)" + kClerk + "\n" +
               R"(<parameter name="Speed" value="250"/>)"
               "\n" +
               R"(<parameter name="Patience" value="2 weeks"/></peer>)"
               "\n" +
               R"(<peer name="second" component="parts/office.xml">)" + kClerk +
               R"(<parameter name="Speed" value="fast"/></peer>)"),
       {"city.xml:4:1: error: \"Speed\" is 250 m/s, more than 100 m/s; it is defined at "
        "dictionary.xml:4:3",
        "city.xml:5:1: error: \"Patience\" is \"2 weeks\", which is no duration in ms",
        "city.xml:6:84: error: \"Speed\" is \"fast\", which is no real in m/s"}},
      {"a parameter is misspelled, a reference leads nowhere",
       mission(kArchive + R"(<peer name="office" component="parts/office.xml">)" + kClerk + "\n" +
               R"(<parameter name="Sped" value="2"/>)"
               "\n" +
               R"(<parameter name="Archive" value="archiv"/></peer>)"),
       {"city.xml:4:1: error: \"office\" has no parameter \"Sped\"; did you mean 'Speed'?",
        "city.xml:5:1: error: \"Archive\" refers to \"archiv\", which is no peer or CSP with "
        "city/Archive; did you mean 'archive'?"}},
      {"a component has an attribute that the dictionary does not have",
       mission(R"(<peer name="fast" component="fast.xml"/>)"),
       {"fast.xml:2:38: error: the attribute \"latncy\" is unknown; did you mean 'latency'?"},
       {{"fast.xml", Office::component("fast", "city/Archive", "", "",
                                       R"(<attribute name="latncy" value="1"/>)")}}},
      {"two peers have one name",
       mission(kArchive + kArchive),
       {"city.xml:3:1: error: the peer \"archive\" is there twice; the first is at city.xml:2:1"}},
      {"attributes and elements are misspelled",
       mission(R"(<peer name="archive" component="parts/archive.xml" restrat="always"/>)"
               "\n" +
               kOffice + R"(<pear name="x" component="parts/archive.xml"/>)"),
       {"city.xml:2:52: error: <peer> has no \"restrat\"; did you mean 'restart'?",
        "city.xml:4:1: error: <pear> is unknown in <mission>; did you mean 'peer'?"}},
      {"words that there are not",
       mission(R"(<peer name="archive" component="parts/archive.xml" vendor="fastdss")"
               "\n" +
               std::string(R"(restart="on-failur" scheduling="fast" on_loss="yes"/>)")),
       {"city.xml:2:52: error: \"fastdss\" is no DDS vendor known here; did you mean 'fastdds'?",
        "city.xml:3:1: error: \"on-failur\" is no restart policy; did you mean 'on-failure'?",
        "city.xml:3:39: error: \"yes\" is no answer to a loss; known are \"abort\", \"degrade\", "
        "\"continue\"",
        "city.xml:3:21: error: \"fast\" is no scheduling; known are \"normal\", \"fifo\", "
        "\"round-robin\""}},
      {"a peer is nothing at all",
       mission(R"(<peer name="archive"/>)"),
       {"city.xml:2:1: error: <peer> has neither a component nor a program; write "
        "component=\"...\", or program=\"...\""}},
      {"a name is missing, one has a blank",
       mission(R"(<peer component="parts/archive.xml"/>)"
               "\n" +
               std::string(R"(<peer name="my archive" component="parts/archive.xml"/>)")),
       {"city.xml:2:1: error: <peer> has no name; write name=\"...\"",
        "city.xml:3:7: error: \"my archive\" is no name; use letters, digits, _ and -"}},
      {"a variable is unknown, one has no value",
       mission(R"(<variable name="vendor" default="cyclonedds"/><variable name="system"/>)"
               "\n" +
               std::string(R"(<peer name="archive" component="parts/archive.xml" vendor="${vender}"
system="${system}"/>)")),
       {"city.xml:2:47: error: the variable \"system\" has no value; give it one by --variable "
        "system=VALUE, or write default=\"...\"",
        "city.xml:3:52: error: the variable \"vender\" is unknown here; did you mean 'vendor'?"},
       {},
       "city.xml:3:1"},
      {"parts include each other",
       mission(kArchive + R"(<include file="one.xml"/>)"),
       {"two.xml:2:10: error: a circle of includes: one.xml -> two.xml -> one.xml; remove one of "
        "them"},
       {{"one.xml", R"(<part><include file="two.xml"/></part>)"},
        {"two.xml", "<part>\n<include file=\"one.xml\"/></part>"}}},
      {"a part is missing, and one is no part",
       mission(kArchive + R"(<include file="extras.xml"/><include file="parts/clerk.xml"/>)"),
       {"city.xml:3:10: error: the part \"extras.xml\" cannot be read; the next finding says why",
        "extras.xml: error: cannot be opened: No such file or directory; check the path",
        "parts/clerk.xml:1:1: error: <component> is no part of a profile; the outermost element of "
        "what is included is <part>"}},
      {"a mistake is in a part",
       mission(kArchive + R"(<include file="more.xml"/>)"),
       {"more.xml:3:5: error: <peer> has no \"vendr\"; did you mean 'vendor'?"},
       {{"more.xml",
         "<part>\n  <peer name=\"second\" component=\"parts/archive.xml\"\n"
         "    vendr=\"fastdds\"/>\n</part>"}}},
      {"this machine lacks an interface, a host's address, a CPU and a program",
       mission(
           R"(<peer name="a" component="parts/archive.xml" interface="eth77"/>)"
           "\n"
           R"(<peer name="b" component="parts/archive.xml" interface="lo" peers="nowhere.invalid"/>)"
           "\n"
           R"(<peer name="c" component="parts/archive.xml" process_cpus="0,1000"/>)"
           "\n"
           R"(<peer name="d" program="no-such-program"/>)"
           "\n"
           R"(<peer name="e" program="ls -l"/>)"
           "\n"
           R"(<peer name="f" program="./none"/>)"),
       {"city.xml:2:1: error: 'a' speaks on 'eth77', but this host has no such interface",
        "city.xml:3:1: error: 'b' is to look for peers there, but ",
        "city.xml:4:1: error: the threads of 'c': there is no CPU 1000; this machine has 0 to ",
        "city.xml:5:1: error: the program 'no-such-program' of 'd' is not in PATH; install it, or "
        "write a path with a slash",
        "city.xml:6:1: error: the program 'ls -l' of 'e' is not in PATH; write its arguments as "
        "<argument value=\"...\"/>",
        "city.xml:7:1: error: the program 'none' of 'f' cannot be executed; check the path, and "
        "that its file is executable"}},
      {"two peers run the mission, and one of them is restarted",
       mission(
           kArchive + kOffice + kClient +
           R"(<peer name="other" component="parts/client.xml" role="mission" restart="always"/>)"),
       {"city.xml:5:1: error: a second peer with role=\"mission\"; the first is at city.xml:4:1",
        "city.xml:5:1: error: \"other\" runs the mission and would be restarted; write "
        "restart=\"never\": its end is the mission's"}},
      {"the peer that runs the mission says what its loss means",
       mission(
           kArchive + kOffice +
           R"(<peer name="client" component="parts/client.xml" role="mission" on_loss="degrade"/>)"),
       {"city.xml:4:65: error: on_loss has no effect on the peer with role=\"mission\"; remove it: "
        "the end of this peer ends the mission"}},
      {"a CSP that may crash works in its entity's process",
       mission(kArchive + R"(<peer name="office" component="parts/office.xml">
  <csp component="rash.xml"/></peer>)"),
       {"city.xml:4:3: error: the CSP \"rash\" works in its entity's process, but is isolated "
        "(rash.xml:2:36); write process=\"own\""},
       {{"rash.xml", Office::component("rash", "city/Clerk", "", "",
                                       R"(<attribute name="isolated" value="true"/>)")}}},
      {"two peers write one file",
       mission(kArchive +
               R"(<peer name="office" component="parts/office.xml" count="2" history="h.json">)" +
               kClerk + "</peer>"),
       {"city.xml:3:1: error: the file of a history or decision_log \"h.json\" is there twice"}},
      {"a tag is not closed",
       "<mission name=\"city\">\n  <peer name=\"archive\" component=\"parts/archive.xml\">\n"
       "</mission>",
       {"city.xml:2:3: error: malformed XML: <peer> is not closed: </mission> comes first, at 3:1; "
        "write </peer> behind what it holds, or end the tag with />"},
       {},
       ""},
      {"a quote is missing",
       "<mission name=\"city>\n<peer name=\"archive\"/>\n</mission>",
       {"city.xml:1:10: error: malformed XML: the value of \"name\" has no closing quote; end it "
        "with the quote that it begins with"},
       {},
       ""},
      {"an ampersand stands alone",
       mission(R"(<peer name="a&b" component="parts/archive.xml"/>)"),
       {"city.xml:2:14: error: a lone \"&\"; write &amp;"},
       {},
       ""},
      {"it is a component, no mission",
       Office::component("archive", "city/Archive", "", ""),
       {"city.xml:1:1: error: <component> is no mission profile; its outermost element is <mission "
        "name=\"...\">"},
       {},
       ""},
      {"entities grow without end",
       R"(<!DOCTYPE mission [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>
<mission name="&b;"/>)",
       {"city.xml:1:1: error: a document type with declarations of its own; remove it"},
       {},
       ""},
      {"it is empty", "", {"city.xml: error: is empty"}, {}, ""},
      {"the mission has nobody",
       mission(""),
       {"city.xml:1:1: error: the mission has no <peer>"},
       {},
       ""},
      {"the dictionary is missing, and nothing is said of the names that it would define",
       "<mission name=\"city\" plugin=\"no_plugin\" dictionary=\"dictionry.xml\">\n" + kArchive +
           R"(<peer name="office" component="parts/office.xml">
<parameter name="Speed" value="5"/>)" +
           kClerk + "</peer></mission>",
       {"city.xml:1:41: error: the dictionary cannot be read; name its file",
        "dictionry.xml: error: cannot be opened: No such file or directory; check the path"}},
      {"the dictionary is missing, the domain is none",
       "<mission name=\"city\" dictionary=\"dictionry.xml\"\ndomain=\"999\">" +
           std::string(R"(<peer name="x" program="true"/>)") + "</mission>",
       {"city.xml:2:1: error: \"999\" is no DDS domain; write a number from 0 to 232",
        "city.xml:1:22: error: the dictionary cannot be read; name its file, relative to the "
        "profile: dictionary=\"...\"",
        "dictionry.xml: error: cannot be opened: No such file or directory; check the path (did "
        "you "
        "mean 'dictionary.xml'?)"},
       {},
       ""},
  };
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> all_findings(const Broken& broken) {
  auto findings = broken.findings;
  if (!broken.first_peer.empty()) {
    findings.push_back(broken.first_peer +
                       ": error: the plugin 'no_plugin': no libno_plugin.so in ");
  }
  return findings;
}

}  // namespace

TEST_CASE("A broken profile is refused with all that a person needs to mend it") {
  for (const Broken& broken : broken_profiles()) {
    CAPTURE(broken.what);
    const Office office;
    office.write("city.xml", broken.profile);
    for (const auto& [name, text] : broken.files) office.write(name, text);
    for (const std::string command : {"check", "launch"}) {
      CAPTURE(command);
      std::vector<std::string> words{command, office.profile()};
      if (command == "launch") words.emplace_back("--verbose");  // it would tell what it starts
      CommandRun run(words);
      CHECK(run.wait() == 78);
      const std::string output = office.without_folder(run.output());
      CHECK_THAT(output, !Contains("started as process"));
      const auto lines = lines_of(output);
      const auto findings = all_findings(broken);
      CAPTURE(output);
      REQUIRE(lines.size() == findings.size());
      for (std::size_t i = 0; i < lines.size(); ++i) {
        CHECK_THAT(lines[i], Catch::StartsWith(findings[i]));
      }
    }
  }
}

TEST_CASE("For editors, the same findings are JSON, whatever the file is") {
  for (const Broken& broken : broken_profiles()) {
    CAPTURE(broken.what);
    const Office office;
    office.write("city.xml", broken.profile);
    for (const auto& [name, text] : broken.files) office.write(name, text);
    CommandRun for_people({"check", office.profile()});
    CHECK(for_people.wait() == 78);
    const std::string taker = office.write("findings.json", "");
    CommandRun run({"check", "--json", office.profile()}, {.output = taker});
    CHECK(run.wait() == 78);
    CHECK(run.output() == "");
    std::string text;
    for (const auto& finding : nlohmann::json::parse(std::ifstream(taker))) {
      const int line = finding.at("line");
      text += finding.at("file").get<std::string>();
      if (line > 0) {
        text += ":" + std::to_string(line) + ":" + std::to_string(finding.at("column").get<int>());
      }
      const std::string remedy = finding.at("remedy");
      text += ": " + finding.at("severity").get<std::string>() + ": " +
              finding.at("problem").get<std::string>() + (remedy.empty() ? "" : "; " + remedy) +
              "\n";
    }
    CHECK(text == for_people.output());
  }
}

TEST_CASE("A profile that is not there, or no text, is JSON as well") {
  const Office office;
  const std::string taker = office.write("findings.json", "");
  const auto [file, problem] = GENERATE(table<std::string, std::string>({
      {"/nowhere/city.xml", "cannot be opened: No such file or directory"},
      {"/", "is a directory"},
      {"binary", "a NUL byte"},
      {"latin1", "bytes that are no UTF-8"},
  }));
  office.write("binary", std::string("<mission\0/>", 11));
  office.write("latin1", "<mission name=\"\xe9\"/>");
  const std::string path =
      file.starts_with('/') ? file : office.profile().replace(office.profile().size() - 8, 8, file);
  CommandRun run({"check", "--json", path}, {.output = taker});
  CHECK(run.wait() == 78);
  const auto findings = nlohmann::json::parse(std::ifstream(taker));
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].at("file") == path);
  CHECK_THAT(findings[0].at("problem").get<std::string>(), Contains(problem));
}

TEST_CASE("A profile with which nothing is wrong is an empty list") {
  const Office office;
  office.write("city.xml", R"(<mission name="city"><peer name="log" program="true"/></mission>)");
  const std::string taker = office.write("findings.json", "");
  CommandRun run({"check", "--json", office.profile()}, {.output = taker});
  CHECK(run.wait() == 0);
  CHECK(nlohmann::json::parse(std::ifstream(taker)) == nlohmann::json::array());
}

TEST_CASE("What a profile says of processes is what they get") {
  const Office office;
  office.write("city.xml", R"(<mission name="city" domain="49"><variable name="word" default="no"/>
<group name="all"><environment name="CITY_NUMBER" value="${instance}"/>
<peer name="clerk" program="./clerk.sh" ready="told" process_cpus="0" count="2">
  <argument value="${word} $$HOME"/></peer></group>
<peer name="end" program="./end.sh" role="mission"/></mission>)");
  const auto script = [&](const std::string& name, const std::string& text) {
    std::filesystem::permissions(office.write(name, "#!/bin/sh\n" + text),
                                 std::filesystem::perms::owner_all);
  };
  script("clerk.sh",
         "echo \"I am $CITY_NUMBER, $1, on $(taskset -cp $$)\" | sed 's/pid .*list/cpus/'\n"
         "touch $0.$CITY_NUMBER; echo >&$SKEIN_READY_FD; exec sleep 1000\n");
  script("end.sh",
         "while ! [ -e ${0%end.sh}clerk.sh.1 -a -e ${0%end.sh}clerk.sh.2 ]; do sleep 0.1; done; "
         "exit 5\n");
  CommandRun run({"launch", office.profile(), "--variable", "word=a b"});
  CHECK(run.wait() == 5);
  CHECK_THAT(run.output(), Contains("clerk-1 | I am 1, a b $HOME, on cpus: 0\n") &&
                               Contains("clerk-2 | I am 2, a b $HOME, on cpus: 0\n"));
}

TEST_CASE("The peers of a group can be started alone") {
  const Office office;
  office.write("city.xml", R"(<mission name="city" domain="49"><group name="short">
<peer name="one" program="true"/></group><peer name="long" program="sleep" role="mission">
<argument value="1000"/></peer></mission>)");
  CommandRun run({"launch", office.profile(), "--only", "short"});
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(), Contains("not started here: long, which --only leaves out"));
}
