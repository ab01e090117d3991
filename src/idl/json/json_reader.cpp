#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/suggestion.hpp"
#include "skein/detail/json.hpp"

namespace skein::idl {
namespace {

using nlohmann::json;

constexpr unsigned kMaximumJsonDepth = 4 * kMaximumNesting;

const json& value_of(const void* node) { return *static_cast<const json*>(node); }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// `line 3, column 5`.
std::string place_of(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const auto line = std::ranges::count(before, '\n') + 1;
  const auto column = before.size() - (before.rfind('\n') + 1) + 1;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// Where the word begins of which a parser may have read a part.
std::size_t begin_of_word(std::string_view text, std::size_t offset) {
  offset = std::min(offset, text.size());
  while (offset > 0 && is_letter(text[offset - 1])) --offset;
  return offset;
}

/// JSON has no such numbers, and this codec takes them as text.
std::string remedy_for_word(std::string_view text) {
  const auto end = std::ranges::find_if_not(text, is_letter);
  const std::string_view word = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  if (word == "NaN" || word == "nan") return "; write \"NaN\", with its quotes";
  if (word == "Infinity" || word == "inf")
    return "; write \"Infinity\" or \"-Infinity\", with its quotes";
  return {};
}

/// The number that the library could not read, which it tells in quotes.
std::string quoted_number(const std::string& message) {
  const std::size_t begin = message.find('\'') + 1;
  return message.substr(begin, message.find('\'', begin) - begin);
}

std::vector<std::string> strings(std::span<const std::string_view> names) {
  return {names.begin(), names.end()};
}

}  // namespace

JsonReader::JsonReader(const void* node, const JsonReader* parent, std::string_view name,
                       std::size_t index)
    : node_(node), parent_(parent), name_(name), index_(index), depth_(parent->depth_ + 1) {
  if (depth_ > kMaximumJsonDepth) fail("is nested too deep");
}

std::string JsonReader::path() const {
  if (!parent_) return "$";
  if (name_.empty()) return parent_->path() + '[' + std::to_string(index_) + ']';
  return parent_->path() + '.' + std::string(name_);
}

void JsonReader::fail(const std::string& reason) const {
  throw InvalidArgument("JSON: " + path() + ' ' + reason);
}

template <Primitive T>
T JsonReader::read() const {
  const json& value = value_of(node_);
  if constexpr (std::is_same_v<T, bool>) {
    if (!value.is_boolean()) fail("is no boolean");
    return value.get<bool>();
  } else if constexpr (std::is_same_v<T, char>) {
    const std::string text = read_string();
    if (text.size() == 1) return text[0];
    const auto first = text.empty() ? 0u : static_cast<unsigned char>(text[0]);
    if (text.size() != 2 || (first != 0xC2 && first != 0xC3)) fail("is no single character");
    return static_cast<char>((first & 0x03) << 6 | (static_cast<unsigned char>(text[1]) & 0x3F));
  } else if constexpr (std::is_floating_point_v<T>) {
    using Limits = std::numeric_limits<T>;
    if (value == "NaN") return Limits::quiet_NaN();
    if (value == "Infinity") return Limits::infinity();
    if (value == "-Infinity") return -Limits::infinity();
    if (!value.is_number()) fail("is no number");
    const auto number = value.get<double>();
    if (std::abs(number) > static_cast<double>(Limits::max())) fail("is too large");
    return static_cast<T>(number);
  } else {
    if (!value.is_number_integer()) fail("is no integer");
    const bool fits = value.is_number_unsigned() ? std::in_range<T>(value.get<std::uint64_t>())
                                                 : std::in_range<T>(value.get<std::int64_t>());
    if (!fits) fail("is out of range: " + value.dump());
    return value.get<T>();
  }
}

std::string JsonReader::read_string() const {
  if (!value_of(node_).is_string()) fail("is no text");
  return value_of(node_).get<std::string>();
}

std::size_t JsonReader::array_size() const {
  if (!value_of(node_).is_array()) fail("is no array");
  return value_of(node_).size();
}

JsonReader JsonReader::element(std::size_t index) const {
  return JsonReader(&value_of(node_)[index], this, {}, index);
}

bool JsonReader::is_null() const { return value_of(node_).is_null(); }

bool JsonReader::is_object() const { return value_of(node_).is_object(); }

bool JsonReader::is_empty_string() const {
  const auto* text = value_of(node_).get_ptr<const std::string*>();
  return text && text->empty();
}

bool JsonReader::is_number() const { return static_cast<const json*>(node_)->is_number(); }

bool JsonReader::has_member(std::string_view name) const {
  return value_of(node_).is_object() && value_of(node_).contains(name);
}

JsonReader JsonReader::member(std::string_view name) const {
  if (!has_member(name)) fail("lacks the member '" + std::string(name) + "'");
  return JsonReader(&*value_of(node_).find(name), this, name, 0);
}

void JsonReader::expect_members(std::string_view type,
                                std::span<const std::string_view> names) const {
  const json& value = value_of(node_);
  if (!value.is_object()) fail("is no object, as " + std::string(type) + " must be");
  std::string wrong;
  const auto add = [&](const std::string& what) { wrong += (wrong.empty() ? "" : "; it ") + what; };
  for (const auto& [name, member] : value.items()) {
    if (std::ranges::find(names, name) == names.end()) {
      add("has a member '" + name + "', which " + std::string(type) + " has not" +
          suggestion(name, strings(names)));
    }
  }
  for (const std::string_view name : names) {
    if (!value.contains(name)) {
      add("lacks the member '" + std::string(name) + "' of " + std::string(type));
    }
  }
  if (!wrong.empty()) fail(wrong);
}

std::uint32_t JsonReader::read_enum(std::string_view type,
                                    std::span<const std::string_view> names) const {
  const std::string name = read_string();
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    fail("is '" + name + "', which is no value of " + std::string(type) +
         suggestion(name, strings(names)));
  }
  return static_cast<std::uint32_t>(found - names.begin());
}

void JsonReader::expect_size(std::size_t size) const {
  if (array_size() != size) {
    fail("has " + std::to_string(array_size()) + " elements, " + std::to_string(size) +
         " are needed");
  }
}

void JsonReader::check_bound(std::size_t size, std::size_t bound, const char* place) const {
  if (size > bound) {
    fail("does not fit: " + std::string(place) + " holds " + std::to_string(size) +
         " elements, at most " + std::to_string(bound) + " are allowed");
  }
}

void parse_json(std::string_view text, const std::function<void(const JsonReader&)>& read) {
  json value;
  try {
    value = json::parse(text);
  } catch (const json::parse_error& error) {
    const std::size_t place = begin_of_word(text, error.byte > 0 ? error.byte - 1 : 0);
    throw InvalidArgument("JSON: " + place_of(text, place) + ": this is no JSON" +
                          remedy_for_word(text.substr(place)));
  } catch (const json::out_of_range& error) {
    const std::string number = quoted_number(error.what());
    throw InvalidArgument("JSON: " + place_of(text, text.find(number)) + ": " + number +
                          " is too large");
  }
  read(JsonReader(&value));
}

template bool JsonReader::read<bool>() const;
template char JsonReader::read<char>() const;
template std::uint8_t JsonReader::read<std::uint8_t>() const;
template std::int8_t JsonReader::read<std::int8_t>() const;
template std::int16_t JsonReader::read<std::int16_t>() const;
template std::uint16_t JsonReader::read<std::uint16_t>() const;
template std::int32_t JsonReader::read<std::int32_t>() const;
template std::uint32_t JsonReader::read<std::uint32_t>() const;
template std::int64_t JsonReader::read<std::int64_t>() const;
template std::uint64_t JsonReader::read<std::uint64_t>() const;
template float JsonReader::read<float>() const;
template double JsonReader::read<double>() const;

}  // namespace skein::idl
