#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace skein::entity {

/// What requests were like, a row each, and what CSPs made of them.
struct Lessons {
  struct Target {
    std::uint32_t output;  ///< Which figure of which CSP.
    float value;
  };
  std::size_t columns = 0;
  std::size_t outputs = 0;
  std::vector<float> features;          ///< Row by row; kMissing where a request has none.
  std::vector<std::uint32_t> first{0};  ///< Where a row's targets begin; one more at the end.
  std::vector<Target> targets;

  static constexpr float kMissing = -3e38f;

  std::size_t rows() const { return first.size() - 1; }
};

/// Which requests are alike for what CSPs make of them: those that fall into the same leaves of
/// extremely randomized trees (Geurts, Ernst, Wehenkel 2006). A tree is grown for all outputs at
/// once: a split is the one of some random ones that explains most of the targets' variance.
/// Features that tell nothing are thereby seldom asked. The same lessons make the same forest.
/// Immutable after construction.
class Forest {
 public:
  static constexpr std::size_t kTrees = 48;
  /// The leaf of each tree.
  using Leaves = std::array<std::uint32_t, kTrees>;

  /// Of trees with a single leaf, which holds no row.
  Forest();
  explicit Forest(const Lessons& lessons);

  /// `features` has the lessons' columns.
  Leaves leaves(std::span<const float> features) const;

  /// Asks the memory for what rows() will give of these leaves.
  void prefetch(const Leaves& leaves) const;

  /// The rows in a leaf, the latest first; all if they are few, otherwise the latest.
  std::span<const std::uint32_t> rows(std::uint32_t leaf) const {
    const Range& range = ranges_[leaf];
    return {rows_.data() + range.begin, range.size};
  }

 private:
  friend class Grower;
  // A leaf leads to itself.
  struct Node {
    float threshold;
    std::uint32_t column;
    std::uint32_t left;  // and left + 1 for features above the threshold
  };
  struct Range {
    std::uint32_t begin = 0;
    std::uint32_t size = 0;
  };

  std::uint32_t add_leaf();

  std::vector<Node> nodes_;    // of all trees
  std::vector<Range> ranges_;  // a node each; empty unless it is a leaf
  std::vector<std::uint32_t> rows_;
  Leaves roots_{};
  std::uint32_t depth_ = 0;  // of the deepest tree
};

}  // namespace skein::entity
