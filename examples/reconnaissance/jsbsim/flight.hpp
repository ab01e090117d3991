#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "flight/aircraft_type.hpp"
#include "flight/autopilot.hpp"
#include "geodesy/local_frame.hpp"
#include "link.hpp"
#include "process.hpp"

namespace reconnaissance {

/// An aircraft that JSBSim flies: our description of it (tactical_uav.xml), an autopilot that makes
/// surfaces and throttle of a demand, and JSBSim's own equations of motion, engine and wheels, in
/// lock-step. Each tick of 20 ms is two steps of JSBSim: the controls are set before the first one,
/// and the state is read before the second, so that it is 10 ms old. A JSBSim that dies, hangs or
/// talks nonsense is replaced by another one, which goes on from the last state. Not thread-safe.
class JsbsimFlight {
 public:
  struct Options {
    std::string program = "JSBSim";  ///< See find_program().
    Geodetic origin{};               ///< Of the local coordinates.
    /// How long JSBSim may take to start, and for each answer.
    JsbsimLink::Patience patience = std::chrono::seconds(3);
    /// Is told, in a sentence, of a JSBSim that was replaced. May be empty.
    std::function<void(const std::string&)> tell{};
  };

  static constexpr double kTick_s = 0.02;

  explicit JsbsimFlight(Options options);

  /// Where it begins: JSBSim is started there, trimmed as well as the state allows. Throws
  /// JsbsimFailure with the reason why it cannot fly from there.
  void place(const Aircraft& aircraft);

  /// The aircraft 20 ms later, over a plane of that height. Throws JsbsimFailure where several
  /// JSBSims have failed one after the other.
  Aircraft advance(const Demand& demand, const Wind& wind, double ground_m);

  /// Of the JSBSim that flies; -1: none.
  pid_t pid() const noexcept { return process_ ? process_->pid() : -1; }
  /// How often one was replaced.
  int replaced() const noexcept { return replaced_; }

 private:
  void start();
  void stop();
  std::vector<RootFile> files(std::uint16_t port, int key) const;
  std::string initial_conditions() const;
  void read();
  Aircraft tick(const Demand& demand);
  void see(const std::vector<double>& values);

  Options options_;
  LocalFrame frame_;
  const AircraftType& type_;
  Autopilot autopilot_;
  std::optional<Aircraft> aircraft_;
  Motions motions_;
  Wind wind_{};
  double ground_m_ = 0;
  Geodetic began_{};   // where the JSBSim that flies began
  double time_s_ = 0;  // of JSBSim
  int replaced_ = 0;
  std::optional<JsbsimProcess> process_;
  std::optional<JsbsimLink> link_;
};

}  // namespace reconnaissance
