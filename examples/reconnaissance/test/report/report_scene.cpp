// Writes pages as people see them after a mission: `flown.html`, `pursuit.html`, `hostile.html`, in
// which texts try to be markup and numbers are none, and `grounded.html`, of a mission that never
// began. One argument: the folder.
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
  record.truths = {{text, {{std::numeric_limits<double>::quiet_NaN(), {0, 0, 0}}}}};
  record.targets[0].achieved_sample_m = std::numeric_limits<double>::quiet_NaN();
  record.track[100].place.height_m = std::numeric_limits<double>::infinity();
  return record;
}

/// A target that was followed, and one that was not found; an emitter that was placed.
MissionRecord pursuit_mission() {
  MissionRecord record = test::flown_mission();
  record.mission = "surveillance";
  record.targets = {{.name = "convoy", .line = {{10300, 21900, 0}}, .wanted_sample_m = 0.3},
                    {.name = "van", .line = {{4500, 15900, 0}}, .wanted_sample_m = 0.3},
                    {.name = "north", .line = {{19950, 6650, 0}}, .deviation_m = 80}};
  record.targets[0].wanted_s = record.targets[0].followed_s = 300;
  record.targets[0].collected_s = 700;
  record.targets[1].wanted_s = 300;
  record.targets[2].wanted_deviation_m = 100;
  TrueThing truth{"where the target truly was", {}};
  for (int second = 400; second < 700; ++second) {
    const double way_m = 8 * (second - 400);
    truth.points.push_back({static_cast<double>(second), {11650 - way_m, 20700 + way_m, 0}});
    record.targets[0].path.push_back(truth.points.back());
  }
  record.truths = {truth, {"where the site truly is", {{1, {20000, 6600, 0}}}}};
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
  write(folder / "pursuit.html", pursuit_mission());
  write(folder / "grounded.html", grounded_mission());
}
