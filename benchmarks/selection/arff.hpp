#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace skein::benchmarks::selection {

/// A column of an ARFF file.
struct ArffAttribute {
  enum class Type { Number, Text, Nominal };
  std::string name;
  Type type = Type::Text;
  std::vector<std::string> values{};  ///< Of a nominal attribute, as declared.
};

/// A row of an ARFF file: a cell per attribute, nullopt where it says `?`.
struct ArffRow {
  std::size_t line = 0;  ///< From 1.
  std::vector<std::optional<std::string>> cells;
};

/// A table in the Attribute-Relation File Format.
struct Arff {
  std::filesystem::path file;
  std::vector<ArffAttribute> attributes;
  std::vector<ArffRow> rows;

  /// The attribute of this name, whatever its case; nullopt if there is none.
  std::optional<std::size_t> find(const std::string& name) const;
  /// The same. Throws InvalidArgument with the file if there is none.
  std::size_t column(const std::string& name) const;
  /// Throws InvalidArgument with file and line if the cell is missing.
  const std::string& text(const ArffRow& row, std::size_t column) const;
  /// A cell of type Number, or the place of a nominal value among those declared; nullopt if it is
  /// missing or not finite, or text.
  std::optional<double> number(const ArffRow& row, std::size_t column) const;
};

/// Reads and checks a file: each row has a value per attribute, numbers are numbers, and nominal
/// values are among those declared. Keywords and types may be in either case, names and values in
/// single or double quotes, in which a backslash escapes. Sparse rows and relational attributes are
/// refused. Throws InvalidArgument with the file, the line, the cause and the remedy.
Arff read_arff(const std::filesystem::path& file);

}  // namespace skein::benchmarks::selection
