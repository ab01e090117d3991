#include "mission/supervise/mission_log.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "core/printable.hpp"
#include "core/system/state_folder.hpp"
#include "core/utc_text.hpp"
#include "skein/error.hpp"

namespace skein::launch {
namespace {

std::string file_name(std::string_view text) {
  std::string name(text);
  std::replace_if(
      name.begin(), name.end(),
      [](char c) {
        return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                 c == '_' || c == '-');
      },
      '_');
  return name;
}

/// `2026-11-24T23:47:14.123Z 12.345678`.
std::string both_clocks(Time launched) {
  using namespace std::chrono;
  std::array<char, 32> since_launch{};
  std::snprintf(since_launch.data(), since_launch.size(), " %.6f",
                duration<double>(steady_clock::now() - launched).count());
  return utc_text(system_clock::now()) + since_launch.data();
}

const std::filesystem::path& made(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder / "processes", failure);
  if (failure) {
    throw Unavailable("the log folder " + folder.string() + " cannot be made (" +
                      failure.message() + "); name another one by --log-folder");
  }
  return folder;
}

}  // namespace

std::filesystem::path log_folder(const profile::MissionProfile& mission) {
  const std::string name = file_name(mission.name) + "-" + std::to_string(mission.domain);
  const std::filesystem::path state = state_folder();
  return state.empty() ? state : state / name;
}

MissionLog::MissionLog(const std::filesystem::path& folder, const RotatingFile::Limits& limits)
    : folder_(made(folder)), limits_(limits), events_(folder_ / "mission.log", limits) {}

RotatingFile& MissionLog::file_of(std::string_view process) {
  if (const auto found = files_.find(process); found != files_.end()) return found->second;
  const auto slash = std::min(process.find('/'), process.size());
  std::string name = file_name(process.substr(0, slash));
  if (slash < process.size()) name += "." + file_name(process.substr(slash + 1));
  RotatingFile file(folder_ / "processes" / (name + ".log"), limits_);
  return files_.emplace(std::string(process), std::move(file)).first->second;
}

bool MissionLog::write(RotatingFile& file, std::string_view text) {
  if (file.write(both_clocks(launched_) + " " + printable(text, text.size()))) return true;
  if (!failure_.empty()) return true;
  failure_ = file.path().string() + " cannot be written: " + std::generic_category().message(errno);
  return false;
}

bool MissionLog::add_line(std::string_view process, std::string_view line) {
  return write(file_of(process), line);
}

bool MissionLog::add_event(const ChildEvent& event) {
  return add_event((event.child.empty() ? "mission" : event.child) + ": " + event.text);
}

bool MissionLog::add_event(std::string_view text) { return write(events_, text); }

}  // namespace skein::launch
