#include "selection/arff.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "selection/words.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks::selection {
namespace {

using Cell = std::optional<std::string>;

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::result_out_of_range) return INFINITY;
  if (error != std::errc() || rest != end) return std::nullopt;
  return value;
}

/// Takes one line of a file apart.
class Line {
 public:
  Line(const std::filesystem::path& file, std::size_t number, std::string text)
      : file_(file), number_(number), text_(std::move(text)) {}

  [[noreturn]] void refuse(const std::string& cause, const std::string& remedy) const {
    throw InvalidArgument(file_.string() + ":" + std::to_string(number_) + ": " + cause + "; " +
                          remedy);
  }

  std::size_t number() const { return number_; }
  bool done() {
    skip_space();
    return at_ == text_.size();
  }
  bool starts_with(char letter) {
    skip_space();
    return peek() == letter;
  }
  bool take(char letter) {
    if (!starts_with(letter)) return false;
    ++at_;
    return true;
  }

  /// A word, up to white space.
  std::string word() {
    skip_space();
    if (is_quote(peek())) return quoted();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(peek()) && peek() != '{') ++at_;
    return text_.substr(begin, at_ - begin);
  }

  /// A value, up to a comma or `end`; nullopt for a `?` that is not quoted.
  Cell value(char end) {
    skip_space();
    if (is_quote(peek())) return quoted();
    const std::size_t begin = at_;
    while (at_ < text_.size() && peek() != ',' && peek() != end) ++at_;
    std::string found = trimmed(text_.substr(begin, at_ - begin));
    if (found == "?") return std::nullopt;
    if (found.empty()) refuse("a value is empty", "write ? for one that is missing");
    return found;
  }

 private:
  static bool is_quote(char letter) { return letter == '\'' || letter == '"'; }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_space() {
    while (at_ < text_.size() && is_space(peek())) ++at_;
  }

  std::string quoted() {
    const char quote = text_[at_++];
    std::string found;
    for (; at_ < text_.size() && peek() != quote; ++at_) {
      if (peek() == '\\' && at_ + 1 < text_.size()) ++at_;
      found += peek();
    }
    if (at_ == text_.size())
      refuse("a quote is not closed", std::string("end the value with ") + quote);
    ++at_;
    return found;
  }

  const std::filesystem::path& file_;
  std::size_t number_;
  std::string text_;
  std::size_t at_ = 0;
};

class ArffReader {
 public:
  explicit ArffReader(const std::filesystem::path& file) : stream_(file) {
    arff_.file = file;
    if (!stream_) throw InvalidArgument(file.string() + " cannot be read; name a file that can");
  }

  Arff read() {
    std::string text;
    for (std::size_t number = 1; std::getline(stream_, text); ++number) {
      if (number == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
      Line line(arff_.file, number, trimmed(text));
      if (line.done() || line.starts_with('%')) continue;
      if (in_data_)
        read_row(line);
      else
        read_declaration(line);
    }
    if (!in_data_) {
      throw InvalidArgument(arff_.file.string() +
                            " has no @DATA; write it above the first row of values");
    }
    return std::move(arff_);
  }

 private:
  void read_declaration(Line& line) {
    std::string keyword = lower(line.word());
    if (keyword.ends_with(',')) keyword.pop_back();  // in CPMP-2015
    if (keyword == "@relation") return;
    if (keyword == "@attribute") return read_attribute(line);
    if (keyword != "@data") {
      line.refuse("'" + keyword + "' is no declaration of ARFF",
                  "write @RELATION, @ATTRIBUTE or @DATA, and rows below @DATA");
    }
    if (arff_.attributes.empty())
      line.refuse("no attribute is declared", "write an @ATTRIBUTE per column above @DATA");
    in_data_ = true;
  }

  void read_attribute(Line& line) {
    ArffAttribute attribute;
    attribute.name = line.word();
    if (attribute.name.empty())
      line.refuse("an attribute has no name", "write @ATTRIBUTE NAME TYPE");
    if (arff_.find(attribute.name)) {
      line.refuse("attribute '" + attribute.name + "' is declared twice",
                  "rename or remove one of them");
    }
    if (line.take('{'))
      read_nominal(line, attribute);
    else
      attribute.type = type_of(line, lower(line.word()));
    arff_.attributes.push_back(std::move(attribute));
  }

  static void read_nominal(Line& line, ArffAttribute& attribute) {
    attribute.type = ArffAttribute::Type::Nominal;
    while (!line.take('}')) {
      attribute.values.push_back(line.value('}').value_or("?"));
      if (line.done()) line.refuse("a list of nominal values is not closed", "end it with }");
      if (!line.take(',') && !line.starts_with('}'))
        line.refuse("nominal values are not separated", "write a comma between them");
    }
  }

  static ArffAttribute::Type type_of(const Line& line, const std::string& type) {
    if (type == "numeric" || type == "real" || type == "integer")
      return ArffAttribute::Type::Number;
    if (type == "string" || type == "date") return ArffAttribute::Type::Text;
    line.refuse("type '" + type + "' is not supported",
                "use NUMERIC, REAL, INTEGER, STRING, DATE or a list of values in braces");
  }

  void read_row(Line& line) {
    if (line.starts_with('{'))
      line.refuse("sparse rows are not supported", "write a value per attribute");
    ArffRow row{line.number(), {}};
    do {
      row.cells.push_back(line.value(','));
    } while (line.take(','));
    if (!line.done()) line.refuse("text follows a quoted value", "write a comma between values");
    check(line, row);
    arff_.rows.push_back(std::move(row));
  }

  void check(const Line& line, const ArffRow& row) const {
    const std::size_t declared = arff_.attributes.size();
    if (row.cells.size() != declared) {
      line.refuse("the row has " + std::to_string(row.cells.size()) + " values, but " +
                      std::to_string(declared) + " attributes are declared",
                  "write one value per attribute, and quotes around values with commas");
    }
    for (std::size_t i = 0; i < declared; ++i) {
      if (row.cells[i]) check(line, arff_.attributes[i], *row.cells[i]);
    }
  }

  static void check(const Line& line, const ArffAttribute& attribute, const std::string& cell) {
    if (attribute.type == ArffAttribute::Type::Number && !parse_number(cell)) {
      line.refuse("'" + cell + "' is no number, as attribute '" + attribute.name + "' must be",
                  "write a number, or ? if it is missing");
    }
    if (attribute.type == ArffAttribute::Type::Nominal &&
        std::ranges::find(attribute.values, cell) == attribute.values.end()) {
      line.refuse("attribute '" + attribute.name + "' has no value '" + cell + "'",
                  "write one that its declaration lists, or add it there");
    }
  }

  std::ifstream stream_;
  Arff arff_;
  bool in_data_ = false;
};

}  // namespace

std::optional<std::size_t> Arff::find(const std::string& name) const {
  const auto found = std::ranges::find(attributes, lower(name), [](const ArffAttribute& attribute) {
    return lower(attribute.name);
  });
  if (found == attributes.end()) return std::nullopt;
  return static_cast<std::size_t>(found - attributes.begin());
}

std::size_t Arff::column(const std::string& name) const {
  if (const auto found = find(name)) return *found;
  throw InvalidArgument(file.string() + " has no attribute '" + name +
                        "'; declare it with @ATTRIBUTE");
}

const std::string& Arff::text(const ArffRow& row, std::size_t column) const {
  if (const auto& cell = row.cells.at(column)) return *cell;
  throw InvalidArgument(file.string() + ":" + std::to_string(row.line) + ": '" +
                        attributes.at(column).name + "' is missing; it is needed in every row");
}

std::optional<double> Arff::number(const ArffRow& row, std::size_t column) const {
  const auto& cell = row.cells.at(column);
  const ArffAttribute& attribute = attributes.at(column);
  if (!cell || attribute.type == ArffAttribute::Type::Text) return std::nullopt;
  if (attribute.type == ArffAttribute::Type::Nominal) {
    return static_cast<double>(std::ranges::find(attribute.values, *cell) -
                               attribute.values.begin());
  }
  const auto value = parse_number(*cell);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

Arff read_arff(const std::filesystem::path& file) { return ArffReader(file).read(); }

}  // namespace skein::benchmarks::selection
