#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mission/verdict.hpp"

// What beside the flight itself is judged where a mission is to follow a target, or to place
// emitters: by where they truly are.
namespace reconnaissance {

struct PursuitConditions {
  double ordered_s = 300;
  double least_in_view = 0.9;    ///< Share of the ordered time.
  double greatest_error_m = 25;  ///< Root mean square.
};

/// How well a target was followed. Truth and reports may come in any order; those of the same
/// time, one for each second, belong together.
class PursuitScore {
 public:
  explicit PursuitScore(const PursuitConditions& conditions) : conditions_(conditions) {}

  void truth(std::int64_t second, const Local& target, bool in_view);
  /// Where the target is said to be; nullopt: it is not known at present.
  void report(std::int64_t second, const std::optional<Local>& target);

  std::vector<Check> checks() const;

 private:
  struct Moment {
    std::optional<Local> truth;
    bool in_view = false;
    std::optional<Local> reported;
  };

  PursuitConditions conditions_;
  std::map<std::int64_t, Moment> moments_;
};

/// A site, as it truly is or as it was reported.
struct Site {
  std::string kind;
  Local place{};
};

/// Whether all sites were found and no others, taken for what they are, and placed within a
/// distance of where they are. What is reported belongs to the nearest site.
std::vector<Check> site_checks(const std::vector<Site>& truth, const std::vector<Site>& reported,
                               double within_m);

}  // namespace reconnaissance
