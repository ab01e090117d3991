// What xmllint, which knows the schemas alone, makes of files, beside what the reader makes of
// them.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "mission/component/component_xml.hpp"
#include "mission/profile/mission_profile.hpp"
#include "test/tools/places.hpp"
#include "test/tools/prepare.hpp"
#include "test/tools/shell.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::profile;
using skein::test::project_file;

namespace fs = std::filesystem;

int skein::test::prepare() {
  if (std::system("xmllint --version >/dev/null 2>&1") == 0) return 0;
  std::cerr << "skipped: xmllint (Debian package libxml2-utils) is not installed\n";
  return 77;
}

namespace {

const fs::path kSchemas = project_file("mission_profiles/schema");
const fs::path kSamples = project_file("test/mission/profile/samples");

/// The files that the schema allows.
std::set<std::string> valid(const std::string& schema, const std::vector<std::string>& files) {
  constexpr std::size_t kFilesAtOnce = 500;
  std::set<std::string> found;
  for (std::size_t first = 0; first < files.size(); first += kFilesAtOnce) {
    std::string command = "xmllint --noout --nonet --schema '" + (kSchemas / schema).string() + "'";
    for (std::size_t i = first; i < std::min(files.size(), first + kFilesAtOnce); ++i)
      command += " '" + files[i] + "'";
    constexpr std::string_view kEnd = " validates";
    std::istringstream lines(skein::test::shell(command).output);
    for (std::string line; std::getline(lines, line);) {
      if (line.ends_with(kEnd)) found.insert(line.substr(0, line.size() - kEnd.size()));
    }
  }
  return found;
}

std::string schema_for(const fs::path& file) {
  pugi::xml_document document;
  if (!document.load_file(file.c_str())) return {};
  const std::string root = document.document_element().name();
  if (root == "mission" || root == "part") return "mission.xsd";
  return root == "component" || root == "dictionary" ? root + ".xsd" : "";
}

/// Whether the reader takes the file, and what it says.
std::string findings_of(const fs::path& file) {
  std::vector<Finding> findings;
  try {
    const auto schema = schema_for(file);
    if (schema == "component.xsd") read_component(file);
    if (schema == "dictionary.xsd") read_dictionary(file);
    if (schema == "mission.xsd") read_mission_profile(file, findings);
  } catch (const DescriptionError& error) {
    findings = error.findings();
  }
  return to_text(findings);
}

using Types = std::map<std::string, std::string>;  // by attribute

/// Of a type or group of the schema.
Types types_in(const pugi::xml_node& schema, const pugi::xml_node& owner) {
  Types types;
  for (const auto& node : owner.children("xs:attribute"))
    types[node.attribute("name").value()] = node.attribute("type").value();
  for (const auto& node : owner.children("xs:attributeGroup")) {
    types.merge(types_in(schema, schema.find_child_by_attribute(node.name(), "name",
                                                                node.attribute("ref").value())));
  }
  return types;
}

/// Adds each attribute that the schema has for an element and the sample lacks, to the first such
/// element outside of groups: what a peer says itself hides what its group says. Its value is the
/// first one of the same type.
void complete(pugi::xml_document& sample) {
  pugi::xml_document file;
  REQUIRE(file.load_file((kSchemas / "mission.xsd").c_str()));
  const auto schema = file.document_element();
  std::map<std::string, pugi::xml_node> first;
  std::map<std::string, Types> types;
  std::map<std::string, std::string> values;
  for (const auto& found : sample.select_nodes("//*")) {
    const auto node = found.node();
    const std::string name = node.name();
    if (node.parent().name() != std::string("group")) first.emplace(name, node);
    if (types.count(name) == 0) {
      const auto element =
          schema.select_node(("//xs:element[@name='" + name + "']").c_str()).node();
      const auto type = schema.find_child_by_attribute("xs:complexType", "name",
                                                       element.attribute("type").value());
      types[name] = types_in(schema, type ? type : element.child("xs:complexType"));
    }
    for (const auto& attribute : node.attributes()) {
      const auto type = types[name].find(attribute.name());
      if (type != types[name].end()) values.emplace(type->second, attribute.value());
    }
  }
  for (auto& [name, node] : first) {
    for (const auto& [attribute, type] : types[name]) {
      CAPTURE(name, attribute, type);
      if (sample.select_node(("//" + name + "/@" + attribute).c_str())) continue;
      REQUIRE(values.count(type) > 0);
      node.append_attribute(attribute.c_str()) = values[type].c_str();
    }
  }
}

struct Mutation {
  std::string what;
  std::string file{};
  bool must_be_refused = true;
};

/// Copies of a sample, in the same folder as copies of those that it names, each with one change.
class Mutations {
 public:
  explicit Mutations(const std::string& sample) {
    for (const auto& entry : fs::directory_iterator(kSamples)) {
      fs::copy(entry.path(), folder_.path() / entry.path().filename());
    }
    REQUIRE(document_.load_file((kSamples / sample).c_str()));
    if (sample == "mission.xml") complete(document_);
  }

  /// The sample as it is.
  std::string original() {
    save({"nothing"});
    return mutations_.back().file;
  }

  /// Of each element: an attribute and an element that nobody knows, and each attribute misspelled,
  /// gone, and with a value that hardly anything has.
  std::vector<Mutation> make() {
    for (const auto& found : document_.select_nodes("//*")) mutate(found.node());
    return mutations_;
  }

 private:
  void mutate(pugi::xml_node element) {
    const std::string name = element.name();
    element.append_attribute("colour") = "red";
    save({"<" + name + "> with an unknown attribute"});
    element.remove_attribute("colour");
    element.append_child("colour");
    save({"<" + name + "> with an unknown element"});
    element.remove_child("colour");
    std::vector<std::string> names;
    for (const auto& attribute : element.attributes()) names.emplace_back(attribute.name());
    for (const auto& attribute : names) {
      if (attribute.starts_with("xmlns") || attribute.starts_with("xsi")) continue;
      mutate(element, element.attribute(attribute.c_str()));
    }
  }

  void mutate(pugi::xml_node element, pugi::xml_attribute attribute) {
    const std::string place = "<" + std::string(element.name()) + "> ";
    const std::string name = attribute.name();
    const std::string value = attribute.value();
    attribute.set_name((name + "q").c_str());
    save({place + "with " + name + "q"});
    attribute.set_name(name.c_str());
    for (const std::string other : {"!", "", "-1", "0", "1001", "1 fortnight", "true", "x", "${"}) {
      attribute.set_value(other.c_str());
      save({place + name + "=\"" + other + "\"", "", false});
    }
    attribute.set_value(value.c_str());
    const auto next = attribute.next_attribute();
    element.remove_attribute(attribute);
    save({place + "without " + name, "", false});
    auto again = next ? element.insert_attribute_before(name.c_str(), next)
                      : element.append_attribute(name.c_str());
    again.set_value(value.c_str());
  }

  void save(Mutation mutation) {
    const auto file = folder_.path() / ("mutation" + std::to_string(mutations_.size()) + ".xml");
    REQUIRE(document_.save_file(file.c_str()));
    mutation.file = file.string();
    mutations_.push_back(std::move(mutation));
  }

  TemporaryFolder folder_;
  pugi::xml_document document_;
  std::vector<Mutation> mutations_;
};

}  // namespace

TEST_CASE("Every profile, component and dictionary of the tree is valid") {
  std::map<std::string, std::vector<std::string>> files;
  for (const char* folder : {"mission_profiles", "examples", "test"}) {
    for (const auto& entry : fs::recursive_directory_iterator(project_file(folder))) {
      if (entry.path().extension() != ".xml") continue;
      if (const auto schema = schema_for(entry.path()); !schema.empty())
        files[schema].push_back(entry.path().string());
    }
  }
  REQUIRE(files.size() == 3);
  for (const auto& [schema, of_schema] : files) {
    CHECK(of_schema.size() > 1);
    CHECK(valid(schema, of_schema) == std::set<std::string>(of_schema.begin(), of_schema.end()));
  }
}

TEST_CASE("The samples are what the reader takes") {
  for (const char* file : {"mission.xml", "component.xml", "csp.xml", "dictionary.xml"}) {
    CHECK(findings_of(Mutations(file).original()) == "");
  }
}

TEST_CASE("What the schema refuses the reader refuses, and both what is unknown or missing") {
  const std::string sample = GENERATE("mission.xml", "component.xml", "dictionary.xml");
  Mutations mutations(sample);
  const auto made = mutations.make();
  CHECK(made.size() > 50);
  std::vector<std::string> files;
  for (const auto& mutation : made) files.push_back(mutation.file);
  const auto allowed = valid(schema_for(kSamples / sample), files);
  for (const auto& mutation : made) {
    const std::string findings = findings_of(mutation.file);
    const bool in_schema = allowed.count(mutation.file) > 0;
    CAPTURE(sample, mutation.what, findings);
    if (!in_schema) CHECK(findings != "");
    if (mutation.must_be_refused) {
      CHECK_FALSE(in_schema);
      CHECK(findings != "");
    }
    const bool missing = findings.find("> has no ") != std::string::npos;
    const bool no_word = findings.find("; did you mean '") != std::string::npos ||
                         findings.find("; known are ") != std::string::npos ||
                         findings.find(" is no length of time") != std::string::npos ||
                         findings.find(" is no name of a system") != std::string::npos;
    const bool of_variable = findings.find("error: the variable ") != std::string::npos;
    if (missing || (no_word && !of_variable)) CHECK_FALSE(in_schema);
  }
}

TEST_CASE("Every word that the schema offers is one that the reader knows") {
  pugi::xml_document schema;
  REQUIRE(schema.load_file((kSchemas / "mission.xsd").c_str()));
  TemporaryFolder folder;
  for (const auto& entry : fs::directory_iterator(kSamples)) {
    fs::copy(entry.path(), folder.path() / entry.path().filename());
  }
  int words = 0;
  for (const auto& found : schema.select_nodes("//xs:enumeration/@value")) {
    const std::string word = found.attribute().value();
    const std::string type = found.parent()
                                 .select_node("ancestor::xs:simpleType[@name]")
                                 .node()
                                 .attribute("name")
                                 .value();
    for (const auto& user : schema.select_nodes(("//xs:attribute[@type='" + type + "']").c_str())) {
      const std::string attribute = user.node().attribute("name").value();
      const bool of_csp = attribute == "process";
      const bool of_topic = user.node().parent().attribute("name").value() == std::string("Topic");
      const bool of_program = attribute == "ready";
      const auto text_with = [&](const std::string& value) {
        const std::string given = attribute + "=\"" + value + "\"";
        return "<mission name=\"m\"><peer name=\"p\" " +
               std::string(of_program ? "program=\"sleep\" " : "component=\"component.xml\" ") +
               (of_csp || of_topic ? "" : given) + "><csp component=\"csp.xml\" " +
               (of_csp ? given : "") + "/><topic name=\"t\" " + (of_topic ? given : "") +
               "/></peer></mission>";
      };
      CAPTURE(attribute, word);
      const auto quoted = "\"" + word + "\"";
      CHECK_THAT(findings_of(folder.write("m.xml", text_with(word))), !Catch::Contains(quoted));
      CHECK_THAT(findings_of(folder.write("m.xml", text_with(word + "q"))),
                 Catch::Contains("\"" + word + "q\""));
      ++words;
    }
  }
  CHECK(words > 20);
}
