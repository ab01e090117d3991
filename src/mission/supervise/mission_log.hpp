#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "mission/process/rotating_file.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/supervise/supervisor.hpp"

namespace skein::launch {

/// Where the logs of a mission are kept if nobody says otherwise:
/// `$XDG_STATE_HOME/skein/MISSION-DOMAIN`, by default under `~/.local/state`; characters that do
/// not belong into a file's name become `_`. Empty where neither variable is set.
std::filesystem::path log_folder(const profile::MissionProfile& mission);

/// The logs of one launcher: `mission.log` with what happened, `processes/NAME.log` with what each
/// process wrote (PEER.CSP.log for a CSP). Each line begins with both clocks: the wall's (UTC, ISO
/// 8601) and the seconds since the launch, which no change of the wall's disturbs. The files
/// rotate: see RotatingFile.
class MissionLog {
 public:
  /// Makes the folder. Throws Unavailable, with its name and the reason, where that fails.
  MissionLog(const std::filesystem::path& folder, const RotatingFile::Limits& limits);

  // These return false if the line could not be written for the first time: later ones are tried,
  // but what is to be said about it was said.
  bool add_line(std::string_view process, std::string_view line);
  bool add_event(const ChildEvent& event);
  bool add_event(std::string_view text);

  /// `FILE cannot be written: REASON`, of the first line that was not; empty before.
  const std::string& failure() const noexcept { return failure_; }

  const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  RotatingFile& file_of(std::string_view process);
  bool write(RotatingFile& file, std::string_view text);

  const std::filesystem::path folder_;
  const RotatingFile::Limits limits_;
  const Time launched_ = std::chrono::steady_clock::now();
  RotatingFile events_;
  std::map<std::string, RotatingFile, std::less<>> files_;
  std::string failure_;
};

}  // namespace skein::launch
