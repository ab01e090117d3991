#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <system_error>
#include <vector>

#include "command/commands.hpp"
#include "command/look/service_names.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "command/print/wrapped.hpp"
#include "core/printable.hpp"
#include "core/system/passing_error.hpp"
#include "entity/entity_access.hpp"
#include "feature_findings.hpp"
#include "recording/mcap/reader.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "skein/component_registry.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestDifference = 4096;
constexpr std::size_t kLongestPlace = 4096;
constexpr std::size_t kLongestLine = std::size_t{16} << 20;

void print_decision(const introspection::Decision& record) {
  std::fputs(folded(explain(record), terminal_width()).c_str(), stdout);
  std::fflush(stdout);
}

void print_decision_json(const introspection::Decision& record) {
  print_json(json_of(record), false);
}

bool is_wanted(const introspection::Decision& record, const DecisionsArguments& arguments) {
  return arguments.entity.empty() || is_entity_named(record.entity, arguments.entity);
}

void watch(const DecisionsArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "decisions");
  introspection::Reader<introspection::Decision> reader(
      EntityAccess::participant(entity), introspection::kTopic<introspection::Decision>,
      [&arguments](const introspection::Decision& record) {
        if (!is_wanted(record, arguments)) return;
        arguments.json ? print_decision_json(record) : print_decision(record);
      });
  tell_waiting(arguments, "the next decision");
  interruption.wait(arguments.seconds);
}

// What comes out differently, in words; empty where nothing does.
std::string difference(const introspection::Decision& record,
                       const StrategyFactory& strategies) try {
  const auto attempts = replay(record, strategies);
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const introspection::Attempt& was = record.attempts[i];
    const introspection::Attempt& is = attempts[i];
    if (same_choice(is, was)) continue;
    return "choice " + std::to_string(i + 1) + " was " + was.csp + " (" + was.reason +
           "), and is now " + is.csp + " (" + is.reason + ")";
  }
  return {};
} catch (const InvalidArgument& error) {
  return error.what();
}

StrategyFactory strategies_of(const DecisionsArguments& arguments) {
  ComponentRegistry registry;
  for (const std::string& plugin : arguments.plugins) registry.load_plugin(plugin);
  StrategyFactory strategies;
  for (const auto& strategy : registry.strategies()) strategies.add(strategy);
  return strategies;
}

introspection::Decision parse(const std::string& line, const std::string& place) {
  try {
    return idl::from_json<introspection::Decision>(line);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(place + ": " + (line.starts_with('{') ? "" : "no log of decisions: ") +
                          error.what());
  }
}

/// Whoever wrote the line was killed, or the disk was full, before the line was whole.
bool is_cut(const std::string& line, bool last) {
  return line.starts_with('{') && (last || !line.ends_with('}'));
}

/// As std::getline(); a longer line is none of a log.
bool next_line(std::istream& file, std::string& line, const std::string& place) {
  line.clear();
  for (int c = file.rdbuf()->sbumpc(); c != '\n'; c = file.rdbuf()->sbumpc()) {
    if (c == std::char_traits<char>::eof()) {
      file.setstate(std::ios::eofbit);
      return !line.empty();
    }
    if (line.size() == kLongestLine) {
      throw InvalidArgument(place + ": no log of decisions: this line has more than " +
                            std::to_string(kLongestLine >> 20) + " MiB");
    }
    line += static_cast<char>(c);
  }
  return true;
}

using Visit = std::function<void(const introspection::Decision& record, const std::string& place)>;

void for_each_in_log(const std::string& log, const Visit& visit) {
  const auto refuse = [&](int reason) {
    throw_for_file(reason, "the log of decisions '" + log +
                               "' cannot be read: " + std::generic_category().message(reason));
  };
  std::ifstream file(log);
  if (!file) refuse(errno);
  if (std::filesystem::is_directory(log)) refuse(EISDIR);
  std::size_t count = 0;
  for (std::string line; next_line(file, line, log + ":" + std::to_string(++count));) {
    const std::string place = log + ":" + std::to_string(count);
    if (line.empty()) continue;
    const bool last = file.eof();  // no newline ends it
    if (is_cut(line, last)) {
      std::fprintf(stderr,
                   "skein: %s: the %sline is cut off, and left out: who wrote it ended, or the "
                   "disk was full, before it was whole\n",
                   printable(place, kLongestPlace).c_str(), last ? "last " : "");
      continue;
    }
    visit(parse(line, place), place);
  }
}

void for_each_in_recording(const std::string& file, const Visit& visit) {
  const recording::Reader reader(file);
  recording::Selection selection;
  selection.topics = {introspection::kTopic<introspection::Decision>.name};
  auto messages = reader.messages(selection);
  std::size_t count = 0;
  while (const auto message = messages.next()) {
    visit(idl::decode_message<introspection::Decision>(message->data),
          file + ", decision " + std::to_string(++count));
  }
}

void print_difference(const introspection::Decision& record, const std::string& place,
                      const std::string& what, bool json) {
  if (json) {
    print_json({{"place", place},
                {"decision", record.number},
                {"entity", record.entity},
                {"difference", what}},
               false);
    return;
  }
  std::printf("%s: decision %llu of %s: %s\n", printable(place, kLongestPlace).c_str(),
              static_cast<unsigned long long>(record.number), printable(record.entity).c_str(),
              printable(what, kLongestDifference).c_str());
}

void print_counts(std::size_t count, std::size_t different, bool json) {
  if (json) {
    print_json({{"decisions", count}, {"different", different}}, false);
  } else {
    std::printf("%zu decisions, %zu come out differently\n", count, different);
  }
}

void tell_findings(const FeatureFindings& features) {
  for (const std::string& sentence : features.sentences())
    std::fprintf(stderr, "skein: %s\n", sentence.c_str());
}

// 0 where every decision comes out again; 1 otherwise.
int read_log(const DecisionsArguments& arguments) {
  const StrategyFactory strategies = strategies_of(arguments);
  std::size_t count = 0, different = 0;
  FeatureFindings features;
  const auto read_one = [&](const introspection::Decision& record, const std::string& place) {
    if (!is_wanted(record, arguments)) return;
    ++count;
    if (!arguments.replays) {
      features.add(record);
      arguments.json ? print_decision_json(record) : print_decision(record);
    } else if (const std::string what = difference(record, strategies); !what.empty()) {
      ++different;
      print_difference(record, place, what, arguments.json);
    }
  };
  arguments.log.ends_with(".mcap") ? for_each_in_recording(arguments.log, read_one)
                                   : for_each_in_log(arguments.log, read_one);
  if (count == 0) {
    const std::string whose = arguments.entity.empty() ? "" : " of " + printable(arguments.entity);
    std::fprintf(stderr, "skein: %s holds no decisions%s\n",
                 printable(arguments.log, kLongestPlace).c_str(), whose.c_str());
  }
  tell_findings(features);
  if (!arguments.replays) return 0;
  print_counts(count, different, arguments.json);
  return different == 0 ? 0 : 1;
}

}  // namespace

int show_decisions(const DecisionsArguments& arguments) {
  if (!arguments.log.empty()) return read_log(arguments);
  watch(arguments);
  return 0;
}

}  // namespace skein::command
