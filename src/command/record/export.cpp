#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "command/commands.hpp"
#include "command/print/json_output.hpp"
#include "core/printable.hpp"
#include "core/system/whole_file.hpp"
#include "csv_table.hpp"
#include "recording/recorded_values.hpp"
#include "recording/viewers/perfetto_trace.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

using recording::RecordedValue;
using Counts = nlohmann::ordered_json;

void refuse_existing(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  throw WriteFailed("'" + file.string() +
                    "' is there already; name another one, or remove that one");
}

bool is_standard_output(const std::string& file) { return file == "-"; }

/// A new file, or standard output, which has to be closed.
class Output {
 public:
  explicit Output(std::filesystem::path file) : file_(std::move(file)) {
    if (is_standard_output(file_)) return;
    refuse_existing(file_);
    stream_.open(file_, std::ios::binary);
    check();
  }
  std::ostream& stream() { return stream_.is_open() ? stream_ : std::cout; }
  void close() {
    if (!stream_.is_open()) {
      std::cout.flush();
      return;
    }
    stream_.close();
    check();
  }

 private:
  void check() const {
    if (stream_) return;
    throw WriteFailed("'" + file_.string() +
                      "' cannot be written: " + std::generic_category().message(errno));
  }

  const std::filesystem::path file_;
  std::ofstream stream_;
};

void tell_unread_values(const recording::UnreadValues& unread) {
  if (unread.count > 0)
    std::fprintf(stderr, "skein: %s\n", printable(recording::to_text(unread), 4096).c_str());
}

Counts export_perfetto(const recording::Reader& reader, const std::string& file) {
  refuse_existing(file);
  const auto done = recording::export_to_perfetto(reader, file);
  if (done.malformed > 0) {
    std::fprintf(stderr, "skein: %zu messages could not be read\n", done.malformed);
  }
  return {{"file", file},
          {"events", done.events},
          {"decisions", done.decisions},
          {"malformed", done.malformed}};
}

Counts export_lines(const recording::Reader& reader, const ExportArguments& arguments) {
  Output output(arguments.lines);
  std::uint64_t count = 0;
  tell_unread_values(
      recording::for_each_value(reader, arguments.topics, [&](const RecordedValue& value) {
        output.stream() << "{\"topic\":" << Counts(value.channel.topic).dump()
                        << ",\"time_ns\":" << value.log_time << ",\"value\":" << value.json
                        << "}\n";
        ++count;
        return true;
      }));
  output.close();
  return {{"file", arguments.lines}, {"values", count}};
}

/// `calls/A_I/f/request` as `calls_A_I_f_request`.
std::string file_name_of(const std::string& topic) {
  std::string name = topic;
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '-') c = '_';
  }
  return name + ".csv";
}

struct NamedTable {
  CsvTable rows;
  std::uint64_t count = 0;
  std::string file;
};

/// By topic. A file's name that two topics share has a number added.
std::map<std::string, NamedTable> tables_of(const recording::Reader& reader,
                                            const std::vector<std::string>& topics) {
  std::map<std::string, NamedTable> tables;
  tell_unread_values(recording::for_each_value(reader, topics, [&](const RecordedValue& value) {
    if (!topics.empty() || recording::is_of_topic(value.channel)) {
      auto& table = tables[value.channel.topic];
      table.rows.add(value.json);
      ++table.count;
    }
    return true;
  }));
  std::map<std::string, int> used;
  for (auto& [topic, table] : tables) {
    table.rows.end();
    table.file = file_name_of(topic);
    if (const int before = used[table.file]++; before > 0)
      table.file.insert(table.file.size() - 4, "-" + std::to_string(before + 1));
  }
  return tables;
}

Counts export_csv(const recording::Reader& reader, const ExportArguments& arguments) {
  auto tables = tables_of(reader, arguments.topics);
  if (tables.empty()) throw InvalidArgument("the recording has no values of topics");
  const std::filesystem::path folder(arguments.csv);
  std::error_code ignored;  // the files tell it
  std::filesystem::create_directories(folder, ignored);
  Counts counts{{"folder", arguments.csv}, {"tables", Counts::array()}};
  for (auto& [topic, table] : tables) {
    Output output(folder / table.file);
    table.rows.write_head(output.stream());
    recording::for_each_value(reader, {topic}, [&, &table = table](const RecordedValue& value) {
      table.rows.write_row(output.stream(), value.log_time, value.json);
      return true;
    });
    output.close();
    counts["tables"].push_back({{"topic", topic}, {"file", table.file}, {"rows", table.count}});
  }
  return counts;
}

/// A text of the counts as a terminal may have it.
std::string exported_text(const Counts& text) {
  const auto plain = text.get<std::string>();
  return printable(plain, plain.size());
}

void print_exported(const Counts& counts) {
  if (counts.contains("tables")) {
    for (const auto& table : counts["tables"])
      std::printf("%s/%s: %llu rows\n", exported_text(counts["folder"]).c_str(),
                  exported_text(table["file"]).c_str(), table["rows"].get<unsigned long long>());
  } else if (counts.contains("values")) {
    std::printf("%s: %llu values\n", exported_text(counts["file"]).c_str(),
                counts["values"].get<unsigned long long>());
  } else {
    std::printf("%s: %llu events of calls, %llu decisions\n", exported_text(counts["file"]).c_str(),
                counts["events"].get<unsigned long long>(),
                counts["decisions"].get<unsigned long long>());
  }
}

}  // namespace

int export_recording(const ExportArguments& arguments) {
  if (is_standard_output(arguments.csv) || is_standard_output(arguments.perfetto))
    throw InvalidArgument("'-', standard output, is for --lines alone; give a name");
  const recording::Reader reader(arguments.file);
  const Counts counts = !arguments.csv.empty()     ? export_csv(reader, arguments)
                        : !arguments.lines.empty() ? export_lines(reader, arguments)
                                                   : export_perfetto(reader, arguments.perfetto);
  if (is_standard_output(arguments.lines)) return 0;
  arguments.json ? print_json(counts, false) : print_exported(counts);
  return 0;
}

}  // namespace skein::command
