#include "csv_table.hpp"

#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>

#include "skein/error.hpp"

namespace skein::command {
namespace {

using CellJson = nlohmann::ordered_json;
using VisitCell = std::function<void(const std::string& name, const CellJson& value)>;

CellJson parsed(const std::string& json) {
  try {
    return CellJson::parse(json);
  } catch (const CellJson::exception& error) {
    throw InvalidArgument(error.what());
  }
}

/// Quoted if it has to be (RFC 4180, section 2).
std::string quoted_cell(std::string text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  for (auto at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2))
    text.insert(at, 1, '"');
  return '"' + text + '"';
}

std::string cell_of(const CellJson& value) {
  return quoted_cell(value.is_string() ? value.get<std::string>()
                     : value.is_null() ? ""
                                       : value.dump());
}

/// Visits what is one column each; `is_whole` says so of an array.
void flatten(const std::string& name, const CellJson& value,
             const std::function<bool(const std::string&, const CellJson&)>& is_whole,
             const VisitCell& visit) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items())
      flatten(name.empty() ? key : name + "." + key, member, is_whole, visit);
  } else if (value.is_array() && !is_whole(name, value)) {
    for (std::size_t i = 0; i < value.size(); ++i)
      flatten(name + "[" + std::to_string(i) + "]", value[i], is_whole, visit);
  } else {
    visit(name.empty() ? "value" : name, value);
  }
}

}  // namespace

void CsvTable::add(const std::string& json) {
  const auto note_long = [this](const std::string& name, const CellJson& array) {
    if (array.size() > kMostElements) long_arrays_.insert(name);
    return long_arrays_.contains(name);
  };
  flatten("", parsed(json), note_long, [this](const std::string& name, const CellJson&) {
    if (known_.insert(name).second) columns_.push_back(name);
  });
}

// Elements of an array that turned out to be long later have no column.
void CsvTable::end() {
  std::erase_if(columns_, [this](const std::string& name) {
    for (auto at = name.find('['); at != std::string::npos; at = name.find('[', at + 1)) {
      if (long_arrays_.contains(name.substr(0, at))) return true;
    }
    return false;
  });
}

void CsvTable::write_head(std::ostream& output) const {
  output << (known_.contains("time") ? "recorded_time" : "time");
  for (const std::string& name : columns_) output << ',' << quoted_cell(name);
  output << "\r\n";
}

void CsvTable::write_row(std::ostream& output, std::uint64_t nanoseconds,
                         const std::string& json) const {
  std::map<std::string, std::string> cells;
  flatten(
      "", parsed(json),
      [this](const std::string& name, const CellJson&) { return long_arrays_.contains(name); },
      [&](const std::string& name, const CellJson& value) { cells[name] = cell_of(value); });
  std::array<char, 40> time{};
  std::snprintf(time.data(), time.size(), "%llu.%09llu",
                static_cast<unsigned long long>(nanoseconds / 1'000'000'000),
                static_cast<unsigned long long>(nanoseconds % 1'000'000'000));
  output << time.data();
  for (const std::string& name : columns_) output << ',' << cells[name];
  output << "\r\n";
}

}  // namespace skein::command
