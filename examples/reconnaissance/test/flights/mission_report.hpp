#pragma once

#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "test/tools/mission_run.hpp"

namespace skein::test {

/// Arguments, and then more.
inline std::vector<std::string> with(std::vector<std::string> arguments,
                                     const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// The JSON twin of the report of a mission that calls its results so.
inline nlohmann::json report_of(const MissionRun& run, const std::string& results) {
  std::ostringstream text;
  text << std::ifstream(run.file(results + ".json")).rdbuf();
  return nlohmann::json::parse(text.str());
}

/// Whether a condition is kept, by its name.
inline bool kept(const nlohmann::json& report, const std::string& name) {
  for (const auto& check : report["checks"])
    if (check["name"] == name) return check["passed"].get<bool>();
  FAIL("there is no condition " << name);
  return false;
}

}  // namespace skein::test
