// Writes pages as people see them after a mission: `flown.html`, `hostile.html`, in which texts try
// to be markup and numbers are none, and `grounded.html`, of a mission that never began. One
// argument: the folder.
#include "report_scene.hpp"

#include <filesystem>
#include <fstream>
#include <limits>

using namespace reconnaissance;

namespace {

MissionRecord hostile_mission() {
  MissionRecord record = test::flown_mission();
  const std::string text = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&\xff";
  record.mission = record.command = text;
  for (Target& target : record.targets) target.name = text;
  for (KnownThreat& threat : record.threats) threat.kind = text;
  for (NoFlyZone& zone : record.zones) zone.name = text;
  for (Stage& phase : record.phases) phase.name = phase.reason = text;
  for (DecisionTold& decision : record.decisions)
    decision.entity = decision.question = decision.chosen = decision.reason = text;
  for (Fault& fault : record.faults) fault.what = fault.noticed_by = fault.answer = text;
  for (Latencies& latencies : record.latencies) latencies.name = text;
  for (Check& check : record.verdict.checks) check.name = check.text = text;
  record.targets[0].achieved_sample_m = std::numeric_limits<double>::quiet_NaN();
  record.track[100].place.height_m = std::numeric_limits<double>::infinity();
  return record;
}

MissionRecord grounded_mission() {
  MissionRecord record;
  record.mission = "reconnaissance";
  record.verdict.reason = "the mission was aborted";
  record.verdict.checks = {{"flown to its end", false, "the mission was aborted"}};
  return record;
}

void write(const std::filesystem::path& file, const MissionRecord& record) {
  std::ofstream(file, std::ios::binary) << to_html(record);
}

}  // namespace

int main(int, char** arguments) {
  const std::filesystem::path folder = arguments[1];
  write(folder / "flown.html", test::flown_mission());
  write(folder / "hostile.html", hostile_mission());
  write(folder / "grounded.html", grounded_mission());
}
