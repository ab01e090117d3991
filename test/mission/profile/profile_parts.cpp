#include <catch2/catch.hpp>
#include <filesystem>

#include "profile_folder.hpp"

using namespace skein::profile;

namespace {

std::vector<std::string> names_of(const MissionProfile& mission) {
  std::vector<std::string> names;
  for (const auto& peer : mission.peers) names.push_back(peer.name);
  return names;
}

}  // namespace

TEST_CASE("What a part holds stands in the place of its include") {
  ProfileFolder folder;
  folder.write("part.xml", R"(<part><peer name="b" component="f.xml"/>
<peer name="c" component="f.xml"/></part>)");
  CHECK(names_of(read_mission_profile(folder.mission(R"(<peer name="a" component="f.xml"/>
<include file="part.xml"/><peer name="d" component="f.xml"/>)"))) ==
        std::vector<std::string>{"a", "b", "c", "d"});
}

TEST_CASE("Parts go into groups and peers as well") {
  ProfileFolder folder;
  folder.write("csps.xml", R"(<part><csp component="p.xml"/>
<parameter name="Time limit" value="5 s"/></part>)");
  folder.write("peers.xml", R"(<part><peer name="n" component="n.xml"><include file="csps.xml"/>
</peer></part>)");
  const auto mission = read_mission_profile(
      folder.mission(R"(<group name="g" vendor="cyclonedds"><include file="peers.xml"/></group>)"));
  REQUIRE(mission.peers.size() == 1);
  CHECK(mission.peers[0].csps.size() == 1);
  CHECK(mission.peers[0].parameters.size() == 1);
  CHECK(mission.peers[0].vendor == "cyclonedds");
}

TEST_CASE("Files are relative to the file that names them") {
  ProfileFolder folder;
  std::filesystem::create_directory(folder.path() / "sub");
  std::filesystem::create_directory(folder.path() / "sub/deep");
  folder.write("sub/part.xml", R"(<part><include file="deep/part.xml"/></part>)");
  folder.write(
      "sub/deep/part.xml",
      R"(<part><peer name="f" component="../../f.xml"/><peer name="g" program="./g"/></part>)");
  const auto mission = read_mission_profile(folder.mission(R"(<include file="sub/part.xml"/>)"));
  REQUIRE(mission.peers.size() == 2);
  CHECK(mission.peers[0].component->name == "F");
  std::string files;
  for (const auto& file : mission.files) files += file.string() + " ";
  CHECK(folder.without_folder(files) ==
        "dictionary.xml f.xml m.xml sub/deep/part.xml sub/part.xml ");
  CHECK(mission.peers[1].start.program == (folder.path() / "sub/deep/g").string());
}

TEST_CASE("Findings name the file and the line of the part") {
  ProfileFolder folder;
  folder.write("part.xml", R"(<part>
  <peer name="f" component="f.xml" vendr="fastdds"/>
  <per name="f" component="f.xml"/>
</part>)");
  const auto text = folder.check(R"(<include file="part.xml"/>)");
  CHECK_THAT(text, Catch::Contains("part.xml:2:36: error: <peer> has no \"vendr\"; did you mean "
                                   "'vendor'?\n"));
  CHECK_THAT(text, Catch::Contains("part.xml:3:3: error: <per> is unknown in <part>; did you mean "
                                   "'peer'?\n"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 2);
}

TEST_CASE("An element that does not belong where its part is included is a finding in the part") {
  ProfileFolder folder;
  folder.write("part.xml", "<part>\n<csp component=\"p.xml\"/></part>");
  CHECK_THAT(folder.check(R"(<peer name="f" component="f.xml"/><include file="part.xml"/>)"),
             Catch::Contains("part.xml:2:1: error: <csp> is unknown in <mission>"));
}

TEST_CASE("A circle of includes is named with its way round") {
  ProfileFolder folder;
  folder.write("a.xml", "<part>\n<include file=\"b.xml\"/></part>");
  folder.write("b.xml", "<part>\n  <include file=\"./../" + folder.path().filename().string() +
                            "/a.xml\"/></part>");
  CHECK_THAT(folder.check("<include file=\"a.xml\"/><peer name=\"f\" component=\"f.xml\"/>"),
             Catch::Contains("b.xml:2:12: error: a circle of includes: a.xml -> b.xml -> a.xml; "
                             "remove one of them\n"));
  CHECK_THAT(folder.check("<include file=\"m.xml\"/><peer name=\"f\" component=\"f.xml\"/>"),
             Catch::Contains("m.xml:2:10: error: a circle of includes: m.xml -> m.xml"));
}

TEST_CASE("A part that is missing, no part, or no XML is a finding") {
  ProfileFolder folder;
  folder.write("planners.xml", "<part/>");
  folder.write("mission.xml", "<mission name=\"m\"/>");
  folder.write("broken.xml", "<part>\n<peer</part>");
  const auto [content, finding] = GENERATE(table<std::string, std::string>({
      {R"(<include file="planer.xml"/>)",
       "m.xml:2:10: error: the part \"planer.xml\" cannot be read; the next finding says why\n"
       "planer.xml: error: cannot be opened: No such file or directory; check the path (did you "
       "mean 'planners.xml'?)\n"},
      {R"(<include file="mission.xml"/>)",
       "mission.xml:1:1: error: <mission> is no part of a profile; the outermost element of what "
       "is included is <part>\n"},
      {R"(<include file="broken.xml"/>)",
       "broken.xml:2:1: error: malformed XML: the tag <peer has no end"},
      {R"(<include/>)", "m.xml:2:1: error: <include> has no file"},
      {R"(<include file=""/>)", "<include> has an empty file"},
      {R"(<include href="planners.xml"/>)", "<include> has no \"href\"; known is \"file\""},
      {R"(<include file="/dev/zero"/>)", "is no regular file"},
  }));
  CAPTURE(content);
  CHECK_THAT(folder.check(content + R"(<peer name="f" component="f.xml"/>)"),
             Catch::Contains(finding));
}

TEST_CASE("A profile can give the variables of its parts other defaults") {
  ProfileFolder folder;
  folder.write("part.xml", R"(<part><variable name="system" default="uav-1"/>
<peer name="f" component="f.xml" system="${system}"/></part>)");
  const std::string include = R"(<include file="part.xml"/>)";
  CHECK(read_mission_profile(folder.mission(include)).peers[0].system == "uav-1");
  CHECK(
      read_mission_profile(folder.mission(R"(<variable name="system" default="uav-2"/>)" + include))
          .peers[0]
          .system == "uav-2");
}

TEST_CASE("A part may be chosen by a variable") {
  ProfileFolder folder;
  folder.write("small.xml", R"(<part><peer name="f" component="f.xml"/></part>)");
  folder.write("large.xml", R"(<part><peer name="f" component="f.xml" count="3"/></part>)");
  const auto file = folder.mission(R"(<variable name="size" default="small"/>
<include file="${size}.xml"/>)");
  CHECK(read_mission_profile(file).peers.size() == 1);
  CHECK(read_mission_profile(file, {{"size", "large"}}).peers.size() == 3);
}

TEST_CASE("Parts that make much of little are cut off") {
  ProfileFolder folder;
  const int width = GENERATE(2, 200);
  for (int i = 0; i < 20; ++i) {
    std::string content;
    for (int k = 0; k < width; ++k) {
      content += "<include file=\"p" + std::to_string(i + 1) + ".xml\"/>";
    }
    folder.write("p" + std::to_string(i) + ".xml", "<part>" + content + "</part>");
  }
  folder.write("p20.xml", R"(<part><peer name="f" component="f.xml"/></part>)");
  CHECK_THAT(folder.check(R"(<include file="p0.xml"/>)"),
             Catch::Contains("the profile has too many parts"));
}

TEST_CASE("What an editor reads of a schema is no mistake") {
  ProfileFolder folder;
  folder.write("part.xml", R"(<?xml-model href="mission.xsd"?>
<part xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="m.xsd">
<peer name="f" component="f.xml"/></part>)");
  CHECK(folder.check(R"(<include file="part.xml"/>)") == "");
}
