#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "decisions/algorithms.hpp"
#include "decisions/requests.hpp"
#include "skein/head.hpp"

namespace skein::benchmarks {

/// What a contestant made of one request.
struct Answer {
  double time_ms = 0;  ///< From the request to the answer or the refusal.
  std::optional<AE_navigator::Route> route;
  std::string chosen;  ///< Whose route it is; without one the last that was tried.
  std::size_t attempts = 0;
  std::string outcome;  ///< `answered`, or why not.
};

/// An autonomous entity on a network within the process, whose Head chooses among algorithms.
class Contestant {
 public:
  /// With all the algorithms, and the Head's strategy.
  Contestant(const std::string& strategy, const std::vector<Algorithm>& algorithms,
             std::shared_ptr<navigation::TerrainProvider> terrains);
  /// With one algorithm, that is always chosen; the same Head and checks around it.
  Contestant(const Algorithm& algorithm, std::shared_ptr<navigation::TerrainProvider> terrains);

  const std::string& name() const { return name_; }

  Answer answer(const Request& request);
  /// Waits until none of its algorithms is at work.
  void settle() const;

 private:
  Contestant(std::string name, HeadOptions head, const std::vector<Algorithm>& algorithms,
             std::shared_ptr<navigation::TerrainProvider> terrains);

  const std::string name_;
  const std::shared_ptr<navigation::TerrainProvider> terrains_;
  std::unique_ptr<Entity> entity_;
};

/// What the Body tells the Head of a problem, and finds out within microseconds.
Features features_of(const AE_navigator::Problem& problem, const navigation::Terrain& terrain);

}  // namespace skein::benchmarks
