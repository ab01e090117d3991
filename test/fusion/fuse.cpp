#include <Eigen/Dense>
#include <random>

#include "estimates.hpp"
#include "skein/fusion.hpp"

using namespace skein::fusion;

namespace {

Eigen::MatrixXd matrix_of(const Estimate& estimate) {
  const auto size = static_cast<Eigen::Index>(estimate.size());
  return Eigen::Map<const Eigen::MatrixXd>(estimate.covariance.data(), size, size);
}

Estimate random_estimate(std::mt19937& random, Eigen::Index size) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
  const Eigen::MatrixXd covariance =
      root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(size, size);
  Estimate estimate;
  for (Eigen::Index i = 0; i < size; ++i) estimate.mean.push_back(3 * normal(random));
  estimate.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  return estimate;
}

double least_eigenvalue(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff();
}

}  // namespace

TEST_CASE("covariance intersection of the published example has its published result") {
  const Estimate both[]{kRising, kFalling};
  for (const Measure measure : {Measure::Determinant, Measure::Trace}) {
    const Intersection intersection = intersect(both, measure);
    check_near(intersection.weights, {0.5, 0.5});
    check_near(intersection.fused.mean, {1.5, 2.25, 0});
    check_near(intersection.fused.covariance, {7.5, 0, 0, 0, 7.5, 0, 0, 0, 1});
  }
}

TEST_CASE("independent estimates add their information") {
  const Estimate both[]{{{0}, {4}}, {{10}, {1}}};
  const Estimate fused = fuse_independent(both);
  check_near(fused.mean, {8});
  check_near(fused.covariance, {0.8});
}

TEST_CASE("of an estimate that is worse in every direction, the intersection takes nothing") {
  const Estimate both[]{{{0, 0}, {1, 0, 0, 1}}, {{5, 5}, {9, 0, 0, 4}}};
  const Intersection intersection = intersect(both);
  check_near(intersection.weights, {1, 0});
  check_near(intersection.fused.covariance, {1, 0, 0, 1});
}

TEST_CASE("no other weights make a smaller intersection") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (int round = 0; round < 20; ++round) {
    const Estimate three[]{random_estimate(random, 3), random_estimate(random, 3),
                           random_estimate(random, 3)};
    for (const Measure measure : {Measure::Determinant, Measure::Trace}) {
      const Eigen::MatrixXd best = matrix_of(intersect(three, measure).fused);
      for (int other = 0; other < 200; ++other) {
        double weights[]{share(random), share(random), share(random)};
        const double sum = weights[0] + weights[1] + weights[2];
        Eigen::MatrixXd information = Eigen::MatrixXd::Zero(3, 3);
        for (int i = 0; i < 3; ++i) information += weights[i] / sum * matrix_of(three[i]).inverse();
        const Eigen::MatrixXd covariance = information.inverse();
        if (measure == Measure::Determinant) {
          CHECK(best.determinant() <= covariance.determinant() * (1 + 1e-8));
        } else {
          CHECK(best.trace() <= covariance.trace() * (1 + 1e-8));
        }
      }
    }
  }
}

TEST_CASE("a union covers each of its estimates, wherever its mean is") {
  std::mt19937 random(11);
  for (int round = 0; round < 50; ++round) {
    const Estimate three[]{random_estimate(random, 4), random_estimate(random, 4),
                           random_estimate(random, 4)};
    const Estimate united = unite(three);
    for (const Estimate& each : three) {
      Eigen::VectorXd away(4);
      for (int i = 0; i < 4; ++i) away[i] = united.mean[i] - each.mean[i];
      CHECK(least_eigenvalue(matrix_of(united) - matrix_of(each) - away * away.transpose()) >
            -1e-6);
    }
  }
}

TEST_CASE(
    "the union of equal estimates is what they are; of two that differ, it lies between them") {
  const Estimate same[]{kRising, kRising};
  check_near(unite(same).covariance, kRising.covariance);
  const Estimate apart[]{{{0}, {1}}, {{10}, {1}}};
  const Estimate united = unite(apart);
  check_near(united.mean, {5}, 1e-4);
  check_near(united.covariance, {26}, 1e-2);
}

TEST_CASE("estimates that agree are intersected, and one that does not makes a union") {
  const Estimate agreeing[]{{{0}, {1}}, {{0.5}, {1}}};
  CHECK(fuse_cautiously(agreeing) == intersect(agreeing).fused);
  const Estimate differing[]{{{0}, {1}}, {{0.5}, {1}}, {{10}, {1}}};
  CHECK(fuse_cautiously(differing) == unite(differing));
}
