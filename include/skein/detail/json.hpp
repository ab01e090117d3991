#pragma once

#include <concepts>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "skein/detail/cdr.hpp"

namespace skein::idl {

/// Writes JSON text. Numbers read back unchanged; those that JSON lacks become "NaN", "Infinity"
/// and "-Infinity". Invalid UTF-8 becomes replacement characters. With Style::Text it writes for
/// people instead, and only the first elements of what is long:
/// `Route{points=[Point{x=1, y=2}], name="north"}`.
class JsonWriter {
 public:
  enum class Style { Json, Text };
  explicit JsonWriter(Style style = Style::Json) : style_(style) {}

  /// `type` is for people.
  void begin_object(std::string_view type = {});
  void end_object() { close('}'); }
  void begin_array();
  void end_array() { close(']'); }
  /// Whether the rest of an array of that size is left out, of which so many elements are written.
  bool omits(std::size_t written, std::size_t size);
  void key(std::string_view name);
  template <Primitive T>
  void write(T value);
  void write_string(std::string_view text);
  /// Text that people read without quotes.
  void write_name(std::string_view name);
  void write_null();
  /// A value that is JSON already.
  void write_raw(std::string_view json);
  std::string take() { return std::move(text_); }

 private:
  void separate();
  void close(char bracket);

  const Style style_;
  std::string text_;
  bool first_ = true;
};

/// One value of a JSON text, with its path. Exists only inside parse_json(). Throws InvalidArgument
/// with the path (`$.points[3].x`) for everything that does not fit.
class JsonReader {
 public:
  template <Primitive T>
  T read() const;
  std::string read_string() const;
  std::size_t array_size() const;
  JsonReader element(std::size_t index) const;
  JsonReader member(std::string_view name) const;
  bool has_member(std::string_view name) const;
  bool is_number() const;
  bool is_null() const;
  bool is_object() const;
  bool is_empty_string() const;

  /// Checks that this is an object with exactly these members, and tells of all that are wrong;
  /// `type` is for messages.
  void expect_members(std::string_view type, std::span<const std::string_view> names) const;
  /// The index of the enumerator that the text names.
  std::uint32_t read_enum(std::string_view type, std::span<const std::string_view> names) const;
  void expect_size(std::size_t size) const;
  void check_bound(std::size_t size, std::size_t bound, const char* place) const;
  [[noreturn]] void fail(const std::string& reason) const;

  explicit JsonReader(const void* node) : node_(node) {}

 private:
  JsonReader(const void* node, const JsonReader* parent, std::string_view name, std::size_t index);
  std::string path() const;

  const void* node_;
  const JsonReader* parent_ = nullptr;
  std::string_view name_;
  std::size_t index_ = 0;
  unsigned depth_ = 0;
};

/// Parses `text` and passes the whole value to `read`. Throws InvalidArgument with line and column
/// if it is no JSON.
void parse_json(std::string_view text, const std::function<void(const JsonReader&)>& read);

}  // namespace skein::idl
