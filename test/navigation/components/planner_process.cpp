// A planner of the navigator in a process of its own, to be struck:
// planner_process VENDOR NAME OWNER KIND LATENCY_MS QUALITY SEED. KIND is a planner of
// make_planner(), or one that misbehaves: `short_cut` flies straight through everything,
// `not_a_number` has a waypoint nowhere, `slow` takes three times as long as it declares, `aborts`
// ends its process. It says `ready`, and never ends by itself otherwise.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <thread>

#include "mission/process/ready.hpp"
#include "navigation/planners/planners.hpp"
#include "skein/entity.hpp"

using namespace skein;
using namespace skein::navigation;
using AE_navigator::IPlanner;
using AE_navigator::Problem;
using AE_navigator::Route;

namespace {

/// Does something to the routes of a good planner.
class Misbehaving : public IPlanner {
 public:
  explicit Misbehaving(std::shared_ptr<IPlanner> planner) : planner_(std::move(planner)) {}
  Route plan(const Problem& task) override { return spoil(task, planner_->plan(task)); }

 private:
  virtual Route spoil(const Problem& task, Route route) = 0;
  std::shared_ptr<IPlanner> planner_;
};

struct ShortCut final : Misbehaving {
  using Misbehaving::Misbehaving;
  Route spoil(const Problem& task, Route route) override {
    route.waypoints = {task.start, task.goal};
    return route;
  }
};

struct NotANumber final : Misbehaving {
  using Misbehaving::Misbehaving;
  Route spoil(const Problem&, Route route) override {
    route.waypoints[route.waypoints.size() / 2].altitude_m =
        std::numeric_limits<double>::quiet_NaN();
    return route;
  }
};

class Slow final : public Misbehaving {
 public:
  Slow(std::shared_ptr<IPlanner> planner, std::chrono::milliseconds declared)
      : Misbehaving(std::move(planner)), declared_(declared) {}

 private:
  Route spoil(const Problem&, Route route) override {
    std::this_thread::sleep_for(3 * declared_);  // Its fault, not a wait.
    return route;
  }
  std::chrono::milliseconds declared_;
};

struct Aborting final : IPlanner {
  Route plan(const Problem&) override { std::abort(); }
};

std::shared_ptr<IPlanner> make(const std::string& kind, std::uint32_t seed, int latency_ms) {
  const auto terrains = std::make_shared<TerrainProvider>();
  PlannerOptions options;
  options.seed = seed;
  const auto planner = [&](const std::string& name) -> std::shared_ptr<IPlanner> {
    return make_planner(name, terrains, options);
  };
  if (kind == "short_cut") return std::make_shared<ShortCut>(planner("RRTConnect"));
  if (kind == "not_a_number") return std::make_shared<NotANumber>(planner("RRTConnect"));
  if (kind == "slow")
    return std::make_shared<Slow>(planner("RRTConnect"), std::chrono::milliseconds(latency_ms));
  if (kind == "aborts") return std::make_shared<Aborting>();
  return planner(kind);
}

}  // namespace

int main(int, char** argv) {
  EntityOptions options;
  options.name = std::string(argv[2]) + "-host";
  options.system = "uav-1";
  options.vendor = dds::load_vendor(argv[1]);
  options.domain = 17;
  options.lease = std::chrono::seconds(60);
  Entity entity(std::move(options));
  ServiceOptions declared;
  declared.attributes = {{"latency", argv[5]}, {"quality", argv[6]}};
  entity.provide_csp<IPlanner>(
      argv[2], argv[3],
      make(argv[4], static_cast<std::uint32_t>(std::stoul(argv[7])), std::stoi(argv[5])), declared);
  std::puts("ready");
  std::fflush(stdout);
  launch::report_ready();
  for (;;) pause();
}
