#include <catch2/catch.hpp>
#include <fstream>
#include <random>
#include <sstream>

#include "profile_folder.hpp"
#include "test/tools/places.hpp"

using namespace skein::profile;
using skein::test::project_file;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

std::string content_of(const std::string& name) {
  std::ifstream file(project_file("mission_profiles/" + name), std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t limit) { return random() % limit; };
  for (std::size_t count = 1 + below(4); count > 0 && !text.empty(); --count) {
    const std::size_t at = below(text.size());
    switch (below(5)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.erase(at, 1 + below(20));
        break;
      case 2:
        text.insert(at, text.substr(below(text.size()), 1 + below(60)));
        break;
      case 3:
        text.insert(at, 1, "<>&\"'/=;#!?[]- "[below(15)]);
        break;
      default:
        text.resize(at);
        break;
    }
  }
  return text;
}

}  // namespace

TEST_CASE("A mutated component or dictionary is read or refused, nothing else") {
  const std::string seed = content_of(
      GENERATE(as<std::string>(), "route_planning/components/navigator.xml", "dictionary.xml"));
  REQUIRE(seed.size() > 100);
  std::mt19937 random(7);
  for (int i = 0; i < 5000; ++i) {
    const std::string text = mutated(seed, random);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  SUCCEED();
}

TEST_CASE("A mutated mission is read or refused, and its refusal names a place") {
  ProfileFolder folder;
  const std::string mission = R"(<mission name="m" domain="${d}" vendor="fastdds">
  <variable name="d" default="3"/><variable name="size" default="${d}"/>
  <environment name="LANG" value="C"/>
  <include file="part.xml"/>
  <group name="all" restart="on-failure" max_restarts="${size}"><include file="inner.xml"/>
    <peer name="n" component="n.xml" count="${d}" history="${instance}$$">
      <csp component="p.xml" process="own"><parameter name="Time limit" value="5 s"/></csp>
    </peer>
  </group>
  <peer name="tool" program="true" process_cpus="0-${d}"><argument value="${size}"/></peer>
  <peer name="g" component="g.xml" role="mission"/>
</mission>)";
  const std::string part = R"(<part><variable name="size" default="2"/><include file="inner.xml"/>
  <peer name="f" component="f.xml"/><include file="inner.xml"/></part>)";
  const std::string inner = R"(<part><variable name="x" default="${size}${size}"/>
  <peer name="e${x}" component="f.xml"/></part>)";
  std::mt19937 random(11);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    folder.write("m.xml", i % 3 == 0 ? mutated(mission, random) : mission);
    folder.write("part.xml", i % 3 == 1 ? mutated(part, random) : part);
    folder.write("inner.xml", i % 3 == 2 ? mutated(inner, random) : inner);
    for (const auto& finding : check_file(folder.path() / "m.xml", {{"size", "4"}})) {
      REQUIRE(!finding.where.file.empty());
      REQUIRE(!finding.problem.empty());
      ++refused;
    }
  }
  CHECK(refused > 1000);
}
