// The schemas for editors have the elements and attributes that the reader has, and no others.
#include <catch2/catch.hpp>
#include <map>
#include <pugixml.hpp>
#include <set>

#include "../tools/places.hpp"
#include "dds/vendor_names.hpp"
#include "profile/notation.hpp"

using namespace skein::profile;
using skein::test::project_file;

namespace {

/// What may stand in an element, without documentation and types.
struct Shape {
  std::set<std::string> attributes;
  std::map<std::string, Shape> children;
  bool text = false;
};

Shape shape_of(const Notation& notation) {
  Shape shape{{notation.attributes.begin(), notation.attributes.end()}, {}, notation.text};
  for (const auto& child : notation.children) {
    shape.children.emplace(child.name, shape_of(child));
  }
  return shape;
}

class Schema {
 public:
  explicit Schema(const std::string& name) {
    const std::string file = project_file("mission_profiles/schema/" + name);
    REQUIRE(document_.load_file(file.c_str()));
  }

  pugi::xml_node root() const { return document_.document_element(); }

  Shape element(const std::string& name) const { return shape_of(named("xs:element", name)); }

  /// The words of a simple type, wherever they stand in it.
  std::set<std::string> words(const std::string& type) const {
    std::set<std::string> words;
    for (const auto& word : named("xs:simpleType", type).select_nodes(".//xs:enumeration/@value")) {
      words.insert(word.attribute().value());
    }
    return words;
  }

 private:
  pugi::xml_node named(const std::string& kind, const std::string& name) const {
    return root().find_child([&](const pugi::xml_node& node) {
      return node.name() == kind && node.attribute("name").value() == name;
    });
  }

  Shape shape_of(const pugi::xml_node& element) const {
    auto type = element.child("xs:complexType");
    if (!type) type = named("xs:complexType", element.attribute("type").value());
    Shape shape;
    shape.text = !type || type.attribute("mixed").as_bool() || type.child("xs:simpleContent");
    const auto extension = type.child("xs:simpleContent").child("xs:extension");
    add_attributes(extension ? extension : type, shape);
    for (const char* group : {"xs:choice", "xs:all"}) {
      for (const auto& child : type.child(group).children("xs:element")) {
        shape.children.emplace(child.attribute("name").value(), shape_of(child));
      }
    }
    return shape;
  }

  void add_attributes(const pugi::xml_node& type, Shape& shape) const {
    for (const auto& attribute : type.children("xs:attribute")) {
      shape.attributes.insert(attribute.attribute("name").value());
    }
    for (const auto& group : type.children("xs:attributeGroup")) {
      add_attributes(named("xs:attributeGroup", group.attribute("ref").value()), shape);
    }
  }

  pugi::xml_document document_;
};

/// Where the two differ, one place a line.
std::string difference(const Shape& reader, const Shape& schema, const std::string& place) {
  std::string text;
  const auto tell = [&](bool in_reader, bool in_schema, const std::string& what) {
    if (in_reader == in_schema) return;
    text += place + what + " is in the " + (in_reader ? "reader" : "schema") + " alone\n";
  };
  tell(reader.text, schema.text, "/text");
  for (const auto* shape : {&reader, &schema}) {
    const auto* other = shape == &reader ? &schema : &reader;
    for (const auto& name : shape->attributes) {
      if (other->attributes.count(name) == 0) tell(shape == &reader, shape != &reader, "@" + name);
    }
    for (const auto& [name, child] : shape->children) {
      if (other->children.count(name) == 0) tell(shape == &reader, shape != &reader, "/" + name);
    }
  }
  for (const auto& [name, child] : reader.children) {
    const auto same = schema.children.find(name);
    if (same != schema.children.end()) text += difference(child, same->second, place + "/" + name);
  }
  return text;
}

}  // namespace

TEST_CASE("The schemas have what the reader has") {
  const auto [file, notation] = GENERATE(table<std::string, const Notation*>({
      {"mission.xsd", &mission_notation()},
      {"mission.xsd", &part_notation()},
      {"component.xsd", &component_notation()},
      {"dictionary.xsd", &dictionary_notation()},
  }));
  const std::string name(notation->name);
  CHECK(difference(shape_of(*notation), Schema(file).element(name), name) == "");
}

TEST_CASE("A difference between the schema and the reader is told with its place") {
  const Shape one{{"a", "b"}, {{"x", {{}, {}, true}}, {"y", {}}}, false};
  const Shape other{{"a", "c"}, {{"x", {{"d"}, {}, false}}}, false};
  CHECK(difference(one, other, "e") ==
        "e@b is in the reader alone\ne/y is in the reader alone\ne@c is in the schema alone\n"
        "e/x/text is in the reader alone\ne/x@d is in the schema alone\n");
}

TEST_CASE("The schema knows the vendors that the library knows") {
  const auto& vendors = skein::dds::vendor_names();
  CHECK(Schema("mission.xsd").words("Vendor") ==
        std::set<std::string>(vendors.begin(), vendors.end()));
}

TEST_CASE("Everything that an editor offers is documented") {
  const std::string file = GENERATE("mission.xsd", "component.xsd", "dictionary.xsd");
  const Schema schema(file);
  const auto documented = [](const pugi::xml_node& node) {
    return !std::string(node.child("xs:annotation").child_value("xs:documentation")).empty();
  };
  for (const auto& found : schema.root().select_nodes("//xs:attribute | //xs:element")) {
    const auto node = found.node();
    CAPTURE(file, node.attribute("name").value());
    const std::string type = node.attribute("type").value();
    const auto of_type =
        schema.root().find_child_by_attribute("xs:complexType", "name", type.c_str());
    CHECK((documented(node) || documented(of_type) || documented(node.child("xs:complexType"))));
  }
}
