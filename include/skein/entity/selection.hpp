#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/core/clock.hpp"
#include "skein/core/guid.hpp"

namespace skein {

/// A CSP that could run the task, with what its description promises.
struct Candidate {
  std::string name;  ///< The CSP's, `AStar`.
  Guid provider;
  bool in_process = false;
  std::uint32_t pid = 0;
  /// Attribute `latency`: the time that an answer is declared to take. Nothing: not declared.
  std::optional<Duration> latency;
  /// Attribute `quality`: greater is better. Not declared counts as 0.
  double quality = 0;
};

/// What a strategy decided: which candidate runs next, for how long at most, and why, in words.
struct Selection {
  std::size_t candidate = 0;  ///< Index into the candidates.
  Duration slice{};
  std::string reason;
};

/// Decides which CSP runs next. Asked again after each failure, with those that are left and the time
/// that is left. Pure: equal arguments give equal selections. Thread-safe.
class SelectionStrategy {
 public:
  virtual ~SelectionStrategy() = default;
  virtual std::string name() const = 0;
  /// `candidates` is not empty.
  virtual Selection select(const std::vector<Candidate>& candidates, Duration remaining) const = 0;
};

/// The best declared quality whose declared latency fits into the time left, with the fastest other
/// candidate's latency kept in reserve where that still leaves enough; the fastest where none fits.
/// Name: `declared`.
std::shared_ptr<const SelectionStrategy> make_declared_selection();

/// In the Broker's order, whatever is declared; the time left is shared evenly. Name: `fixed_order`.
std::shared_ptr<const SelectionStrategy> make_fixed_order_selection();

}  // namespace skein
