#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "threats/emitter_classification.hpp"
#include "threats/emitter_location.hpp"

namespace reconnaissance {

/// A site that somebody else reports over the data link. How far its errors are those of our own
/// reports is unknown.
struct LinkTrack {
  std::uint32_t id;  ///< Of the sender; the same for each report of a site.
  std::string emitter;
  skein::fusion::Estimate position;  ///< North and east.
};

/// A site of which the place is known.
struct Threat {
  std::uint32_t id;
  std::string emitter;
  RadarMode mode;
  double confidence;  ///< That type and mode are right, as last heard; 1 if only the link has it.
  skein::fusion::Estimate position;  ///< North and east.
  bool heard;                        ///< By our own warner,
  bool linked;                       ///< over the link.
  /// As our own warner alone has it, which is what others may be told; none if only linked.
  std::optional<skein::fusion::Estimate> own = std::nullopt;
};

/// Places an emitter by the bearings of its track, of which the first had it within the distances;
/// nullopt: not yet. How is a choice, for example of a Head.
using Locate = std::function<std::optional<skein::fusion::Estimate>(std::span<const Bearing>,
                                                                    const Interval& distances_m)>;
std::optional<skein::fusion::Estimate> by_filter(std::span<const Bearing> bearings,
                                                 const Interval& distances_m);
std::optional<skein::fusion::Estimate> by_triangulation(std::span<const Bearing> bearings,
                                                        const Interval& distances_m);

/// So many bearings a track has at most. When there are more, neighbours from near places become
/// one, of the mean of both and the error of a mean.
inline constexpr std::size_t kGreatestBearings = 1000;

/// Which sites are where: from bearings of our own warner and tracks of the data link.
///
/// A bearing belongs to the track of the same type of which it is most probable, if within a gate
/// of 99.99 %, to a confirmed one before others; if there is none, it begins a track. A track is
/// confirmed when six of the last ten intercepts that fit its bearing were of its type, and
/// forgotten before that after 10 s without one: so wrong identifications make no threat. A link's
/// track of the same type that agrees with ours (gate of 99 %) is fused with it by covariance
/// intersection, since it may contain what we have sent. Ours are never changed by the link, so
/// that no report counts twice.
///
/// One thread at a time may use it.
class AirDefencePicture {
 public:
  explicit AirDefencePicture(const WarnerReceiver& receiver) : receiver_(receiver) {}

  /// A bearing, with what the warner takes it for. Unknown emitters are ignored. Times do not
  /// decrease.
  void hear(const Intercept& intercept, const Identification& identification,
            const Local& aircraft);

  /// Takes the place of an earlier report with the same id.
  void report(const LinkTrack& track) { links_.insert_or_assign(track.id, track); }

  /// Takes the place of all earlier reports: a site that is not among them is no longer reported.
  void report_all(const std::vector<LinkTrack>& tracks) {
    links_.clear();
    for (const LinkTrack& each : tracks) report(each);
  }

  /// All of which the place is known: ours that `locate` places, which is called for each confirmed
  /// track in order of its number. Ours first; those of the link that none of ours is, with numbers
  /// from kFirstLinkNumber.
  std::vector<Threat> threats(const Locate& locate = by_filter) const;

  static constexpr std::uint32_t kFirstLinkNumber = 1000000;

 private:
  struct Track {
    std::uint32_t id;
    Identification identification;
    Interval distances_m;
    BearingFilter filter;
    std::vector<Bearing> bearings;
    double last_heard_s;
    int powers;  // of which `distances_m` is the mean
    TrackConfirmation confirmation{6, 10};
    bool confirmed = false;
  };

  /// The track's distances by one power more, if from nearly the same place.
  void measure(Track& track, const Intercept& intercept, const Local& aircraft);

  WarnerReceiver receiver_;
  std::uint32_t next_id_ = 1;
  std::vector<Track> tracks_;
  std::map<std::uint32_t, LinkTrack> links_;
};

/// Whether two pictures differ in what matters to others: in a threat or its type, or by more than
/// its own standard deviation, 100 m at least, in a threat's place.
bool differ(const std::vector<Threat>& one, const std::vector<Threat>& other);

/// The standard deviation of a place's error in the direction in which it is greatest.
double greatest_deviation_m(const skein::fusion::Estimate& place);

}  // namespace reconnaissance
