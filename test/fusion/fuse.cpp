#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
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

double log_determinant(const Eigen::MatrixXd& matrix) {
  return 2 * matrix.llt().matrixLLT().diagonal().array().log().sum();
}

std::vector<Estimate> random_estimates(std::mt19937& random, int count, Eigen::Index size) {
  std::vector<Estimate> estimates;
  for (int i = 0; i < count; ++i) estimates.push_back(random_estimate(random, size));
  return estimates;
}

/// (covariance + error errorᵀ) is within the other, in units of the other.
bool covers(const Estimate& cover, const Estimate& each) {
  const auto size = static_cast<Eigen::Index>(each.size());
  Eigen::VectorXd away(size);
  for (Eigen::Index i = 0; i < size; ++i) away[i] = cover.mean[i] - each.mean[i];
  const Eigen::MatrixXd inner = matrix_of(each) + away * away.transpose();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> relative(inner, matrix_of(cover));
  return relative.eigenvalues().maxCoeff() < 1 + 1e-9;
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

TEST_CASE("the weights of an intersection of two are those of a search along a line") {
  std::mt19937 random(13);
  for (int round = 0; round < 30; ++round) {
    const auto both = random_estimates(random, 2, 3);
    const Eigen::MatrixXd first = matrix_of(both[0]).inverse();
    const Eigen::MatrixXd second = matrix_of(both[1]).inverse();
    const auto cost = [&](double share) {
      return -log_determinant(share * first + (1 - share) * second);
    };
    const auto [share, least] = boost::math::tools::brent_find_minima(cost, 0.0, 1.0, 26);
    check_near(intersect(both).weights, {share, 1 - share}, 1e-5);
    CHECK(log_determinant(matrix_of(intersect(both).fused)) == Approx(least).margin(1e-7));
  }
}

TEST_CASE("of an intersection of many, none would improve it with more weight") {
  std::mt19937 random(17);
  for (int round = 0; round < 30; ++round) {
    const auto many = random_estimates(random, 8, 4);
    const Eigen::MatrixXd fused = matrix_of(intersect(many).fused);
    for (const Estimate& each : many) {
      CHECK((fused * matrix_of(each).inverse()).trace() < 4 * (1 + 1e-6));
    }
  }
}

TEST_CASE("an intersection is consistent for every correlation of the errors") {
  std::mt19937 random(19);
  for (int round = 0; round < 100; ++round) {
    const auto both = random_estimates(random, 2, 3);
    const Eigen::MatrixXd a = matrix_of(both[0]), b = matrix_of(both[1]);
    const Eigen::MatrixXd turn =
        Eigen::HouseholderQR<Eigen::MatrixXd>(matrix_of(random_estimate(random, 3))).householderQ();
    const double strength = std::uniform_real_distribution<double>(-1, 1)(random);
    const Eigen::MatrixXd cross = strength * Eigen::MatrixXd(a.llt().matrixL()) * turn *
                                  Eigen::MatrixXd(b.llt().matrixL()).transpose();
    const Intersection intersection = intersect(both);
    const Eigen::MatrixXd fused = matrix_of(intersection.fused);
    const Eigen::MatrixXd gain_a = intersection.weights[0] * fused * a.inverse();
    const Eigen::MatrixXd gain_b = intersection.weights[1] * fused * b.inverse();
    const Eigen::MatrixXd mixed = gain_a * cross * gain_b.transpose();
    const Eigen::MatrixXd error = gain_a * a * gain_a.transpose() +
                                  gain_b * b * gain_b.transpose() + mixed + mixed.transpose();
    CHECK(least_eigenvalue(fused - error) > -1e-9);
  }
}

TEST_CASE("no result depends on the order of the estimates") {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> nearness(0, 1);
  for (int round = 0; round < 100; ++round) {
    auto estimates = random_estimates(random, 4, 3);
    const double near = nearness(random);
    for (Estimate& each : estimates) {
      for (double& value : each.mean) value *= near;
    }
    const auto given = estimates;
    const Intersection intersection = intersect(given);
    for (int order = 0; order < 5; ++order) {
      std::shuffle(estimates.begin(), estimates.end(), random);
      CHECK(fuse_cautiously(estimates) == fuse_cautiously(given));
      CHECK(unite(estimates) == unite(given));
      CHECK(fuse_independent(estimates) == fuse_independent(given));
      const Intersection other = intersect(estimates);
      CHECK(other.fused == intersection.fused);
      for (std::size_t i = 0; i < given.size(); ++i) {
        const auto place = std::find(estimates.begin(), estimates.end(), given[i]);
        CHECK(other.weights[place - estimates.begin()] == intersection.weights[i]);
      }
    }
  }
}

TEST_CASE("a union covers each of its estimates") {
  std::mt19937 random(11);
  for (int round = 0; round < 50; ++round) {
    const auto three = random_estimates(random, 3, 4);
    const Estimate united = unite(three);
    for (const Estimate& each : three) CHECK(covers(united, each));
  }
}

TEST_CASE("the union of points on the corners of a square is the circle through them") {
  std::vector<Estimate> corners;
  for (const double x : {-1, 1}) {
    for (const double y : {-1, 1}) corners.push_back({{7 + x, y}, {1e-8, 0, 0, 1e-8}});
  }
  check_near(unite(corners).mean, {7, 0});
  check_near(unite(corners).covariance, {2, 0, 0, 2}, 1e-5);
}

TEST_CASE("no other mean and shape make a smaller union") {
  std::mt19937 random(29);
  std::normal_distribution<double> normal;
  const auto noise = [&] { return normal(random); };
  for (int round = 0; round < 20; ++round) {
    const auto three = random_estimates(random, 3, 3);
    const Estimate best = unite(three);
    for (int other = 0; other < 200; ++other) {
      const double step = std::pow(10.0, -other % 5);
      Eigen::VectorXd mean = Eigen::Map<const Eigen::VectorXd>(best.mean.data(), 3);
      mean += step * Eigen::VectorXd::NullaryExpr(3, noise);
      Eigen::MatrixXd root = matrix_of(best).llt().matrixL();
      root += step * root * Eigen::MatrixXd::NullaryExpr(3, 3, noise);
      const Eigen::MatrixXd shape = root * root.transpose();
      double greatest = 0;
      for (const Estimate& each : three) {
        const Eigen::VectorXd away = mean - Eigen::Map<const Eigen::VectorXd>(each.mean.data(), 3);
        greatest = std::max(greatest, Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
                                          matrix_of(each) + away * away.transpose(), shape)
                                          .eigenvalues()
                                          .maxCoeff());
      }
      CHECK(log_determinant(matrix_of(best)) <= log_determinant(greatest * shape) + 2e-6);
    }
  }
}

TEST_CASE("a union of estimates that are far too far apart still covers them") {
  const Estimate apart[]{{{0, 0}, {1e-4, 0, 0, 1e-4}}, {{1e45, 1e45}, {1e-4, 0, 0, 1e-4}}};
  const Estimate united = unite(apart);
  for (const Estimate& each : apart) CHECK(covers(united, each));
  check_near(united.mean, {5e44, 5e44}, 1e40);
}

TEST_CASE("estimates of quantities in very different units are fused as in like units") {
  const std::vector<Estimate> like{{{1, 2}, {4, 1, 1, 9}}, {{2, 1}, {9, -1, -1, 2}}};
  std::vector<Estimate> unlike;
  for (const Estimate& each : like) {
    const auto& p = each.covariance;
    unlike.push_back(
        {{each.mean[0] * 1e40, each.mean[1] * 1e-40}, {p[0] * 1e80, p[1], p[2], p[3] * 1e-80}});
  }
  for (const auto fuse : {fuse_independent, unite}) {
    const Estimate expected = fuse(like), fused = fuse(unlike);
    check_near({fused.mean[0] / 1e40, fused.mean[1] * 1e40}, expected.mean, 1e-5);
    const auto& p = fused.covariance;
    check_near({p[0] / 1e80, p[1], p[2], p[3] * 1e80}, expected.covariance, 1e-5);
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

TEST_CASE("estimates disagree if any two of them do, in whatever order they come") {
  const Estimate sharp{{0}, {1}}, vague{{10}, {100}}, far{{20}, {1}};
  for (const auto& estimates : {std::vector{sharp, vague, far}, {vague, sharp, far}}) {
    CHECK(fuse_cautiously(estimates) == unite(estimates));
  }
}
