#pragma once

#include "planning/element_policies.hpp"
#include "sensing/collection.hpp"
#include "sensing/tracking/tracker.hpp"
#include "targets.idl.hpp"

namespace reconnaissance {

/// The aircraft's camera and its mount: 4 by 3 degrees.
inline constexpr Camera kCamera{0.0698, 0.0524, 1920, 1440};
inline constexpr CameraMount kCameraMount{};

/// A pattern of collection: a CSP of the EO manager.
class CollectionPattern : public recon::ICollectionPattern {
 public:
  using Plan = decltype(&plan_spot);

  explicit CollectionPattern(Plan plan) : plan_(plan) {}
  recon::CollectionPlan plan(const recon::CollectionTask& task) override;

 private:
  Plan plan_;
};

/// Stays with a target instead of passing it: a CSP of the EO manager, too.
class Watch : public recon::ICollectionPattern {
 public:
  recon::CollectionPlan plan(const recon::CollectionTask& task) override;
};

/// A policy which element is next: a CSP of the EOI manager.
class ElementPolicy : public recon::IElementPolicy {
 public:
  using Choose = decltype(&next_by_priority);

  explicit ElementPolicy(Choose choose) : choose_(choose) {}
  std::int32_t next(const recon::ElementChoice& choice) override;

 private:
  Choose choose_;
};

/// Follows objects by a filter: a CSP of the object tracker. Keeps its tracks from call to call.
template <class Filter>
class TargetTracker : public recon::ITargetTracker {
 public:
  recon::TrackList look(const recon::GroundLook& look) override;

 private:
  Tracker<Filter> tracker_;
};

}  // namespace reconnaissance
