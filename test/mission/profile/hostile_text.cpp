#include <catch2/catch.hpp>
#include <pugixml.hpp>

#include "mission/component/component_xml.hpp"

using namespace skein::profile;

namespace {

/// The one finding with which a text is refused.
std::string refusal_of(const std::string& xml) {
  try {
    parse_component(xml, "h.xml");
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "";
}

std::string utf16(const std::string& ascii, bool big_endian) {
  std::string text;
  for (const char c : ascii) text += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return text;
}

std::string entity_bomb() {
  std::string text = "<!DOCTYPE component [\n<!ENTITY l0 \"lol\">\n";
  for (int i = 1; i < 10; ++i) {
    const std::string inner = "&l" + std::to_string(i - 1) + ";";
    text += "<!ENTITY l" + std::to_string(i) + " \"";
    for (int k = 0; k < 10; ++k) text += inner;
    text += "\">\n";
  }
  return text + "]>\n<component name=\"A\">&l9;</component>";
}

const std::string kPlain = "<component name=\"A\"/>";

}  // namespace

TEST_CASE("An entity bomb is refused where it begins") {
  CHECK_THAT(refusal_of(entity_bomb()),
             Catch::StartsWith("h.xml:1:1: error: a document type with declarations of its own"));
}

TEST_CASE("The XML parser does not expand entities that a document declares") {
  pugi::xml_document document;
  REQUIRE(document.load_string(entity_bomb().c_str()));
  CHECK(std::string(document.child("component").child_value()) == "&l9;");
}

TEST_CASE("A reference that XML does not have is refused, not read as text") {
  CHECK_THAT(refusal_of("<component name=\"&lol;\"/>"),
             Catch::StartsWith("h.xml:1:18: error: the reference \"&lol;\" is unknown"));
  CHECK_THAT(refusal_of("<component name=\"a & b\"/>"), Catch::Contains("a lone \"&\""));
  for (const char* reference : {"&#0;", "&#x1F;", "&#xD800;", "&#x110000;", "&#xFFFE;", "&#;",
                                "&#x;", "&#-1;", "&#99999999999;", "&#X41;"}) {
    CAPTURE(reference);
    CHECK(refusal_of("<component name=\"" + std::string(reference) + "\"/>") != "");
  }
}

TEST_CASE("References of XML itself are read, and ignored where they are no references") {
  CHECK(parse_component("<component name=\"&lt;&#65;&#x42;&amp;lol;\"/>", "h").name == "<AB&lol;");
  CHECK(refusal_of("<!-- &lol; --><?note &lol; ?><component name=\"A\"/>") == "");
}

TEST_CASE("A document type without declarations is harmless") {
  CHECK(refusal_of("<!DOCTYPE component SYSTEM \"component.dtd\">" + kPlain) == "");
}

TEST_CASE("Other encodings than UTF-8 are refused with the way to convert them") {
  const auto text = GENERATE(
      utf16(kPlain, false), utf16(kPlain, true), "\xFF\xFE" + utf16(kPlain, false),
      "\xFE\xFF" + utf16(kPlain, true), std::string("<component name=\"\xE4\"/>"),
      std::string("<?xml version=\"1.0\" encoding=\"UTF-8\"?><component name=\"\xE4\"/>"),
      std::string("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><component name=\"\xE4\"/>"),
      std::string("<?xml version='1.0' encoding='utf-16'?>") + kPlain);
  CHECK_THAT(refusal_of(text), Catch::Contains("iconv"));
}

TEST_CASE("Bytes that only look like UTF-8 are refused") {
  for (const char* bytes :
       {"\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80",
        "\x80", "\xC3", "\xE2\x82", "\xF0\x9F\x98", "\xFE", "\xC3\x28"}) {
    CAPTURE(bytes);
    CHECK_THAT(refusal_of("<component name=\"" + std::string(bytes) + "\"/>"),
               Catch::StartsWith("h.xml:1:18: error: bytes that are no UTF-8"));
  }
  CHECK(refusal_of("<component name=\"\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80\"/>") == "");
}

TEST_CASE("NUL bytes and control characters are refused where they stand") {
  std::string text = kPlain;
  text.insert(17, 1, '\0');
  CHECK_THAT(refusal_of(text), Catch::StartsWith("h.xml:1:18: error: a NUL byte"));
  CHECK_THAT(refusal_of(kPlain + std::string(1, '\0')), Catch::Contains("a NUL byte"));
  CHECK_THAT(refusal_of("<component name=\"\x1B[2J\"/>"), Catch::Contains("a control character"));
}

TEST_CASE("A truncated description is refused wherever it ends") {
  const std::string whole =
      "<component name=\"A\"><interfaces><implements>M/I</implements></interfaces></component>";
  for (std::size_t length = 0; length < whole.size(); ++length) {
    CAPTURE(length);
    CHECK(refusal_of(whole.substr(0, length)) != "");
  }
  CHECK(refusal_of(whole) == "");
}

TEST_CASE("A mistake in the markup is told where it was made") {
  const auto [text, finding] = GENERATE(table<std::string, std::string>({
      {"<a>\n<b>\n</a>",
       "h.xml:2:1: error: malformed XML: <b> is not closed: </a> comes first, at 3:1"},
      {"<a>\n<b/>\n</c></a>",
       "h.xml:3:1: error: malformed XML: </c> closes nothing: what is open is <a>, at 1:1; write "
       "</a>"},
      {"<a/></a>", "h.xml:1:5: error: malformed XML: </a> closes nothing; remove it"},
      {"<a>\n<b x=\"1>\n<c y=\"2\"/></b></a>",
       "h.xml:2:4: error: malformed XML: the value of \"x\" has no closing quote"},
      {"<a x=\"1 y=\"2\"></a>",
       "h.xml:1:4: error: malformed XML: the value of \"x\" has no closing quote"},
      {"<a x=\"1\"y=\"2\"></a>",
       "h.xml:1:9: error: malformed XML: a blank is missing behind the value of \"x\""},
      {"<a x=1></a>",
       "h.xml:1:4: error: malformed XML: the value of \"x\" has no quotes; write x=\"...\""},
      {"<a\n x></a>", "h.xml:2:2: error: malformed XML: \"x\" has no value; write x=\"...\""},
      {"<a><!-- <b> --><![CDATA[</c>]]><b>\n</a>",
       "h.xml:1:32: error: malformed XML: <b> is not closed"},
  }));
  CAPTURE(text);
  CHECK_THAT(refusal_of(text), Catch::StartsWith(finding));
}

TEST_CASE("More than one element at the top is refused") {
  CHECK_THAT(refusal_of(kPlain + "\n" + kPlain), Catch::StartsWith("h.xml:2:1: error: a second"));
}

TEST_CASE("Nesting as deep as a file may be costs no stack") {
  const auto closed = GENERATE(true, false);
  constexpr int kDepth = 1'000'000;
  std::string text = "<component name=\"A\">";
  for (int i = 0; i < kDepth; ++i) text += "<a>";
  for (int i = 0; closed && i < kDepth; ++i) text += "</a>";
  if (closed) text += "</component>";
  CHECK_THAT(refusal_of(text), closed ? Catch::Contains("<a> is unknown in <component>")
                                      : Catch::Contains("malformed XML"));
}

TEST_CASE("Very many unknown things become a bounded number of findings") {
  std::string attributes;
  for (int i = 0; i < 400; ++i) attributes += " a" + std::to_string(i) + "=\"\"";
  std::string text = "<component name=\"A\"><dependencies>";
  for (int i = 0; i < 1000; ++i) text += "<depends" + attributes + ">M/I</depends>";
  text += "</dependencies></component>";
  try {
    parse_component(text, "h.xml");
    FAIL("was not refused");
  } catch (const DescriptionError& error) {
    CHECK(error.findings().size() <= 1000);
    CHECK(error.findings().back().problem == "more findings than are shown");
  }
}

TEST_CASE("Text from a file is shortened and cannot drive the terminal it is shown on") {
  const auto text =
      refusal_of("<component name=\"A\"><dependencies><depends>&#127;" +
                 std::string(1'000'000, 'x') + "</depends></dependencies></component>");
  CHECK(text.size() < 300);
  CHECK_THAT(text, Catch::Contains("\"\\x7fxxx") && Catch::Contains("xxx...\""));
}
