#include "mission/check/profile_check.hpp"

#include <catch2/catch.hpp>

#include "test/mission/profile/profile_folder.hpp"

using namespace skein::profile;

namespace {

const std::string kF = R"(<peer name="f" component="f.xml"/>)";
const std::string kN = R"(<peer name="n" component="n.xml"><csp component="p.xml"/></peer>)";
const std::string kG = R"(<peer name="g" component="g.xml" role="mission"/>)";

/// A component that implements and depends on the given interfaces.
std::string component(const std::string& name, const std::string& implements,
                      const std::vector<std::string>& depends) {
  std::string text = "<component name=\"" + name + "\"><interfaces><implements>" + implements +
                     "</implements></interfaces><dependencies>";
  for (const auto& item : depends) text += "\n<depends>" + item + "</depends>";
  return text + "</dependencies></component>";
}

}  // namespace

TEST_CASE("A complete composition has no findings") {
  ProfileFolder folder;
  CHECK(folder.check(kF + kN + kG) == "");
}

TEST_CASE("A dependency that nobody provides is named where it is written") {
  ProfileFolder folder;
  CHECK(folder.check(kN) ==
        "n.xml:5:17: error: \"n\" depends on M/IF, which no peer of \"m\" implements; add a peer "
        "that does; did you mean 'M/IN'?\n");
}

TEST_CASE(
    "A dependency that only other systems provide is a note, where one provides it here none") {
  ProfileFolder folder;
  const std::string elsewhere = R"(<peer name="f" component="f.xml" system="port"/>)";
  const std::string text = folder.check(elsewhere + kN + kG);
  CHECK_THAT(text, Catch::Contains("n.xml:5:17: note: \"n\" of system ") &&
                       Catch::Contains("depends on M/IF, which is provided in other systems only, "
                                       "as by \"f\" of \"port\"; its code finds that if"));
  CHECK_THAT(text, !Catch::Contains("error"));
  CHECK(folder.check(elsewhere + R"(<peer name="f2" component="f.xml"/>)" + kN + kG) == "");
}

TEST_CASE("A CSP's dependency is as good as its entity's") {
  ProfileFolder folder;
  folder.write("q.xml", component("Q", "M/IP", {"M/IMap"}));
  CHECK_THAT(
      folder.check(kF + R"(<peer name="n" component="n.xml"><csp component="q.xml"/></peer>)"),
      Catch::Contains("q.xml:2:1: error: \"n/Q\" depends on M/IMap"));
}

TEST_CASE("Depending on another's CSP is told apart from depending on nobody") {
  ProfileFolder folder;
  folder.write("s.xml", component("S", "M/IS", {"M/IP"}));
  CHECK_THAT(folder.check(kF + kN + R"(<peer name="s" component="s.xml"/>)"),
             Catch::Contains("\"s\" depends on M/IP, which only the CSP \"n/P\" implements; a "
                             "CSP serves its own peer alone"));
}

TEST_CASE("A CSP may depend on what another CSP of the same peer implements") {
  ProfileFolder folder;
  folder.write("t.xml",
               R"(<component name="T"><interfaces><implements>M/IP</implements></interfaces>
    <dependencies><depends>M/IP</depends></dependencies></component>)");
  CHECK(folder.check(kF + R"(<peer name="n" component="n.xml"><csp component="p.xml"/>
                                <csp component="t.xml"/></peer>)") == "");
}

TEST_CASE("A subcomponent without a CSP and a CSP without a subcomponent are both named") {
  ProfileFolder folder;
  folder.write("far.xml", component("F", "Elsewhere/Fetcher", {}));
  const auto text = folder.check(
      kF + "\n" + R"(<peer name="n" component="n.xml"><csp component="far.xml"/></peer>)");
  CHECK_THAT(text, Catch::Contains("m.xml:3:1: error: \"n\" has no CSP for its subcomponent M/IP "
                                   "(n.xml:6:18)"));
  CHECK_THAT(text, Catch::Contains("m.xml:3:34: error: the CSP \"F\" implements no subcomponent of "
                                   "\"n\"; it must implement one of them"));
}

TEST_CASE(
    "A subcomponent whose name is almost what CSPs implement is one finding, not one for each") {
  ProfileFolder folder;
  folder.write("q.xml", component("Q", "Harbor/IPlan", {}));
  folder.write("r.xml", component("R", "Harbor/IPlan", {}));
  folder.write("pilot.xml",
               "<component name=\"Pilot\"><interfaces><implements>Harbor/IPilot"
               "</implements></interfaces><subcomponents>\n<subcomponent>"
               "IDL:Harbour/IPlan</subcomponent></subcomponents></component>");
  CHECK(folder.check(R"(<peer name="p" component="pilot.xml"><csp component="q.xml"/>
<csp component="r.xml"/></peer>)") ==
        "pilot.xml:2:1: error: \"Pilot\" has the subcomponent Harbour/IPlan, which no CSP of \"p\" "
        "implements; did you mean 'Harbor/IPlan'?\n");
}

TEST_CASE("Names that are given twice are named with the place of the first") {
  ProfileFolder folder;
  CHECK_THAT(folder.check(kF + "\n" + kF),
             Catch::Contains(
                 "m.xml:3:1: error: the peer \"f\" is there twice; the first is at m.xml:2:1"));
  CHECK_THAT(folder.check(kF + R"(<peer name="n" component="n.xml">
<csp component="p.xml"/><csp component="p.xml"/>
<parameter name="Time limit" value="1 s"/><parameter name="Time limit" value="2 s"/></peer>)"),
             Catch::Contains("the CSP \"P\" is there twice") &&
                 Catch::Contains("the parameter \"Time limit\" is there twice"));
  folder.write("d.xml", R"(<component name="D"><interfaces>
    <implements><type>M/IF</type><attribute name="latency" value="1 ms"/><attribute name="latency" value="1 ms"/></implements>
    <implements>M::IF</implements></interfaces></component>)");
  CHECK_THAT(folder.check(R"(<peer name="d" component="d.xml"/>)"),
             Catch::Contains("the attribute \"latency\" is there twice") &&
                 Catch::Contains("d.xml:3:5: error: the interface \"M/IF\" is there twice"));
}

TEST_CASE("Attributes and parameters are compared with the dictionary") {
  ProfileFolder folder;
  const auto [inner, finding] = GENERATE(table<std::string, std::string>({
      {R"(<attribute name="latncy" value="1"/>)",
       "c.xml:2:1: error: the attribute \"latncy\" is unknown; did you mean 'latency'?"},
      {R"(<attribute name="latency" value="fast"/>)",
       "c.xml:2:1: error: \"latency\" is \"fast\", which is no duration in ms; it is defined at "
       "dictionary.xml:2:3"},
      {R"(<attribute name="latency" value="2 s"/>)", "\"latency\" is 2000 ms, more than 1000 ms"},
      {R"(<optional><parameter name="Timelimit"/></optional>)",
       "c.xml:2:11: error: the parameter \"Timelimit\" is unknown; did you mean 'Time limit'?"},
      {R"(<required><parameter name="Time limit"><type>integer</type></parameter></required>)",
       "the parameter \"Time limit\" is a duration, not a integer"},
      {R"(<optional><parameter name="Planner"><type>M/IX</type></parameter></optional>)",
       "the parameter \"Planner\" is a M/IP, not a M/IX"},
  }));
  folder.write("c.xml", "<component name=\"C\"><interfaces><implements><type>M/IF</type>\n" +
                            inner + "</implements></interfaces></component>");
  CHECK_THAT(folder.check(R"(<peer name="c" component="c.xml"/>)"), Catch::Contains(finding));
}

TEST_CASE("A profile's parameters are compared with the component and the dictionary") {
  ProfileFolder folder;
  const auto [parameter, finding] = GENERATE(table<std::string, std::string>({
      {R"(name="Time limt" value="1 s")", "\"N\" has no parameter \"Time limt\"; did you mean"},
      {R"(name="Time limit" value="x")", "\"Time limit\" is \"x\", which is no duration in ms"},
      {R"(name="Time limit" value="0 ms")", "\"Time limit\" is 0 ms, less than 1 ms"},
      {R"(name="Time limit" value="300")",
       "\"Time limit\" is \"300\", which has no unit of time; write \"300 ms\" or \"300 s\""},
      {R"(name="Planner" value="Q")",
       "\"Planner\" refers to \"Q\", which is no peer or CSP with "
       "M/IP; did you mean 'P'?"},
      {R"(name="Planner" value="f")", "\"Planner\" refers to \"f\", which is no peer or CSP"},
      {R"(name="Planner")", "<parameter> has no value"},
  }));
  CHECK_THAT(
      folder.check(kF + "\n" + R"(<peer name="n" component="n.xml"><csp component="p.xml"/>)" +
                   "<parameter " + parameter + "/></peer>"),
      Catch::Contains("m.xml:3:") && Catch::Contains(finding));
}

TEST_CASE("A parameter that the peer's CSPs have, and not the peer, is set at them") {
  ProfileFolder folder;
  folder.write("q.xml", R"(<component name="Q"><interfaces><implements><type>M/IP</type>
<optional><parameter name="Time limit"/></optional></implements></interfaces></component>)");
  folder.write("h.xml", R"(<component name="H"><interfaces><implements>M/IH</implements>
</interfaces><subcomponents><subcomponent>M/IP</subcomponent></subcomponents></component>)");
  const auto file = folder.mission(R"(<peer name="h" component="h.xml"><csp component="q.xml"/>
<csp name="r" component="q.xml"/><csp component="p.xml"/></peer>)");
  CHECK_THROWS_WITH(read_checked_profile(file, {}, {"h.Time limit=1 s"}),
                    "\"H\" has no parameter \"Time limit\"; what it chooses among has it: "
                    "h/Q.Time limit, h/r.Time limit");
  CHECK_NOTHROW(read_checked_profile(file, {}, {"h/Q.Time limit=1 s"}));
}

TEST_CASE("A mission without attributes and parameters needs no dictionary") {
  ProfileFolder folder;
  std::filesystem::remove(folder.path() / "dictionary.xml");
  folder.write("c.xml", R"(<component name="C"/>)");
  CHECK(folder.check(R"(<peer name="c" component="c.xml"/>)") == "");
  CHECK_THAT(folder.check(R"(<peer name="c" component="c.xml">
<parameter name="Speed" value="5"/></peer>)"),
             Catch::Contains("define it in the dictionary, which is dictionary.xml beside the "));
}

TEST_CASE("A unit that nothing is converted into is a mistake of the dictionary") {
  ProfileFolder folder;
  folder.write("dictionary.xml", R"(<dictionary>
<parameter name="Speed" type="real" unit="mps">d</parameter></dictionary>)");
  folder.write("c.xml", R"(<component name="C"><optional><parameter name="Speed"/></optional>
</component>)");
  const auto check = [&](const std::string& value) {
    return folder.check(R"(<peer name="c" component="c.xml">
<parameter name="Speed" value=")" +
                        value + R"("/></peer>)");
  };
  CHECK(check("5 m/s") ==
        "dictionary.xml:2:1: error: \"Speed\" has the unit \"mps\", into which \"5 m/s\" is not "
        "converted (did you mean 'm/s'?); correct it there, or write the value without a unit at "
        "m.xml:3:1\n");
  CHECK(check("5 mps") == "");
  CHECK(check("5") == "");
}

TEST_CASE("A mistake in a component is told there alone, and not once more where it is used") {
  ProfileFolder folder;
  SECTION("a parameter that the dictionary does not have") {
    const std::string group = GENERATE("optional", "required");
    folder.write("c.xml", "<component name=\"C\">\n<" + group +
                              "><parameter name=\"Time limitt\"/></" + group + "></component>");
    CHECK(folder.check(R"(<peer name="c" component="c.xml">
<parameter name="Time limit" value="1 s"/></peer>)") ==
          "c.xml:2:11: error: the parameter \"Time limitt\" is unknown; did you mean 'Time limit'? "
          "(or add it to the dictionary)\n");
  }
  SECTION("an interface that is no name") {
    folder.write("f.xml",
                 "<component name=\"F\"><interfaces>\n<implements>M.IF</implements>"
                 "</interfaces></component>");
    CHECK(
        folder.check(kF + kN) ==
        "f.xml:2:1: error: <implements> holds \"M.IF\" instead of an interface; write a name like "
        "IDL:AE_navigator/IPlanner\n");
  }
}

TEST_CASE("A CSP whose component implements nothing is one finding") {
  ProfileFolder folder;
  folder.write("lone.xml", "<component name=\"Lone\"/>");
  CHECK(folder.check(kF + R"(<peer name="n" component="n.xml">
<csp component="lone.xml"/></peer>)") ==
        "m.xml:3:1: error: the CSP \"Lone\" implements no interface (lone.xml:1:1); add what it "
        "implements to <interfaces> there; an activity is a <peer>\n");
}

TEST_CASE("A service reference to a CSP of the peer is in order") {
  ProfileFolder folder;
  CHECK(folder.check(kF + R"(<peer name="n" component="n.xml"><csp component="p.xml"/>
                             <parameter name="Planner" value="P"/></peer>)") == "");
}

TEST_CASE("A parameter that a component requires must have a value, also one of no interface") {
  ProfileFolder folder;
  folder.write("r.xml", R"(<component name="R"><interfaces><implements><type>M/IF</type>
<required><parameter name="Time limit"/></required></implements></interfaces></component>)");
  folder.write("own.xml", R"(<component name="Own">
<required><parameter name="Time limit"/></required><optional><parameter name="Planner"/></optional>
</component>)");
  const auto [file, missing] = GENERATE(table<std::string, std::string>({
      {"r.xml",
       "m.xml:2:1: error: \"r\" has no value for the parameter \"Time limit\", which its component "
       "requires (r.xml:2:11); write <parameter name=\"Time limit\" value=\"... ms\"/>\n"},
      {"own.xml",
       "m.xml:2:1: error: \"r\" has no value for the parameter \"Time limit\", which its component "
       "requires (own.xml:2:11); write <parameter name=\"Time limit\" value=\"... ms\"/>\n"},
  }));
  const auto peer = [file = file](const std::string& inner) {
    return "<peer name=\"r\" component=\"" + file + "\">" + inner + "</peer>";
  };
  CHECK(folder.check(peer("")) == missing);
  CHECK(folder.check(peer(R"(<parameter name="Time limit" value="1 s"/>)")) == "");
  CHECK_NOTHROW(read_checked_profile(folder.mission(peer("")), {}, {"r.Time limit=1 s"}));
  CHECK_THAT(folder.check(peer(R"(<parameter name="Time limti" value="1 s"/>)")),
             Catch::Contains("has no parameter \"Time limti\"; did you mean 'Time limit'?"));
}

TEST_CASE("A CSP's component requires values, too") {
  ProfileFolder folder;
  folder.write("p.xml", R"(<component name="P"><interfaces><implements><type>M/IP</type>
<required><parameter name="Time limit"/></required></implements></interfaces></component>)");
  CHECK_THAT(folder.check(kF + R"(<peer name="n" component="n.xml">
<csp component="p.xml"/></peer>)"),
             Catch::Contains("m.xml:3:1: error: \"n/P\" has no value for the parameter \"Time "
                             "limit\", which its component requires (p.xml:2:11)"));
}

TEST_CASE("A client that offers no service may be given any parameter of the dictionary") {
  ProfileFolder folder;
  const auto check = [&](const std::string& name) {
    return folder.check(kF + kN + R"(<peer name="g" component="g.xml"><parameter name=")" + name +
                        R"(" value="5 s"/></peer>)");
  };
  CHECK(check("Time limit") == "");
  CHECK_THAT(check("Time_limit"), Catch::Contains("the parameter \"Time_limit\" is unknown"));
}

TEST_CASE("A cycle of dependencies is named once, with its way round") {
  ProfileFolder folder;
  folder.write("a.xml", component("A", "M/IA", {"M/IB"}));
  folder.write("b.xml", component("B", "M/IB", {"M/IC"}));
  folder.write("c.xml", component("C", "M/IC", {"M/IA"}));
  const std::string ring = R"(<peer name="a" component="a.xml"/><peer name="b" component="b.xml"/>
                              <peer name="c" component="c.xml"/>)";
  CHECK(folder.check(ring) ==
        "a.xml:2:1: error: a cycle of dependencies: a -> b -> c -> a; remove one of them, or add a "
        "provider outside of the cycle\n");
  SECTION("a peer that only leads into the cycle is not part of it") {
    folder.write("d.xml", component("D", "M/ID", {"M/IA"}));
    const auto text = folder.check(R"(<peer name="d" component="d.xml"/>)" + ring);
    CHECK_THAT(text, Catch::Contains("a -> b -> c -> a") && !Catch::Contains("-> d"));
    CHECK(std::count(text.begin(), text.end(), '\n') == 1);
  }
  SECTION("a provider outside of the cycle breaks it") {
    folder.write("e.xml", component("E", "M/IC", {}));
    CHECK(folder.check(ring + R"(<peer name="e" component="e.xml"/>)") == "");
  }
}

TEST_CASE("Every one of several cycles is named, a peer that depends on itself too") {
  ProfileFolder folder;
  folder.write("s.xml", component("S", "M/IS", {"M/IS"}));
  folder.write("a.xml", component("A", "M/IA", {"M/IB"}));
  folder.write("b.xml", component("B", "M/IB", {"M/IA"}));
  const auto text = folder.check(R"(<peer name="s" component="s.xml"/>
      <peer name="a" component="a.xml"/><peer name="b" component="b.xml"/>)");
  CHECK_THAT(text, Catch::Contains("s -> s;") && Catch::Contains("a -> b -> a;"));
}

TEST_CASE("One peer at most runs the mission, and it is not restarted") {
  ProfileFolder folder;
  const auto text = folder.check(kF + kN + kG + R"(
<peer name="h" component="g.xml" role="mission" restart="always"/>)");
  CHECK_THAT(text, Catch::Contains("m.xml:3:1: error: a second peer with role=\"mission\"") &&
                       Catch::Contains("\"h\" runs the mission and would be restarted"));
}

TEST_CASE("role=mission with count is told once, and is not the first of itself") {
  ProfileFolder folder;
  CHECK(
      folder.check(kF + kN + R"(
<peer name="g" component="g.xml" role="mission" count="3"/>)") ==
      "m.xml:3:1: error: role=\"mission\" with count: one peer runs the mission; leave count out, "
      "or the role\n");
}

TEST_CASE("Names in findings do not draw on the terminal") {
  ProfileFolder folder;
  const std::string csi = "\xc2\x9b", turn = "\xe2\x80\xae";
  const std::string text = folder.check("<peer name=\"a" + csi + "31m" + turn +
                                        "b\" component=\"no" + turn + ".xml\"/>");
  CHECK(text.find(csi) == std::string::npos);
  CHECK(text.find(turn) == std::string::npos);
  CHECK_THAT(text, Catch::Contains("\"a\\xc2\\x9b31m\\xe2\\x80\\xaeb\" is no name"));
}

TEST_CASE("Process rules for a CSP without a process are a mistake") {
  ProfileFolder folder;
  CHECK_THAT(folder.check(kF + R"(<peer name="n" component="n.xml">
<csp component="p.xml" process="in" restart="always"/></peer>)"),
             Catch::Contains("restart is for processes, and this CSP has none"));
  CHECK_THAT(folder.check(kF + R"(<peer name="n" component="n.xml">
<csp component="p.xml" process="inside"/></peer>)"),
             Catch::Contains("\"inside\" is no place for a CSP"));
}

TEST_CASE("A CSP that is isolated must have a process of its own") {
  ProfileFolder folder;
  const auto findings = [&](const std::string& isolated, const std::string& process) {
    folder.write("p.xml",
                 "<component name=\"P\"><interfaces><implements><type>M/IP</type>\n"
                 "<attribute name=\"isolated\" value=\"" +
                     isolated + "\"/></implements></interfaces></component>");
    return folder.check(
        kF + "<peer name=\"n\" component=\"n.xml\">\n<csp component=\"p.xml\" process=\"" +
        process + "\"/></peer>");
  };
  CHECK_THAT(
      findings("true", "in"),
      Catch::Contains("m.xml:3:1: error: the CSP \"P\" works in its entity's process, but is "
                      "isolated (p.xml:2:1)") &&
          Catch::Contains("write process=\"own\""));
  CHECK(findings("true", "own") == "");
  CHECK(findings("false", "in") == "");
}

TEST_CASE("Several processes on loopback are an error, one process is not") {
  ProfileFolder folder;
  const auto file = folder.mission(R"(<peer name="f" component="f.xml" vendor="loopback"/>
                                      <peer name="e" component="f.xml"/>)");
  const auto findings = check_file(file);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == Severity::Error);
  CHECK_THROWS_AS(read_checked_profile(file), DescriptionError);
  CHECK(folder.check(R"(<peer name="f" component="f.xml" vendor="loopback"/>)") == "");
}

TEST_CASE("All mistakes of all files are found in one go") {
  ProfileFolder folder;
  folder.write("c.xml", R"(<component name="C"><interfaces><implements><type>M/IF</type>
<attribute name="speed" value="1"/></implements></interfaces>
<dependencies><depends>M/IQ</depends></dependencies></component>)");
  const auto text = folder.check(R"(<peer name="c" component="c.xml" vendor="opendds"/>
<peer name="n" component="n.xml"/>
<peer name="x" component="none.xml"/>)");
  CHECK_THAT(text, Catch::Contains("is no DDS vendor") && Catch::Contains("\"speed\" is unknown") &&
                       Catch::Contains("depends on M/IQ") &&
                       Catch::Contains("no CSP for its subcomponent") &&
                       Catch::Contains("none.xml: error: cannot be opened"));
}

TEST_CASE("A component that several peers share is blamed once") {
  ProfileFolder folder;
  folder.write("c.xml", R"(<component name="C"><interfaces><implements><type>M/IF</type>
<attribute name="speed" value="1"/></implements></interfaces></component>)");
  const auto text =
      folder.check(R"(<peer name="a" component="c.xml"/><peer name="b" component="c.xml"/>)");
  CHECK(std::count(text.begin(), text.end(), '\n') == 1);
}
