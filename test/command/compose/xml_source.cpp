// How a text is changed here and there, and the rest of it left as it is.
#include "mission/xml/xml_source.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "mission/xml/xml_node.hpp"
#include "mission_text.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::profile;

namespace {

std::size_t number_of(const XmlSource& source, const std::string& name, std::size_t which = 0) {
  for (std::size_t i = 0; i < source.elements().size(); ++i)
    if (source.elements()[i].name == name && which-- == 0) return i;
  throw std::out_of_range(name);
}

std::string changed(const std::string& text, const std::string& element, const std::string& name,
                    const std::optional<std::string>& value) {
  const XmlSource source(text, "f");
  return spliced(text, source.with_attribute(number_of(source, element), name, value));
}

std::string with_child(const std::string& text, const std::string& parent, const std::string& name,
                       const XmlSource::Attributes& attributes = {}) {
  const XmlSource source(text, "f");
  return spliced(text, source.with_child(number_of(source, parent), name, attributes));
}

std::string without(const std::string& text, const std::string& element, std::size_t which = 0) {
  const XmlSource source(text, "f");
  return spliced(text, source.without(number_of(source, element, which)));
}

XmlNode parsed(const std::string& text) {
  FindingList findings;
  return parse_xml(text, "f", findings);
}

/// Without places.
std::string canonical(const XmlNode& node) {
  std::string text = "<" + node.name;
  for (const auto& each : node.attributes) text += " " + each.name + "={" + each.value + "}";
  text += ">" + node.text;
  for (const auto& child : node.children) text += canonical(child);
  return text + "</>";
}

/// In the order of their start tags.
void collect(XmlNode& node, std::vector<XmlNode*>& all) {
  all.push_back(&node);
  for (auto& child : node.children) collect(child, all);
}

XmlNode* parent_of(XmlNode& root, const XmlNode* child) {
  std::vector<XmlNode*> all;
  collect(root, all);
  for (XmlNode* each : all)
    for (const auto& one : each->children)
      if (&one == child) return each;
  return nullptr;
}

}  // namespace

TEST_CASE("elements and attributes are found with the bytes that they take") {
  const XmlSource source(kMissionText, "f");
  std::vector<std::string> names;
  for (const auto& element : source.elements()) {
    names.push_back(element.name);
    CHECK(kMissionText.substr(element.begin, 1 + element.name.size()) == "<" + element.name);
    CHECK(kMissionText[element.start_end - 1] == '>');
    CHECK(kMissionText[element.end - 1] == '>');
  }
  CHECK(names == std::vector<std::string>{"mission", "variable", "peer", "csp", "parameter", "peer",
                                          "future"});
  const auto& domain = source.elements()[0].attributes[1];
  CHECK(kMissionText.substr(domain.begin, domain.value_end + 1 - domain.begin) == "domain='7'");
  CHECK(source.elements()[6].attributes[0].value == "a < b");
  const auto& future = source.elements()[6];
  CHECK(kMissionText.substr(future.end_begin, future.end - future.end_begin) == "</future>");
  CHECK(source.element_at(3, 1) == 0);
  CHECK(source.element_at(7, 5) == 3);
  CHECK_FALSE(source.element_at(1, 1));
  CHECK_FALSE(source.element_at(99, 99));
}

TEST_CASE("an attribute gets another value between the quotes that it has") {
  CHECK(changed("<a  b = '1' />", "a", "b", "it's <&>") == "<a  b = 'it&apos;s &lt;&amp;>' />");
  CHECK(changed("<a b=\"1\"/>", "a", "b", "\"\n") == "<a b=\"&quot;&#10;\"/>");
  CHECK(changed("<a/>", "a", "b", "1") == "<a b=\"1\"/>");
  CHECK(changed("<a c='2' ></a>", "a", "b", "1") == "<a c='2' b=\"1\" ></a>");
  CHECK_THROWS_AS(changed("<a/>", "a", "b", std::string("\x01", 1)), InvalidArgument);
}

TEST_CASE("a long line goes on below its first attribute") {
  const std::string text = "<a>\n  <peer name=\"" + std::string(100, 'x') + "\"/>\n</a>\n";
  CHECK(changed(text, "peer", "component", "pilot.xml") ==
        "<a>\n  <peer name=\"" + std::string(100, 'x') +
            "\"\n        component=\"pilot.xml\"/>\n</a>\n");
}

TEST_CASE("an attribute is taken away with the blanks before it") {
  CHECK(changed("<a b='1'  c='2'/>", "a", "c", std::nullopt) == "<a b='1'/>");
  CHECK(changed("<a b='1'\n  c='2'>x</a>", "a", "b", std::nullopt) == "<a\n  c='2'>x</a>");
  CHECK(changed("<a/>", "a", "b", std::nullopt) == "<a/>");
}

TEST_CASE("a new element stands behind those of its name, and looks like them") {
  CHECK(with_child("<m/>", "m", "peer", {{"name", "x\"y"}}) ==
        "<m>\n  <peer name=\"x&quot;y\"/>\n</m>");
  CHECK(with_child("<m a='1' />\n", "m", "peer") == "<m a='1'>\n  <peer/>\n</m>\n");
  CHECK(with_child("<m></m>", "m", "peer") == "<m>\n  <peer/>\n</m>");
  CHECK(with_child("<m>\n</m>", "m", "peer") == "<m>\n  <peer/>\n</m>");
  CHECK(with_child("<m>\r\n\t<a/>\r\n</m>", "m", "peer") == "<m>\r\n\t<a/>\r\n\t<peer/>\r\n</m>");
  CHECK(with_child("<m>\n  <!-- none yet -->\n</m>", "m", "peer") ==
        "<m>\n  <!-- none yet -->\n  <peer/>\n</m>");
  CHECK(with_child("<m>\n  <peer/> <!-- it -->\n  <a/>\n</m>", "m", "peer", {{"b", "1"}}) ==
        "<m>\n  <peer/> <!-- it -->\n  <peer b=\"1\"/>\n  <a/>\n</m>");
  CHECK(with_child("<m>\n    <g>\n        <peer/>\n    </g>\n</m>", "g", "peer") ==
        "<m>\n    <g>\n        <peer/>\n        <peer/>\n    </g>\n</m>");
}

TEST_CASE("an element is taken away with its line, if it stands there alone") {
  CHECK(without("<m>\n  <a/>\n  <b/>\n</m>", "a") == "<m>\n  <b/>\n</m>");
  CHECK(without("<m>\n  <a>\n    <c/>\n  </a>\n</m>", "a") == "<m>\n</m>");
  CHECK(without("<m><a/><b/></m>", "a") == "<m><b/></m>");
  CHECK(without("<m>\n  <a/> <!-- why -->\n</m>", "a") == "<m>\n   <!-- why -->\n</m>");
  CHECK_THROWS_AS(without("<m/>", "m"), InvalidArgument);
}

TEST_CASE("the smallest splice makes one text of the other") {
  for (const auto& [before, after] :
       std::vector<std::pair<std::string, std::string>>{{"", ""},
                                                        {"abc", "abc"},
                                                        {"aaa", "aa"},
                                                        {"aa", "aaa"},
                                                        {"abc", ""},
                                                        {"", "abc"},
                                                        {"abcabc", "abcXabc"},
                                                        {"one", "two"}}) {
    CHECK(spliced(before, difference(before, after)) == after);
  }
  CHECK(difference("abcabc", "abcXabc").inserted == "X");
}

TEST_CASE("text from a page's field, which has line feeds alone, leaves all other line ends") {
  const auto typed = [](const std::string& before, const std::string& after) {
    return spliced(before, typed_difference(before, after));
  };
  CHECK(typed("a\r\nb\r\nc\r\n", "a\nb\nc\n") == "a\r\nb\r\nc\r\n");
  CHECK(typed("a\r\nb\r\nc\r\n", "a\nbx\ny\nc\n") == "a\r\nbx\r\ny\r\nc\r\n");
  CHECK(typed("a\nb\r\nc\n", "a\nc\n") == "a\nc\n");
  CHECK(typed("a\rb", "a\nc") == "a\rc");
  CHECK(typed("a\r\nb", "b") == "b");
  CHECK(typed("a\nb", "a\n\nb") == "a\n\nb");
  CHECK(typed("a\r\nb", "a\r\nc") == "a\r\nc");
  CHECK(typed("a\rb\nc", "a\n\nc") == "a\n\nc");
  CHECK(typed("a\nb\rc", "a Q\n\nb\nc") == "a Q\n\nb\nc");
}

TEST_CASE("whatever is changed, the document is what it should be, and all else stays as it was") {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    const auto any = [&](std::size_t below) { return random() % below; };
    const std::vector<std::string> values{"",        "x",  "a<b", "\"'&", "\xC3\xA4\xE2\x82\xAC",
                                          "${rate}", "]]>"};
    std::string text = kMissionText;
    XmlNode model = parsed(text);
    for (int step = 0; step < 30; ++step) {
      const XmlSource source(text, "f");
      std::vector<XmlNode*> nodes;
      collect(model, nodes);
      REQUIRE(nodes.size() == source.elements().size());
      const std::size_t number = any(nodes.size());
      XmlNode& node = *nodes[number];
      const std::string name = std::vector<std::string>{"name", "vendor", "rate"}[any(3)];
      const std::string value = values[any(values.size())];
      Splice splice;
      const std::size_t what = any(4);
      const auto known = std::ranges::find(node.attributes, name, &XmlAttribute::name);
      if (what == 0 || what == 3) {
        splice = source.with_attribute(number, name, value);
        if (known == node.attributes.end())
          node.attributes.push_back({name, value, {}});
        else
          known->value = value;
      } else if (what == 1) {
        splice = source.with_attribute(number, name, std::nullopt);
        if (known != node.attributes.end()) node.attributes.erase(known);
      } else if (any(3) > 0 || number == 0) {
        if (node.name == "future") continue;  // it holds text, to which blanks would be added
        splice = source.with_child(number, "csp", {{"component", value}});
        auto place = node.children.end();
        for (auto at = node.children.begin(); at != node.children.end(); ++at)
          if (at->name == "csp") place = at + 1;
        node.children.insert(place, XmlNode{"csp", {}, {{"component", value, {}}}, {}, ""});
      } else {
        splice = source.without(number);
        XmlNode* parent = parent_of(model, &node);
        parent->children.erase(parent->children.begin() + (&node - parent->children.data()));
      }
      text = spliced(text, splice);
      REQUIRE(canonical(parsed(text)) == canonical(model));
      CHECK(text.find("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- Two of each. -->\n") == 0);
    }
  }
}
