#include "forest.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

namespace skein::entity {
namespace {

constexpr std::size_t kLeastRows = 2;      // of a leaf
constexpr std::size_t kMostRows = 160;     // that a leaf tells of
constexpr std::size_t kTriedFeatures = 3;  // one in so many is tried for a split

/// SplitMix64 (Steele, Lea, Flood 2014): the same numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::size_t below(std::size_t limit) { return static_cast<std::size_t>(next() % limit); }
  /// 0 to 1.
  float share() { return static_cast<float>(next() >> 40) * 0x1p-24f; }

 private:
  std::uint64_t state_;
};

}  // namespace

/// Grows one tree after the other.
class Grower {
 public:
  Grower(const Lessons& lessons, Forest& forest)
      : lessons_(lessons),
        forest_(forest),
        order_(lessons.rows()),
        all_(lessons.outputs),
        left_(lessons.outputs) {}

  void grow(std::size_t tree) {
    random_ = Random(tree);
    std::iota(order_.begin(), order_.end(), 0u);
    forest_.roots_[tree] = forest_.add_leaf();
    grow(forest_.roots_[tree], order_, 0);
  }

 private:
  struct Sum {
    float sum = 0;
    float count = 0;
    float explained() const { return count > 0 ? sum * sum / count : 0; }
  };
  struct Split {
    std::uint32_t column;
    float threshold;
  };
  using Rows = std::span<std::uint32_t>;

  float feature(std::uint32_t row, std::size_t column) const {
    return lessons_.features[row * lessons_.columns + column];
  }

  void grow(std::uint32_t node, Rows rows, std::uint32_t depth) {
    const auto split = best_split(rows);
    if (!split) return fill(node, rows);
    const auto middle = std::stable_partition(rows.begin(), rows.end(), [&](std::uint32_t row) {
      return feature(row, split->column) <= split->threshold;
    });
    const std::uint32_t left = forest_.add_leaf();
    forest_.add_leaf();
    forest_.nodes_[node] = {split->threshold, split->column, left};
    forest_.depth_ = std::max(forest_.depth_, depth + 1);
    const auto count = static_cast<std::size_t>(middle - rows.begin());
    grow(left, rows.first(count), depth + 1);
    grow(left + 1, rows.subspan(count), depth + 1);
  }

  void fill(std::uint32_t node, Rows rows) {
    const std::size_t size = std::min(rows.size(), kMostRows);
    forest_.ranges_[node] = {static_cast<std::uint32_t>(forest_.rows_.size()),
                             static_cast<std::uint32_t>(size)};
    forest_.rows_.insert(forest_.rows_.end(), rows.rbegin(),
                         rows.rbegin() + static_cast<std::ptrdiff_t>(size));
  }

  std::optional<Split> best_split(Rows rows) {
    if (rows.size() < 2 * kLeastRows || lessons_.columns == 0) return std::nullopt;
    sum(rows, all_, [](std::uint32_t) { return true; });
    float base = 0;
    for (const Sum& each : all_) base += each.explained();
    std::optional<Split> best;
    float greatest = base * (1 + 1e-6f) + 1e-6f;
    const std::size_t tries = (lessons_.columns + kTriedFeatures - 1) / kTriedFeatures;
    // A column that is the same for all of these rows is no try.
    for (std::size_t drawn = 0, tried = 0; tried < tries && drawn < 4 * tries + 8; ++drawn) {
      const auto split = draw(rows);
      if (!split) continue;
      ++tried;
      const float explained = explained_by(*split, rows);
      if (explained <= greatest) continue;
      greatest = explained;
      best = split;
    }
    return best;
  }

  // Between two random rows, so that the features' scale does not matter.
  std::optional<Split> draw(Rows rows) {
    const auto column = static_cast<std::uint32_t>(random_.below(lessons_.columns));
    const float one = feature(rows[random_.below(rows.size())], column);
    const float other = feature(rows[random_.below(rows.size())], column);
    if (one == other) return std::nullopt;
    const float low = std::min(one, other);
    const float share = random_.share();
    if (low == Lessons::kMissing) return Split{column, low};
    return Split{column, low + share * (std::max(one, other) - low) * 0.999f};
  }

  float explained_by(const Split& split, Rows rows) {
    const std::size_t count = sum(rows, left_, [&](std::uint32_t row) {
      return feature(row, split.column) <= split.threshold;
    });
    if (count < kLeastRows || rows.size() - count < kLeastRows) return 0;
    float explained = 0;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const Sum right{all_[i].sum - left_[i].sum, all_[i].count - left_[i].count};
      explained += left_[i].explained() + right.explained();
    }
    return explained;
  }

  template <class Chosen>
  std::size_t sum(Rows rows, std::vector<Sum>& sums, Chosen chosen) {
    std::fill(sums.begin(), sums.end(), Sum());
    std::size_t count = 0;
    for (const std::uint32_t row : rows) {
      if (!chosen(row)) continue;
      ++count;
      for (std::uint32_t i = lessons_.first[row]; i < lessons_.first[row + 1]; ++i) {
        Sum& sum = sums[lessons_.targets[i].output];
        sum.sum += lessons_.targets[i].value;
        sum.count += 1;
      }
    }
    return count;
  }

  const Lessons& lessons_;
  Forest& forest_;
  Random random_{0};
  std::vector<std::uint32_t> order_;
  std::vector<Sum> all_, left_;
};

Forest::Forest() {
  for (std::uint32_t& root : roots_) root = add_leaf();
}

Forest::Forest(const Lessons& lessons) {
  Grower grower(lessons, *this);
  for (std::size_t tree = 0; tree < kTrees; ++tree) grower.grow(tree);
}

std::uint32_t Forest::add_leaf() {
  const auto node = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({std::numeric_limits<float>::infinity(), 0, node});
  ranges_.emplace_back();
  return node;
}

void Forest::prefetch(const Leaves& leaves) const {
  for (const std::uint32_t leaf : leaves) __builtin_prefetch(&ranges_[leaf]);
  for (const std::uint32_t leaf : leaves) __builtin_prefetch(rows_.data() + ranges_[leaf].begin);
}

Forest::Leaves Forest::leaves(std::span<const float> features) const {
  Leaves at = roots_;
  // All trees a step at a time: their loads do not wait for each other.
  for (std::uint32_t step = 0; step < depth_; ++step) {
    for (std::uint32_t& node : at) {
      const Node& here = nodes_[node];
      node = here.left + (features[here.column] > here.threshold ? 1 : 0);
    }
  }
  return at;
}

}  // namespace skein::entity
