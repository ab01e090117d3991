#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "decisions/worlds.hpp"
#include "navigation/terrain/terrain_provider.hpp"
#include "navigator.idl.hpp"
#include "skein/clock.hpp"

namespace skein::benchmarks {

/// Stands for all algorithms in Request::hangs.
inline constexpr const char* kAllHang = "all";

struct Request {
  std::string part;  ///< `training` or `held_out`.
  std::size_t number = 0;
  std::shared_ptr<const World> world;
  AE_navigator::Problem problem;
  Duration limit{};
  /// The algorithm that never answers it; kAllHang; or empty.
  std::string hangs;
  /// How many times its own time an algorithm takes now; 1 where it is not named.
  std::map<std::string, double> factors;
};

struct Requests {
  std::shared_ptr<navigation::TerrainProvider> terrains;
  std::vector<Request> all;      ///< The training part first, in the order in which they come.
  std::size_t without_data = 0;  ///< Left out, as the maps of movingai.com are not here.
};

/// All instances of the file, or each `every`-th. A request is drawn from its world's seed: start
/// and goal at least a third of a side apart and connected, radar sites beside the way for six of
/// ten, for two thirds of these a cap on exposure, a share of what the way past them all has; the
/// limit between 1 ms and 2 s, each order of magnitude alike. In one of twelve an algorithm hangs
/// or all do, and limits are at most 30 ms. What the file says of its part comes on top: drift,
/// heavy tails, and hangs of requests with many radar sites. `algorithms` are their names. Throws
/// InvalidArgument with file and line.
Requests read_requests(const std::filesystem::path& instances,
                       const std::vector<std::string>& algorithms, std::size_t every);

}  // namespace skein::benchmarks
