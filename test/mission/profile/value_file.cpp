#include "mission/profile/value_file.hpp"

#include <catch2/catch.hpp>

#include "profile_folder.hpp"

using namespace skein::profile;
using Catch::Contains;

namespace {

/// A folder with a text, too, in the dictionary and in a component.
class ListFolder : public ProfileFolder {
 public:
  ListFolder() {
    write("dictionary.xml", R"(<dictionary>
  <parameter name="Sites" type="text">d</parameter>
  <parameter name="Count" type="integer" min="0" max="9">d</parameter>
</dictionary>)");
    write("f.xml", R"(<component name="F"><interfaces><implements><type>M/IF</type><optional>
  <parameter name="Sites"/><parameter name="Count"/></optional></implements></interfaces>
</component>)");
  }

  std::filesystem::path with(const std::string& parameter, const std::string& before = "") {
    return mission(before + R"(<peer name="f" component="f.xml">)" + "\n" + parameter + "</peer>");
  }

  std::string findings(const std::filesystem::path& file, const VariableValues& values = {}) {
    return without_folder(to_text(check_file(file, values)));
  }
};

const std::string kSites = R"(<parameter name="Sites" value="@sites.txt"/>)";
const std::string kGiven = R"(<parameter name="Sites" value="${sites}"/>)";

}  // namespace

TEST_CASE("A value that begins with @ is the text of a file beside the profile") {
  ListFolder folder;
  folder.write("sites.txt", "\nfirst 1 2\r\nsecond 3 4\n\n");
  const auto mission = read_mission_profile(folder.with(kSites));
  const Setting& setting = mission.peers[0].parameters[0];
  CHECK(setting.value == "\nfirst 1 2\r\nsecond 3 4");
  CHECK(setting.file == (folder.path() / "sites.txt").string());
  CHECK(setting.value_where == SourcePosition{setting.file, 0, 0});
  CHECK(setting.where.line == 3);
  CHECK(mission.files.contains(folder.path() / "sites.txt"));
}

TEST_CASE("Two @ are one, and one behind the beginning is itself") {
  ListFolder folder;
  const auto [value, is] = GENERATE(
      table<std::string, std::string>({{"@@home", "@home"}, {"me@home", "me@home"}, {"@@", "@"}}));
  const auto mission =
      read_mission_profile(folder.with("<parameter name=\"Sites\" value=\"" + value + "\"/>"));
  CHECK(mission.peers[0].parameters[0].value == is);
}

TEST_CASE("A file that a variable names is looked for beside the file that defines the variable") {
  ListFolder folder;
  std::filesystem::create_directory(folder.path() / "parts");
  folder.write("parts/part.xml", R"(<part><variable name="list" default="@sites.txt"/></part>)");
  folder.write("parts/sites.txt", "near");
  folder.write("sites.txt", "far");
  const std::string through =
      R"(<include file="parts/part.xml"/><variable name="sites" default="${list}"/>)";
  CHECK(read_mission_profile(folder.with(kGiven, through)).peers[0].parameters[0].value == "near");
}

TEST_CASE("A file from the command line is looked for in the current folder") {
  ListFolder folder;
  folder.write("sites.txt", "near");
  const auto file = folder.with(kGiven, R"(<variable name="sites" default="none"/>)");
  const auto relative = std::filesystem::relative(folder.path() / "sites.txt").string();
  auto mission = read_mission_profile(file, {{"sites", "@" + relative}});
  CHECK(mission.peers[0].parameters[0].value == "near");
  folder.write("sites.txt", "far");
  apply_setting(mission, "f.Sites=@" + relative);
  CHECK(mission.peers[0].parameters[0].value == "far");
  CHECK_THROWS_WITH(apply_setting(mission, "f.Sites=@nowhere.txt"), Contains("nowhere.txt: error"));
  CHECK(assignment_with_whole_path("sites=@a/../b.txt") ==
        "sites=@" + (std::filesystem::current_path() / "b.txt").string());
  CHECK(assignment_with_whole_path("f.Sites=@@b") == "f.Sites=@@b");
  CHECK(assignment_with_whole_path("sites=b@c") == "sites=b@c");
}

TEST_CASE("A file that cannot be a value is a finding that names both") {
  ListFolder folder;
  const auto [text, finding] = GENERATE(table<std::string, std::string>({
      {"", "sites.txt: error: is empty; write the value into it"},
      {" \n\n", "sites.txt: error: is empty"},
      {std::string("a\nb\0c", 5), "sites.txt:2:2: error: a NUL byte"},
      {"a\n\xff", "sites.txt:2:1: error: bytes that are no UTF-8"},
      {std::string(kLargestValueFile + 1, 'a'),
       "sites.txt: error: is larger than 1 MiB, too large a value; shorten it"},
  }));
  folder.write("sites.txt", text);
  CHECK_THAT(folder.findings(folder.with(kSites)),
             Contains("m.xml:3:1: error: the value of \"Sites\" cannot be read from a file") &&
                 Contains(finding));
}

TEST_CASE("A value that the dictionary refuses is told where it stands") {
  ListFolder folder;
  folder.write("count.txt", "ten\n");
  const std::string variable = R"(<variable name="count" default="10"/>)";
  const std::string count = R"(<parameter name="Count" value="${count}"/>)";
  CHECK_THAT(folder.findings(folder.with(R"(<parameter name="Count" value="@count.txt"/>)")),
             Contains("count.txt: error: \"Count\" is \"ten\", which is no integer"));
  CHECK_THAT(folder.findings(folder.with(count, variable)),
             Contains("m.xml:2:1: error: \"Count\" is 10, more than 9"));
  CHECK_THAT(folder.findings(folder.with(count, variable), {{"count", "11"}}),
             Contains("--variable count: error: \"Count\" is 11, more than 9"));
  CHECK_THAT(
      folder.findings(folder.with(R"(<parameter name="Count" value="1${count}"/>)", variable)),
      Contains("m.xml:3:1: error: \"Count\" is 110, more than 9"));
}
