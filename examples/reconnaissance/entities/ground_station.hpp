#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "../geodesy/local_frame.hpp"
#include "../mission/verdict.hpp"
#include "member.hpp"
#include "mission.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"

namespace reconnaissance {

/// Begins the mission, watches it, and judges it by where the aircraft truly was.
class GroundStation {
 public:
  /// The exit codes of a mission whose flight began to be watched.
  static constexpr int kPassed = 0;
  static constexpr int kFailed = 10;    ///< Flown to its end, and not all conditions are kept.
  static constexpr int kNotFlown = 11;  ///< Not flown to its end.

  GroundStation(skein::Entity& entity, const skein::ParameterValues& values);

  /// Returns at the mission's end, with its exit code.
  int run(const std::stop_token& told_to_end);

 private:
  void see(const recon::Truth& truth);
  void show(const recon::MissionStatus& status);
  void show(const recon::MissionMode& mode);
  /// Waits for the end; why it is not the end of the flight, or an empty text.
  std::string await_end(const std::stop_token& told_to_end);
  void write(const Verdict& verdict) const;

  skein::Entity& entity_;
  recon::MissionOrder order_;
  LocalFrame frame_;
  std::filesystem::path results_;
  skein::Duration patience_;
  bool landed_ = false;

  std::mutex mutex_;
  std::condition_variable_any changed_;
  Judge judge_;
  std::optional<recon::Phase> phase_;
  recon::Mode mode_ = recon::Mode::Starting;
  Tick last_tick_ = -1;

  skein::Subscription<recon::Truth> truths_;
  skein::Subscription<recon::MissionStatus> statuses_;
  skein::Subscription<recon::MissionMode> modes_;
  Member member_;
};

}  // namespace reconnaissance
