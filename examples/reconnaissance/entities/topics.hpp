#pragma once

namespace reconnaissance {

/// A topic whose samples bear the tick to which they belong, and at every how many ticks there is
/// one.
struct StreamTopic {
  const char* name;
  int period;
};

/// The names of the mission's topics; their types and QoS stand in the IDL.
namespace topic {

inline constexpr StreamTopic kSensors{"flight/sensors", 1};
inline constexpr StreamTopic kFlightCommand{"flight/command", 1};
inline constexpr StreamTopic kFlightState{"flight/state", 5};
inline constexpr StreamTopic kTruth{"simulation/truth", 5};
inline constexpr StreamTopic kMode{"mission/mode", 25};
inline constexpr StreamTopic kIntercepts{"threat/intercepts", 5};
inline constexpr StreamTopic kEmitters{"threat/emitters", 5};
inline constexpr StreamTopic kThreats{"threat/picture", 25};
inline constexpr StreamTopic kLinkReports{"link/reports", 25};
inline constexpr StreamTopic kLinkPicture{"link/picture", 25};
inline constexpr StreamTopic kElements{"target/elements", 50};
inline constexpr StreamTopic kImages{"target/images", 5};
inline constexpr StreamTopic kTracks{"target/tracks", 5};
inline constexpr StreamTopic kObjects{"simulation/objects", 50};
inline constexpr StreamTopic kTraffic{"traffic/others", 5};
inline constexpr StreamTopic kTrafficTruth{"simulation/traffic", 5};
inline constexpr StreamTopic kAdvisory{"traffic/advisory", 50};
inline constexpr StreamTopic kThreatTruth{"simulation/threats", 50};

inline constexpr const char* kHealth = "mission/health";
inline constexpr const char* kStatus = "mission/status";
inline constexpr const char* kDecisions = "skein/decisions";
inline constexpr const char* kRoute = "mission/route";

}  // namespace topic
}  // namespace reconnaissance
