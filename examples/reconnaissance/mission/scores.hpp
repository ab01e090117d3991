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
/// distance of where they are. What is reported belongs to the nearest site; a second report of the
/// same one is one where there is none.
std::vector<Check> site_checks(const std::vector<Site>& truth, const std::vector<Site>& reported,
                               double within_m);

/// How long after what each site transmits had first reached the aircraft it was first reported,
/// wherever that was in the picture: nearer to it than to any other, and not far off.
class ReportDelays {
 public:
  /// All sites as they are at a time, always in the same order. A report counts from the first of
  /// these on.
  struct Heard {
    Site site;
    bool heard = false;
  };
  void truth(double now_s, const std::vector<Heard>& sites);
  void report(double now_s, const std::vector<Site>& reported);

  Check check(double within_s) const;

 private:
  struct Times {
    Site site;
    std::optional<double> heard_s, reported_s;
  };
  std::vector<Times> sites_;
};

}  // namespace reconnaissance
