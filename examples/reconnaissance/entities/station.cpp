#include "station.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>

#include "convert.hpp"
#include "mission/places.hpp"
#include "report/joint_record.hpp"
#include "report/report.hpp"
#include "skein/error.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

/// Beside the file at first, then in its place: a reader finds a whole one.
void write_whole(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path beside = file.string() + ".new";
  {
    std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
    stream << text << std::flush;
    if (!stream) throw skein::Unavailable("the result cannot be written: " + beside.string());
  }
  std::filesystem::rename(beside, file);
}

/// Not only at the end of the flight: throws where the file could not be written.
void try_writing(const std::filesystem::path& file) {
  const std::filesystem::path beside = file.string() + ".new";
  if (!std::ofstream(beside, std::ios::app))
    throw skein::InvalidArgument("parameter 'Results': " + beside.string() +
                                 " cannot be written; name a place where it can");
  std::filesystem::remove(beside);
}

std::vector<RunwayText> runways_of(const skein::ParameterValues& values, std::size_t aircraft) {
  auto runways = parse_runways(values.find<std::string>("Runways").value_or(""));
  if (runways.size() == aircraft) return runways;
  throw skein::InvalidArgument(
      fmt::format("parameters 'Aircraft' and 'Runways': {} aircraft need as many runways, not {}",
                  aircraft, runways.size()));
}

}  // namespace

Station::Station(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      results_(values.find<std::string>("Results").value_or("reconnaissance")),
      mission_(values.find<std::string>("Mission").value_or("reconnaissance")),
      command_(values.find<std::string>("Command").value_or("")),
      origin_(parse_runway(values.get<std::string>("Runway")).threshold),
      ground_(ground_of(values)),
      member_(
          entity, values,
          [this](Tick tick) {
            if (link_ && is_due(topic::kLinkPicture.period, tick)) link_->relay(tick);
          },
          parse_names(values.find<std::string>("Aircraft").value_or(""))) {
  const auto systems = parse_names(values.find<std::string>("Aircraft").value_or(""));
  if (systems.empty()) {
    aircraft_.emplace_back(InSystem(entity), values,
                           parse_runway(values.get<std::string>("Runway")));
  } else {
    const auto runways = runways_of(values, systems.size());
    for (std::size_t i = 0; i < systems.size(); ++i)
      aircraft_.emplace_back(InSystem(entity, systems[i]), values, runways[i]);
    link_.emplace(entity, LocalFrame(origin_), systems);
  }
  try_writing(results_.string() + ".json");
}

int Station::run(const std::stop_token& told_to_end) {
  for (GroundStation& each : aircraft_) each.begin();
  const auto begun = entity_.clock().now();
  member_.start();
  std::vector<std::string> ended;
  for (GroundStation& each : aircraft_) ended.push_back(each.await_end(told_to_end));
  const std::chrono::duration<double> took = entity_.clock().now() - begun;

  std::vector<Verdict> verdicts;
  for (std::size_t i = 0; i < aircraft_.size(); ++i)
    verdicts.push_back(aircraft_[i].verdict(ended[i]));
  const Verdict verdict = joint(verdicts);
  for (const Check& check : verdict.checks)
    fmt::print("{:6} {}: {}\n", check.passed ? "ok" : "FAILED", check.name, check.text);
  fmt::print(
      "{} after {:.0f} s in the air and {:.1f} km; it took {:.1f} s, {:.0f} ticks a second\n",
      verdict.passed ? "passed" : (verdict.flown ? "FAILED" : "NOT FLOWN"), verdict.duration_s,
      verdict.distance_m / 1000, took.count(),
      static_cast<double>(aircraft_.back().last_tick()) / took.count());
  std::fflush(stdout);
  write(verdict);
  return exit_code(verdict);
}

Verdict Station::joint(const std::vector<Verdict>& verdicts) const {
  if (verdicts.size() == 1) return verdicts.front();
  std::vector<OfAircraft<Verdict>> all;
  for (std::size_t i = 0; i < verdicts.size(); ++i)
    all.push_back({aircraft_[i].system(), verdicts[i]});
  return joint_verdict(all);
}

void Station::write(const Verdict& verdict) const {
  std::vector<OfAircraft<MissionRecord>> records;
  for (const GroundStation& each : aircraft_) {
    records.push_back({each.system(), each.record()});
    // Who judges an aircraft by its tracks has it as the first, and all others beside it.
    const std::string of = aircraft_.size() > 1 ? "-" + each.system() : "";
    write_whole(results_.string() + of + ".csv",
                "time_s,aircraft,latitude_deg,longitude_deg,height_m,height_above_ground_m\n" +
                    each.tracks());
  }
  MissionRecord record = records.size() == 1 ? records.front().what : joint_record(records);
  record.mission = mission_;
  record.command = command_;
  record.origin = origin_;
  record.verdict = verdict;
  record.ground = ground_around(record, 180, ground_);
  write_whole(results_.string() + ".json", to_json(record));
  write_whole(results_.string() + ".html", to_html(record));
  write_whole(results_.string() + ".junit.xml", to_junit(verdict, mission_));
}

}  // namespace reconnaissance
