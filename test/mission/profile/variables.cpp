#include <catch2/catch.hpp>

#include "profile_folder.hpp"

using namespace skein::profile;

namespace {

std::string findings_of_mission(ProfileFolder& folder, const std::string& content,
                                const VariableValues& values = {}) {
  return folder.without_folder(to_text(check_file(folder.mission(content), values)));
}

const std::string kVendor = R"(<variable name="vendor" default="cyclonedds"/>)";
const std::string kPeer = R"(<peer name="f" component="f.xml" vendor="${vendor}"/>)";

}  // namespace

TEST_CASE("A variable has its default, unless it is given another value") {
  ProfileFolder folder;
  const auto file = folder.mission(kVendor + kPeer);
  CHECK(read_mission_profile(file).peers[0].vendor == "cyclonedds");
  CHECK(read_mission_profile(file, {{"vendor", "fastdds"}}).peers[0].vendor == "fastdds");
}

TEST_CASE("A variable stands for a part of a value, several times, and in other variables") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(R"(<variable name="n" default="7"/>
<variable name="name" default="uav-${n}"/>
<peer name="f${n}" component="f.xml" system="${name}${n}"/>)"));
  CHECK(mission.peers[0].name == "f7");
  CHECK(mission.peers[0].system == "uav-77");
}

TEST_CASE("Variables are known in the attributes of the mission itself") {
  ProfileFolder folder;
  const auto file = folder.path() / "v.xml";
  folder.write("v.xml", R"(<mission name="m" domain="${d}" vendor="${v}">
<variable name="d" default="5"/><variable name="v" default="cyclonedds"/>
<peer name="f" component="f.xml"/></mission>)");
  const auto mission = read_mission_profile(file);
  CHECK(mission.domain == 5);
  CHECK(mission.peers[0].vendor == "cyclonedds");
}

TEST_CASE("Two dollars are one") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(
      R"(<peer name="f" program="sh"><argument value="echo $$HOME $${x} $$$$"/></peer>)"));
  CHECK(mission.peers[0].start.arguments[0] == "echo $HOME ${x} $$");
}

TEST_CASE("What is wrong with a variable is a finding where it stands") {
  ProfileFolder folder;
  const auto [content, finding] = GENERATE(table<std::string, std::string>({
      {R"(<peer name="f" component="f.xml" vendor="${vendr}"/>)",
       "m.xml:2:80: error: the variable \"vendr\" is unknown here; did you mean 'vendor'?\n"},
      {R"(<peer name="f" component="f.xml" system="$HOME"/>)",
       "m.xml:2:80: error: \"$HOME\" holds a lone \"$\"; write ${name} for a variable's value, $$ "
       "for a dollar\n"},
      {R"(<peer name="f" component="f.xml" system="${vendor"/>)", "holds a lone \"$\""},
      {R"(<peer name="f-${instance}" component="f.xml"/>)",
       "m.xml:2:53: error: ${instance} stands outside of a peer with count=\"...\"; write "
       "count=\"...\" at the <peer>\n"},
      {R"(<variable name="instance" default="1"/>)" + kPeer,
       "the variable \"instance\" has a meaning of its own"},
      {R"(<variable name="vendor" default="fastdds"/>)" + kPeer,
       "m.xml:2:47: error: the variable \"vendor\" is there twice; the first is at m.xml:2:1\n"},
      {R"(<variable name="speed"/>)" + kPeer,
       "m.xml:2:47: error: the variable \"speed\" has no value; give it one by --variable "
       "speed=VALUE, or write default=\"...\"\n"},
      {R"(<variable name="a b" default="1"/>)" + kPeer, "\"a b\" is no name"},
      {R"(<variable default="1"/>)" + kPeer, "<variable> has no name"},
      {R"(<variable name="later" default="${after}"/><variable name="after" default="1"/>)" + kPeer,
       "the variable \"after\" is unknown here"},
  }));
  CAPTURE(content);
  CHECK_THAT(findings_of_mission(folder, kVendor + content), Catch::Contains(finding));
}

TEST_CASE("A value that cannot be worked out is one finding, not several") {
  ProfileFolder folder;
  const auto text = findings_of_mission(folder, R"(<variable name="x"/>
<peer name="${x}" component="${x}" vendor="${x}" restart="${x}" threads="${y}"/>)");
  CHECK(std::count(text.begin(), text.end(), '\n') == 2);
}

TEST_CASE("A variable without a default takes its value from the command line") {
  ProfileFolder folder;
  const auto file = folder.mission(R"(<variable name="s"/>
<peer name="f" component="f.xml" system="${s}"/>)");
  CHECK(read_mission_profile(file, {{"s", "uav-3"}}).peers[0].system == "uav-3");
}

TEST_CASE("A value for a variable that there is not is a finding with the nearest") {
  ProfileFolder folder;
  CHECK(findings_of_mission(folder, kVendor + kPeer, {{"vendr", "fastdds"}}) ==
        "m.xml: error: there is no variable \"vendr\", which --variable sets; did you mean "
        "'vendor'?\n");
  CHECK(findings_of_mission(folder, R"(<peer name="f" component="f.xml"/>)",
                            {{"vendor", "fastdds"}}) ==
        "m.xml: error: there is no variable \"vendor\", which --variable sets; the profile has "
        "none\n");
}

TEST_CASE("A value from the command line is text, whatever is in it") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(R"(<variable name="s" default="1"/>
<peer name="f" program="sh"><argument value="${s}"/></peer>)"),
                                            {{"s", "$HOME ${s} \"<&"}});
  CHECK(mission.peers[0].start.arguments[0] == "$HOME ${s} \"<&");
}

TEST_CASE("What is no assignment is refused") {
  CHECK(parse_variables({"a=1", "b=", "c=d=e"}) ==
        VariableValues{{"a", "1"}, {"b", ""}, {"c", "d=e"}});
  CHECK_THROWS_WITH(parse_variables({"a"}), "\"a\" sets no variable; write NAME=VALUE");
  CHECK_THROWS_WITH(parse_variables({"=1"}), Catch::Contains("sets no variable"));
}

TEST_CASE("Variables that double each other do not fill the memory") {
  ProfileFolder folder;
  std::string content = R"(<variable name="v0" default="0123456789"/>)";
  for (int i = 1; i < 100; ++i) {
    const std::string before = "${v" + std::to_string(i - 1) + "}";
    content +=
        "<variable name=\"v" + std::to_string(i) + "\" default=\"" + before + before + "\"/>";
  }
  CHECK_THAT(findings_of_mission(folder,
                                 content + R"(<peer name="f" component="f.xml" system="${v99}"/>)"),
             Catch::Contains("with its variables, the value is longer than 4096 characters"));
}
