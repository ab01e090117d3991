#include <Eigen/Dense>
#include <functional>
#include <random>

#include "estimates.hpp"
#include "skein/fusion.hpp"

using namespace skein::fusion;

namespace {

constexpr std::size_t kSize = 2;
constexpr std::size_t kRuns = 2000;

/// Two sources of which each adds an error of its own to one that both have, with the covariances
/// of their whole errors.
class Sources {
 public:
  explicit Sources(double shared) : shared_(std::sqrt(shared)), own_(std::sqrt(1 - shared)) {}

  std::vector<Estimate> look() {
    const double common[]{normal_(random_), normal_(random_)};
    std::vector<Estimate> estimates;
    for (const double spread : {1.0, 1.5}) {
      Estimate estimate{{}, {spread * spread, 0, 0, spread * spread}};
      for (std::size_t i = 0; i < kSize; ++i) {
        estimate.mean.push_back(spread * (shared_ * common[i] + own_ * normal_(random_)));
      }
      estimates.push_back(std::move(estimate));
    }
    return estimates;
  }

 private:
  std::mt19937 random_{3};
  std::normal_distribution<double> normal_;
  double shared_;
  double own_;
};

/// The truth is 0.
double mean_nees(Sources sources,
                 const std::function<Estimate(const std::vector<Estimate>&)>& fuse) {
  double sum = 0;
  for (std::size_t run = 0; run < kRuns; ++run) sum += nees(fuse(sources.look()), {0, 0});
  return sum / kRuns;
}

double bound(double probability) { return chi_square_quantile(probability, kRuns * kSize) / kRuns; }

Estimate added(const std::vector<Estimate>& estimates) { return fuse_independent(estimates); }
Estimate intersected(const std::vector<Estimate>& estimates) { return intersect(estimates).fused; }

}  // namespace

TEST_CASE(
    "of independent sources the information filter is consistent: its NEES is within the bounds") {
  const double mean = mean_nees(Sources(0), added);
  CHECK(mean > bound(0.005));
  CHECK(mean < bound(0.995));
}

TEST_CASE(
    "of sources that share errors the information filter is surer than it may be, the intersection "
    "is not") {
  for (const double shared : {0.3, 0.6, 0.95}) {
    CHECK(mean_nees(Sources(shared), added) > bound(0.995));
    CHECK(mean_nees(Sources(shared), intersected) < bound(0.995));
  }
}
