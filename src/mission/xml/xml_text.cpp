#include "xml_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>

#include "words.hpp"

namespace skein::profile {
namespace {

constexpr std::string_view kConvert = "save the file as UTF-8 (iconv -f FROM -t UTF-8)";

class Scanner {
 public:
  Scanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void demand_utf8() const {
    demand_no_wide_encoding();
    for (std::size_t at = 0; at < text_.size();) {
      const auto byte = static_cast<unsigned char>(text_[at]);
      if (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') {
        refuse(at, byte == 0 ? "a NUL byte" : "a control character", "text has none; remove it");
      }
      const std::size_t length = sequence_length(at);
      if (length == 0) refuse(at, "bytes that are no UTF-8", std::string(kConvert));
      at += length;
    }
  }

  void demand_declared_utf8() const {
    std::string_view start = text_.substr(0, 3) == "\xEF\xBB\xBF" ? text_.substr(3) : text_;
    if (start.substr(0, 5) != "<?xml") return;
    start = start.substr(0, start.find("?>"));
    const auto word = start.find("encoding");
    if (word == std::string_view::npos) return;
    const auto open = start.find_first_of("\"'", word);
    if (open == std::string_view::npos) return;
    const auto close = start.find(start[open], open + 1);
    if (close == std::string_view::npos) return;
    std::string name(start.substr(open + 1, close - open - 1));
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (name == "utf-8" || name == "utf8" || name == "us-ascii" || name == "ascii") return;
    refuse(static_cast<std::size_t>(start.data() - text_.data()) + open,
           "the encoding " + in_quotes(name) + " is not supported", std::string(kConvert));
  }

  void demand_known_references() const {
    for (std::size_t at = text_.find_first_of("<&"); at != std::string_view::npos;
         at = text_.find_first_of("<&", at)) {
      if (text_[at] == '&') {
        at = end_of_reference(at);
      } else if (starts(at, "<!--")) {
        at = after(at, "-->");
      } else if (starts(at, "<![CDATA[")) {
        at = after(at, "]]>");
      } else if (starts(at, "<?")) {
        at = after(at, "?>");
      } else if (starts(at, "<!DOCTYPE")) {
        at = end_of_document_type(at);
      } else {
        ++at;
      }
    }
  }

 private:
  [[noreturn]] void refuse(std::size_t at, const std::string& problem,
                           const std::string& remedy) const {
    throw DescriptionError(
        {Finding{Severity::Error, position_at(text_, at, file_), problem, remedy}});
  }

  bool starts(std::size_t at, std::string_view with) const {
    return text_.substr(at, with.size()) == with;
  }

  /// Behind `end`, or the end of the text: that it is missing is for the parser to say.
  std::size_t after(std::size_t at, std::string_view end) const {
    const auto found = text_.find(end, at);
    return found == std::string_view::npos ? text_.size() : found + end.size();
  }

  void demand_no_wide_encoding() const {
    const bool marked = starts(0, "\xFF\xFE") || starts(0, "\xFE\xFF");
    const bool wide = text_.size() >= 2 && (text_[0] == '\0') != (text_[1] == '\0');
    if (marked || wide) refuse(0, "the file is UTF-16 or UTF-32", std::string(kConvert));
  }

  /// Bytes of the character at `at` by RFC 3629, 0 if they are none.
  std::size_t sequence_length(std::size_t at) const {
    const auto byte = [&](std::size_t i) -> unsigned {
      return at + i < text_.size() ? static_cast<unsigned char>(text_[at + i]) : 0U;
    };
    const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
    if (first >= 0xE0 && first <= 0xEF) {
      const bool overlong = first == 0xE0 && byte(1) < 0xA0;
      const bool surrogate = first == 0xED && byte(1) >= 0xA0;
      return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (first >= 0xF0 && first <= 0xF4) {
      const bool overlong = first == 0xF0 && byte(1) < 0x90;
      const bool beyond = first == 0xF4 && byte(1) >= 0x90;
      return follows(1) && follows(2) && follows(3) && !overlong && !beyond ? 4 : 0;
    }
    return 0;
  }

  std::size_t end_of_reference(std::size_t at) const {
    constexpr std::size_t kLongest = 12;
    const auto length = text_.substr(at, kLongest).find(';');
    if (length == std::string_view::npos) refuse(at, "a lone \"&\"", "write &amp;");
    const auto name = text_.substr(at + 1, length - 1);
    constexpr std::array<std::string_view, 5> kNames{"lt", "gt", "amp", "quot", "apos"};
    const bool known = std::find(kNames.begin(), kNames.end(), name) != kNames.end();
    if (!known && !is_character_reference(name)) {
      refuse(at, "the reference " + in_quotes(text_.substr(at, length + 1)) + " is unknown",
             "write the text itself; entities of one's own are not supported");
    }
    return at + length + 1;
  }

  static bool is_character_reference(std::string_view name) {
    if (name.size() < 2 || name[0] != '#') return false;
    const bool hexadecimal = name[1] == 'x';
    name.remove_prefix(hexadecimal ? 2 : 1);
    std::uint32_t code = 0;
    const auto end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data(), end, code, hexadecimal ? 16 : 10);
    if (error != std::errc() || stop != end) return false;
    if (code < 0x20) return code == '\t' || code == '\n' || code == '\r';
    return code < 0xD800 || (code > 0xDFFF && code < 0xFFFE) || (code > 0xFFFF && code < 0x110000);
  }

  std::size_t end_of_document_type(std::size_t at) const {
    const auto end = text_.find_first_of("[>", at);
    if (end != std::string_view::npos && text_[end] == '[') {
      refuse(at, "a document type with declarations of its own",
             "remove it; entities and default values are not supported");
    }
    return end == std::string_view::npos ? text_.size() : end + 1;
  }

  std::string_view text_;
  const std::string& file_;
};

}  // namespace

SourcePosition position_at(std::string_view text, std::size_t offset, const std::string& file) {
  const std::string_view before = text.substr(0, offset);
  const auto line_start = before.find_last_of('\n') + 1;  // npos + 1 is 0: the first line.
  const auto characters = [](std::string_view part) {
    return std::count_if(part.begin(), part.end(), [](char c) { return (c & 0xC0) != 0x80; });
  };
  return {file, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
          1 + static_cast<int>(characters(before.substr(line_start)))};
}

void demand_utf8_text(std::string_view text, const std::string& file) {
  Scanner(text, file).demand_utf8();
}

void demand_plain_xml_text(std::string_view text, const std::string& file) {
  const Scanner scanner(text, file);
  scanner.demand_utf8();
  scanner.demand_declared_utf8();
  scanner.demand_known_references();
}

}  // namespace skein::profile
