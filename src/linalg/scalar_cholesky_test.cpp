#include "linalg/scalar_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace aspic {
namespace {

struct System {
  std::vector<MatrixPlace> places;
  std::vector<double> values;
  Eigen::MatrixXd dense;
};

Eigen::VectorXd solved(ScalarCholesky& cholesky, const Eigen::VectorXd& b) {
  Eigen::VectorXd x = b;
  const size_t n = static_cast<size_t>(b.size());
  cholesky.solve({x.data(), n}, {x.data(), n});
  return x;
}

// Returns a graph Laplacian plus a diagonal; some places occur twice.
System random_system(int rows, int edges, double shift) {
  std::mt19937 random(5);
  System s;
  s.dense = Eigen::MatrixXd::Zero(rows, rows);
  const auto add = [&](int i, int j, double value) {
    s.places.push_back({std::max(i, j), std::min(i, j)});
    s.values.push_back(value);
    s.dense(i, j) += value;
    if (i != j) s.dense(j, i) += value;
  };
  for (int i = 0; i < rows; ++i) add(i, i, shift);
  for (int e = 0; e < edges; ++e) {
    const int i = static_cast<int>(random() % rows), j = static_cast<int>(random() % rows);
    if (i == j) continue;
    const double w = 1 + static_cast<double>(random() % 100) / 50;
    add(i, i, w), add(j, j, w), add(i, j, -w);
  }
  return s;
}

TEST(ScalarCholesky, AgreesWithDense) {
  for (int rows : {1, 2, 3, 4, 5, 31, 200})
    for (int edges : {0, rows / 3, rows, 3 * rows}) {
      SCOPED_TRACE(testing::Message() << rows << " rows, " << edges << " edges");
      const System s = random_system(rows, edges, 0.01);
      ScalarCholesky cholesky;
      cholesky.analyze(rows, s.places);
      ASSERT_TRUE(cholesky.factorize(s.values));
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(rows, -1, 2);
      const Eigen::VectorXd x = solved(cholesky, b), expected = s.dense.llt().solve(b);
      EXPECT_LE((x - expected).norm(), 1e-10 * expected.norm());
    }
}

TEST(ScalarCholesky, RefactorizesNewValues) {
  System s = random_system(50, 100, 1);
  ScalarCholesky cholesky;
  cholesky.analyze(50, s.places);
  ASSERT_TRUE(cholesky.factorize(s.values));
  for (double& v : s.values) v *= 4;
  ASSERT_TRUE(cholesky.factorize(s.values));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(50);
  EXPECT_LE((4 * s.dense * solved(cholesky, b) - b).norm(), 1e-12) << "`dense` is the first matrix";
}

TEST(ScalarCholesky, RejectsIndefiniteMatrix) {
  const System s = random_system(20, 40, -0.5);
  ScalarCholesky cholesky;
  cholesky.analyze(20, s.places);
  EXPECT_FALSE(cholesky.factorize(s.values));
}

}  // namespace
}  // namespace aspic
