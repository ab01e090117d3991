#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/introspection.idl.hpp"

namespace skein::command {

/// Finds the features of tasks from which a Head learns nothing, as a log of decisions shows them.
class FeatureFindings {
 public:
  /// So many of the latest decisions of an entity on a service are looked at.
  static constexpr std::size_t kMostDecisions = 10'000;

  /// What a CSP made of a request.
  struct Run {
    std::string csp;
    std::optional<double> cost;
    std::optional<double> quality;
  };
  struct Request {
    std::map<std::string, double> features;
    std::string chosen;  ///< The first; empty where there was none.
    std::vector<Run> runs;
  };
  using Requests = std::deque<Request>;

  void add(const introspection::Decision& decision);

  /// A sentence with the remedy for each feature that is the same for all requests, and for each
  /// that varies while no CSP's choice, time, success or quality goes with it. None of what too few
  /// decisions say.
  std::vector<std::string> sentences() const;

 private:
  std::map<std::pair<std::string, std::string>, Requests> requests_;  // by entity and service
};

}  // namespace skein::command
