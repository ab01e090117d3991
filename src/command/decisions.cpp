#include <cstdio>
#include <fstream>
#include <vector>

#include "commands.hpp"
#include "core/printable.hpp"
#include "interruption.hpp"
#include "rpc/introspection_topic.hpp"
#include "skein/component_registry.hpp"
#include "skein/decision.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestDifference = 4096;

void print(const introspection::Decision& record) {
  std::fputs(explain(record).c_str(), stdout);
  std::fflush(stdout);
}

void watch(const DecisionsArguments& arguments) {
  const Interruption interruption;
  Entity entity(arguments.entity_options("decisions"));
  introspection::Reader<introspection::Decision> reader(entity.participant(),
                                                        introspection::kDecisions, print);
  interruption.wait(arguments.seconds);
}

// What comes out differently, in words; empty where nothing does.
std::string difference(const introspection::Decision& record,
                       const StrategyFactory& strategies) try {
  const auto attempts = replay(record, strategies);
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const introspection::Attempt& was = record.attempts[i];
    const introspection::Attempt& is = attempts[i];
    if (is == was) continue;
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
    throw InvalidArgument(place + ": " + error.what());
  }
}

// 0 where every decision comes out again; 1 otherwise.
int read(const DecisionsArguments& arguments) {
  std::ifstream file(arguments.log);
  if (!file) throw InvalidArgument("the log of decisions '" + arguments.log + "' cannot be read");
  const StrategyFactory strategies = strategies_of(arguments);
  std::size_t count = 0, different = 0;
  for (std::string line; std::getline(file, line);) {
    const std::string place = arguments.log + ":" + std::to_string(++count);
    const introspection::Decision record = parse(line, place);
    if (!arguments.replays) {
      print(record);
    } else if (const std::string what = difference(record, strategies); !what.empty()) {
      ++different;
      std::printf("%s: decision %llu of %s: %s\n", place.c_str(),
                  static_cast<unsigned long long>(record.number), printable(record.entity).c_str(),
                  printable(what, kLongestDifference).c_str());
    }
  }
  if (!arguments.replays) return 0;
  std::printf("%zu decisions, %zu come out differently\n", count, different);
  return different == 0 ? 0 : 1;
}

}  // namespace

int show_decisions(const DecisionsArguments& arguments) {
  if (!arguments.log.empty()) return read(arguments);
  watch(arguments);
  return 0;
}

}  // namespace skein::command
