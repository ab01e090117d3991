// The profiles in mission_profiles/README.md are in the notation that the reader takes.
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "profile_folder.hpp"
#include "test/tools/places.hpp"

using namespace skein::profile;
using skein::test::project_file;

namespace {

/// The texts between ```xml and ```.
std::vector<std::string> examples() {
  std::ifstream file(project_file("mission_profiles/README.md"));
  std::vector<std::string> found;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line == "```xml") found.emplace_back();
    inside = line == "```xml" || (inside && line != "```");
    if (inside && line != "```xml") found.back() += line + "\n";
  }
  return found;
}

/// A whole profile around what is only a piece of one.
std::string whole(const std::string& piece) {
  if (piece.starts_with("<mission")) return piece;
  return "<mission name=\"m\">\n" + piece + "</mission>\n";
}

}  // namespace

TEST_CASE("The profiles of the README hold nothing that the reader does not know") {
  int profiles = 0;
  for (const std::string& example : examples()) {
    CAPTURE(example);
    const bool is_part = example.starts_with("<part");
    if (!is_part && example.find("<peer") == std::string::npos) continue;
    ++profiles;
    ProfileFolder folder;
    folder.write("part.xml", example);
    const auto file =
        folder.mission(R"(<peer name="n" component="n.xml"><include file="part.xml"/></peer>)");
    if (!is_part) folder.write("m.xml", whole(example));
    VariableValues values;
    if (example.find("<variable name=\"vendor\"/>") != std::string::npos)
      values["vendor"] = "fastdds";
    std::vector<Finding> findings;
    read_mission_profile(file, findings, values);
    for (const auto& finding : findings) {
      // Their components are elsewhere.
      CHECK_THAT(finding.problem, Catch::Contains("cannot be "));
    }
  }
  CHECK(profiles == 8);
}
