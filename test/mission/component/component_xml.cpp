#include "mission/component/component_xml.hpp"

#include <catch2/catch.hpp>

using namespace skein::profile;

namespace {

// The paper's Figures 2 and 5 as they are printed.
const std::string kFigure2 = R"(<component name="Navigator">
  <interfaces>
    <implements>
      <type>IDL:AE_navigatorI/INavigator</type>
      <optional>
        <parameter name="Planner">
          <type>IDL:AE_navigator/IPlanner</type>
        </parameter>
        <parameter name="Time limit"></parameter>
      </optional>
      <attribute name="latency" value="100 ms" />
    </implements>
  </interfaces>
  <dependencies>
    <depends>IDL:AE_flightControllerI/IFlightController
  </depends>
  </dependencies>
  <subcomponents>
    <subcomponent>IDL:AE_navigator/IPlanner</subcomponent>
  </subcomponents>
</component>
)";

const std::string kFigure5 = R"(<component name="AStar">
  <interfaces>
    <implements>AE_navigator/IPlanner</implements>
  </interfaces>
</component>
)";

std::vector<std::string> findings_of(const std::string& xml) {
  std::vector<std::string> texts;
  try {
    parse_component(xml, "c.xml");
  } catch (const DescriptionError& error) {
    for (const auto& finding : error.findings()) texts.push_back(to_text(finding));
  }
  return texts;
}

}  // namespace

TEST_CASE("The paper's description of the navigator is read as printed") {
  const auto component = parse_component(kFigure2, "figure2.xml");
  CHECK(component.name == "Navigator");
  REQUIRE(component.interfaces.size() == 1);
  const auto& implemented = component.interfaces[0];
  CHECK(implemented.type == "AE_navigatorI/INavigator");
  CHECK(implemented.required.empty());
  REQUIRE(implemented.optional.size() == 2);
  CHECK(implemented.optional[0].name == "Planner");
  CHECK(implemented.optional[0].type == "AE_navigator/IPlanner");
  CHECK(implemented.optional[1].name == "Time limit");
  CHECK(implemented.optional[1].type.empty());
  REQUIRE(implemented.find_attribute("latency") != nullptr);
  CHECK(implemented.find_attribute("latency")->value == "100 ms");
  REQUIRE(component.dependencies.size() == 1);
  CHECK(component.dependencies[0].type == "AE_flightControllerI/IFlightController");
  CHECK(component.has_subcomponent("AE_navigator::IPlanner"));
}

TEST_CASE("The paper's description of a CSP is read as printed") {
  const auto component = parse_component(kFigure5, "figure5.xml");
  CHECK(component.name == "AStar");
  REQUIRE(component.interfaces.size() == 1);
  CHECK(component.find_interface("IDL:AE_navigator/IPlanner:1.0") == &component.interfaces[0]);
  CHECK(component.dependencies.empty());
}

TEST_CASE("Everything in a description knows its line and column") {
  const auto component = parse_component(kFigure2, "figure2.xml");
  CHECK(to_text(component.where) == "figure2.xml:1:1");
  CHECK(to_text(component.interfaces[0].where) == "figure2.xml:3:5");
  CHECK(to_text(component.interfaces[0].optional[1].where) == "figure2.xml:9:9");
  CHECK(to_text(component.interfaces[0].attributes[0].where) == "figure2.xml:11:7");
  CHECK(to_text(component.dependencies[0].where) == "figure2.xml:15:5");
  CHECK(to_text(component.subcomponents[0].where) == "figure2.xml:19:5");
}

TEST_CASE("Columns count characters, not bytes, also in long lines and behind a byte order mark") {
  const std::string umlauts(400, 'x');
  std::string wide;
  for (int i = 0; i < 400; ++i) wide += "\xC3\xA4";
  const auto column = [](const std::string& comment) {
    return parse_component("<!--" + comment + "--><component name=\"A\"/>", "c.xml").where.column;
  };
  CHECK(column(wide) == column(umlauts));
  CHECK(parse_component("\xEF\xBB\xBF<component name=\"A\"/>", "c.xml").name == "A");
}

TEST_CASE("A written description reads back as the same description") {
  const auto figure = GENERATE(kFigure2, kFigure5);
  const auto once = write_component(parse_component(figure, "a"));
  CHECK(write_component(parse_component(once, "b")) == once);
  CHECK(once.find("IDL:") != std::string::npos);
}

TEST_CASE("Names with markup survive writing and reading") {
  ComponentDescription component;
  component.name = "A<&\"'>B \xC3\xA4";
  component.interfaces.push_back({"M/I", {{"r", "integer", {}}}, {}, {{"a&b", "<1>", {}}}, {}});
  component.required = {{"Period", "", {}}};
  component.optional = {{"Speed", "real", {}}};
  const auto read = parse_component(write_component(component), "c.xml");
  REQUIRE(read.required_parameters().size() == 2);
  CHECK(read.required_parameters()[0]->name == "Period");
  CHECK(read.parameters().size() == 3);
  CHECK(read.optional.at(0).type == "real");
  CHECK(read.name == component.name);
  REQUIRE(read.interfaces.size() == 1);
  CHECK(read.interfaces[0].required.at(0).type == "integer");
  REQUIRE(read.interfaces[0].find_attribute("a&b") != nullptr);
  CHECK(read.interfaces[0].find_attribute("a&b")->value == "<1>");
}

TEST_CASE("An unknown element or attribute is named with its place and the nearest known one") {
  CHECK(findings_of("<component name=\"A\">\n  <interface/>\n</component>") ==
        std::vector<std::string>{"c.xml:2:3: error: <interface> is unknown in <component>; did you "
                                 "mean 'interfaces'?"});
  CHECK(findings_of("<component nam=\"A\"/>") ==
        std::vector<std::string>{
            "c.xml:1:12: error: <component> has no \"nam\"; did you mean 'name'?",
            "c.xml:1:1: error: <component> has no name; write name=\"...\""});
}

TEST_CASE("All that is wrong with a description is told in one go") {
  const auto findings = findings_of(R"(<component name="A" name="B">
  <interfaces>
    <implements>not an interface</implements>
    <implements><type>M/I</type>M/I</implements>
    <implements/>
  </interfaces>
  <dependencies>stray</dependencies>
  <dependencies><depends>M/J</depends></dependencies>
</component>)");
  std::string text;
  for (const auto& finding : findings) text += finding + "\n";
  CHECK_THAT(text,
             Catch::Contains("c.xml:1:21: error: \"name\" is given twice") &&
                 Catch::Contains("c.xml:3:5: error: <implements> holds \"not an interface\"") &&
                 Catch::Contains("c.xml:4:5: error: <implements> names an interface twice") &&
                 Catch::Contains("c.xml:5:5: error: <implements> holds nothing") &&
                 Catch::Contains("c.xml:7:3: error: <dependencies> holds the text \"stray\"") &&
                 Catch::Contains("c.xml:8:3: error: a second <dependencies>"));
  CHECK(findings.size() == 6);
}

TEST_CASE("Another document is told apart from a component description") {
  CHECK(findings_of("<mission/>") ==
        std::vector<std::string>{"c.xml:1:1: error: <mission> is no component description; its "
                                 "outermost element is <component name=\"...\">"});
}
