#pragma once

#include <atomic>

#include "member.hpp"
#include "mission.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"

namespace reconnaissance {

/// Plans routes. Holds no planner itself: its CSPs plan, and its Head chooses among them and checks
/// what they make.
class Navigator : public recon::INavigator {
 public:
  Navigator(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

  recon::Route plan(const recon::RouteRequest& request) override;

 private:
  skein::Entity& entity_;
  std::atomic<std::uint32_t> routes_{0};
  Member member_;
};

/// The straight legs from point to point, as they are ordered: a CSP of the navigator.
class FixedLegs : public recon::IRoutePlanner {
 public:
  recon::Route plan(const recon::RouteRequest& request) override;
};

}  // namespace reconnaissance
