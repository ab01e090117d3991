#include <filesystem>
#include <fstream>
#include <sstream>

#include "skein/detail/history.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"
#include "wire_values.hpp"

namespace skein {
namespace {

using introspection::Experience;

constexpr std::uint32_t kVersion = 1;

introspection::PastRun run_of(const History::Sample& sample) {
  return {wire_values::list(sample.features),
          wire_values::ns(sample.took),
          sample.accepted,
          sample.late,
          wire_values::list(sample.quality),
          sample.decision};
}

History::Sample sample_of(const introspection::PastRun& run) {
  return {wire_values::features(run.features),
          wire_values::duration(run.took),
          run.accepted,
          run.late,
          wire_values::maybe(run.quality),
          run.decision};
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InvalidArgument("the Head's history '" + path + "' " + why);
}

}  // namespace

std::string History::to_json() const {
  Experience experience;
  experience.version = kVersion;
  for (const auto& [key, record] : records_) {
    auto& csp = experience.csps.emplace_back();
    csp.service = key.first;
    csp.csp = key.second;
    csp.surprises = record.surprises;
    for (const Sample& sample : record.samples) csp.runs.push_back(run_of(sample));
  }
  for (const auto& [interface, decisions] : decisions_) {
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
    Record& record = history.records_[{csp.service, csp.csp}];
    record.surprises = csp.surprises;
    for (const auto& run : csp.runs) record.samples.push_back(sample_of(run));
  }
  for (const auto& decisions : experience.decisions) {
    history.decisions_[decisions.service] = {decisions.made, decisions.explored};
  }
  return history;
}

void History::save(const std::string& path) const {
  const std::string fresh = path + ".new";
  std::ofstream file(fresh, std::ios::binary | std::ios::trunc);
  file << to_json() << '\n';
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(fresh, path, error);
  if (!file || error)
    refuse(path, "cannot be written; name a file in a folder that may be written to");
}

History History::load(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error) && !error) return {};
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  if (!file) refuse(path, "cannot be read");
  try {
    return from_json(text.str());
  } catch (const InvalidArgument& wrong) {
    refuse(path, std::string("is damaged or of another version: ") + wrong.what() +
                     "; remove it to begin anew");
  }
}

}  // namespace skein
