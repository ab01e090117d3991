// What people do wrong in profiles, and what the commands tell them: all of it at once, each with
// its place, its cause and what to write instead. Nothing is started.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "test/tools/command_run.hpp"
#include "test/tools/temporary_folder.hpp"

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
      {"the peer that runs the mission says what its loss means",
       mission(
           kArchive + kOffice +
           R"(<peer name="client" component="parts/client.xml" role="mission" on_loss="degrade"/>)"),
       {"city.xml:4:65: error: on_loss has no effect on the peer with role=\"mission\"; remove it: "
        "the end of this peer ends the mission"}},
      {"a tag is not closed",
       "<mission name=\"city\">\n  <peer name=\"archive\" component=\"parts/archive.xml\">\n"
       "</mission>",
       {"city.xml:2:3: error: malformed XML: <peer> is not closed: </mission> comes first, at 3:1; "
        "write </peer> behind what it holds, or end the tag with />"},
       {},
       ""},
      {"it is a component, no mission",
       Office::component("archive", "city/Archive", "", ""),
       {"city.xml:1:1: error: <component> is no mission profile; its outermost element is <mission "
        "name=\"...\">"},
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

/// What `check --json` prints, as text for people.
std::string text_of_json(const std::string& file) {
  std::string text;
  for (const auto& finding : nlohmann::json::parse(std::ifstream(file))) {
    const int line = finding.at("line");
    text += finding.at("file").get<std::string>();
    if (line > 0)
      text += ":" + std::to_string(line) + ":" + std::to_string(finding.at("column").get<int>());
    const std::string remedy = finding.at("remedy");
    text += ": " + finding.at("severity").get<std::string>() + ": " +
            finding.at("problem").get<std::string>() + (remedy.empty() ? "" : "; " + remedy) + "\n";
  }
  return text;
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

TEST_CASE("A broken profile is refused with all that a person needs, and the same as JSON") {
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
      if (command == "launch") continue;
      const std::string taker = office.write("findings.json", "");
      CommandRun for_editors({"check", "--json", office.profile()}, {.output = taker});
      CHECK(for_editors.wait() == 78);
      CHECK(for_editors.output() == "");
      CHECK(text_of_json(taker) == run.output());
    }
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
