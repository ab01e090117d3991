// What the schemas say, which the reader takes for what may stand in a file.
#include <catch2/catch.hpp>
#include <pugixml.hpp>
#include <set>

#include "dds/port/vendor_names.hpp"
#include "test/tools/places.hpp"

using skein::test::project_file;

namespace {

pugi::xml_document schema(const std::string& name) {
  pugi::xml_document document;
  REQUIRE(document.load_file(project_file("mission_profiles/schema/" + name).c_str()));
  return document;
}

}  // namespace

TEST_CASE("The schema knows the vendors that the library knows") {
  const auto mission = schema("mission.xsd");
  std::set<std::string> words;
  for (const auto& word : mission.select_nodes("//*[@name='Vendor']//xs:enumeration/@value"))
    words.insert(word.attribute().value());
  const auto& vendors = skein::dds::vendor_names();
  CHECK(words == std::set<std::string>(vendors.begin(), vendors.end()));
}

TEST_CASE("Everything that an editor offers is documented") {
  const std::string file = GENERATE("mission.xsd", "component.xsd", "dictionary.xsd");
  const auto document = schema(file);
  const auto root = document.document_element();
  const auto documented = [](const pugi::xml_node& node) {
    return !std::string(node.child("xs:annotation").child_value("xs:documentation")).empty();
  };
  for (const auto& found : root.select_nodes("//xs:attribute | //xs:element")) {
    const auto node = found.node();
    CAPTURE(file, node.attribute("name").value());
    const std::string type = node.attribute("type").value();
    const auto of_type = root.find_child_by_attribute("xs:complexType", "name", type.c_str());
    CHECK((documented(node) || documented(of_type) || documented(node.child("xs:complexType"))));
  }
}
