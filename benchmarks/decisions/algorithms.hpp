#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "navigation/terrain/terrain_provider.hpp"
#include "navigator.idl.hpp"
#include "skein/entity.hpp"

namespace skein::benchmarks {

/// What happens to the algorithms while one request is answered, and how many are at work. All
/// contestants share the algorithms, so that nobody begins before the last one has left.
class Stage {
 public:
  /// `factors` and `hangs` as in Request.
  void set(std::map<std::string, double> factors, std::string hangs);
  /// Ends all hanging and waits until nobody is at work.
  void clear();

  double factor(const std::string& algorithm) const;
  /// Waits for clear() where that algorithm is to hang; whether it was.
  bool hang(const std::string& algorithm);
  void enter();
  void leave();

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, double> factors_;
  std::string hangs_;
  int at_work_ = 0;
};

struct Algorithm {
  std::string name;
  std::vector<ServiceAttribute> declared;
  std::shared_ptr<AE_navigator::IPlanner> planner;
};

/// Planners of src/navigation, in the order of their names:
/// - Boaster: as Weighted; it declares to be the quickest and the best, and claims no exposure;
/// - Capped, CappedCoarse: exposure-constrained A* on points 100 m and 300 m apart; the latter
///   misses narrow doors;
/// - Direct: the straight way, whatever stands on it; of few requests the best;
/// - Jumper, LazyTheta: jump point search and Lazy Theta* on the cells; know nothing of radars;
/// - Sampler: RRTConnect; knows nothing of radars, and seldom finds through a maze;
/// - Weighted: A* that pays for exposure, and knows nothing of caps.
/// Each takes the time that the stage's factor says: what its planner does not need it spins.
std::vector<Algorithm> make_algorithms(const std::shared_ptr<navigation::TerrainProvider>& terrains,
                                       Stage& stage);

/// Their names.
const std::vector<std::string>& algorithm_names();

}  // namespace skein::benchmarks
