#include <cmath>
#include <filesystem>
#include <system_error>

#include "core/system/whole_file.hpp"
#include "service_history.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"
#include "wire_values.hpp"

namespace skein {
namespace {

using introspection::Experience;

constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kLargestHistory = std::size_t{256} << 20;

introspection::PastRun run_of(const History::Sample& sample) {
  return {wire_values::list(*sample.features),
          wire_values::ns(sample.took),
          sample.accepted,
          sample.late,
          wire_values::list(sample.quality),
          sample.request,
          sample.after};
}

/// Files from before a quality had to be a number may have others.
std::optional<double> quality_of(const introspection::PastRun& run) {
  const auto quality = wire_values::maybe(run.quality);
  return quality && std::isfinite(*quality) ? quality : std::nullopt;
}

History::Sample sample_of(const introspection::PastRun& run) {
  return {std::make_shared<const Features>(wire_values::features(run.features)),
          wire_values::duration(run.took),
          run.accepted,
          run.late,
          quality_of(run),
          run.request,
          run.after};
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InvalidArgument("the Head's history '" + path + "' " + why);
}

}  // namespace

std::string History::to_json() const {
  Experience experience;
  experience.version = kVersion;
  for (const auto& [interface, service] : services_) {
    for (const auto& record : service->records()) {
      auto& csp = experience.csps.emplace_back();
      csp.service = interface;
      csp.csp = record.csp;
      csp.changes = {record.drift.slower, record.drift.faster, record.drift.slower_since,
                     record.drift.faster_since};
      for (const Sample& sample : record.samples) csp.runs.push_back(run_of(sample));
    }
    const PastDecisions& decisions = service->decisions;
    experience.decisions.push_back({interface, decisions.made, decisions.explored});
  }
  return idl::to_json(experience);
}

History History::from_json(const std::string& text) {
  const auto experience = idl::from_json<Experience>(text);
  if (experience.version != kVersion) {
    throw InvalidArgument("$.version is " + std::to_string(experience.version) +
                          ", and this program reads " + std::to_string(kVersion));
  }
  History history;
  for (const auto& csp : experience.csps) {
    if (csp.runs.empty() || csp.runs.size() > kKept) {
      throw InvalidArgument("$.csps: '" + csp.csp + "' has " + std::to_string(csp.runs.size()) +
                            " runs; there are 1 to " + std::to_string(kKept));
    }
    entity::ServiceHistory::Record record{csp.csp, {}, {}};
    record.drift = {csp.changes.slower, csp.changes.faster, csp.changes.slower_since,
                    csp.changes.faster_since};
    for (const auto& run : csp.runs) record.samples.push_back(sample_of(run));
    history.service(csp.service).restore(std::move(record));
  }
  for (const auto& decisions : experience.decisions)
    history.service(decisions.service).decisions = {decisions.made, decisions.explored};
  return history;
}

void History::save(const std::string& path) const {
  write_whole_file("the Head's history", path, to_json() + '\n');
}

History History::load(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error) && !error) return {};
  const std::string text = read_whole_file("the Head's history", path, kLargestHistory);
  try {
    return from_json(text);
  } catch (const InvalidArgument& wrong) {
    refuse(path, std::string("is damaged or of another version: ") + wrong.what() +
                     "; remove it to begin anew");
  }
}

}  // namespace skein
