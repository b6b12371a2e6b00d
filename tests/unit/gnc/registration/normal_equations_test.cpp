#include "gnc/registration/normal_equations.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

NormalEquations equations_of(const Matrix6& information, const Vector6& gradient) {
  NormalEquations equations;
  for (int i = 0; i < kUnknowns; ++i) {
    for (int k = 0; k <= i; ++k) equations.information[element(i, k)] = std::llround(information(i, k));
    equations.gradient[static_cast<std::size_t>(i)] = std::llround(gradient(i));
  }
  return equations;
}

Matrix6 matrix_of(const NormalEquations& equations) {
  Matrix6 matrix;
  for (int i = 0; i < kUnknowns; ++i) {
    for (int k = 0; k <= i; ++k)
      matrix(i, k) = matrix(k, i) = static_cast<double>(equations.information[element(i, k)]);
  }
  return matrix;
}
Vector6 gradient_of(const NormalEquations& equations) {
  Vector6 vector;
  for (int i = 0; i < kUnknowns; ++i)
    vector(i) = static_cast<double>(equations.gradient[static_cast<std::size_t>(i)]);
  return vector;
}
Vector6 in_units(const Motion6& motion) {
  Vector6 vector;
  for (int i = 0; i < kUnknowns; ++i) vector(i) = motion[static_cast<std::size_t>(i)] / 16777216.0;
  return vector;
}

// Symmetric, with eigenvalues from `largest` / `condition` to `largest` in random directions.
Matrix6 random_matrix(double largest, double condition, Random& random) {
  Matrix6 any;
  for (int i = 0; i < 36; ++i) any(i) = random.normal();
  const Matrix6 q = any.householderQr().householderQ();
  Vector6 values;
  for (int i = 0; i < 6; ++i) values(i) = largest * std::pow(condition, random.uniform(-1.0, 0.0));
  values(0) = largest;
  values(5) = largest / condition;
  return q * values.asDiagonal() * q.transpose();
}

TEST(NormalEquations, ElementsOfTheLowerTriangleFollowOneAnother) {
  std::size_t next = 0;
  for (int i = 0; i < kUnknowns; ++i)
    for (int k = 0; k <= i; ++k) EXPECT_EQ(element(i, k), next++);
  EXPECT_EQ(next, std::size_t{kElements});
}

TEST(NormalEquations, AddAddsTheWeightedOuterProduct) {
  Random random(1);
  for (int i = 0; i < trials(200); ++i) {
    NormalEquations equations;
    Matrix6 matrix = Matrix6::Zero();
    Vector6 gradient = Vector6::Zero();
    constexpr int kRows = 20;
    for (int k = 0; k < kRows; ++k) {
      std::array<std::int32_t, kUnknowns> row{};
      Vector6 exact_row;
      for (std::size_t j = 0; j < kUnknowns; ++j) {
        row[j] = random.below(1 << 21) - (1 << 20);
        exact_row(static_cast<int>(j)) = row[j];
      }
      const std::int32_t weight = random.below(1 << 14), wanted = random.below(1 << 20) - (1 << 19);
      equations.add(row, weight, wanted);
      matrix += weight / 4096.0 * exact_row * exact_row.transpose();
      gradient += wanted * exact_row;
    }
    // Half a unit of a weighted element, times an element.
    ASSERT_LE((matrix_of(equations) - matrix).cwiseAbs().maxCoeff(), kRows * 0.5 * (1 << 20));
    ASSERT_LE((gradient_of(equations) - gradient).cwiseAbs().maxCoeff(), 0.5);
  }
}

// Within 2^-24 times the condition, for solutions of a tenth.
TEST(NormalEquations, SolutionIsThatOfDoublePrecision) {
  Random random(2);
  for (int i = 0; i < trials(4000); ++i) {
    const double condition = std::exp2(random.uniform(0.0, 20.0));
    const double largest = std::exp2(random.uniform(20.0, 50.0));
    const Matrix6 matrix = random_matrix(largest, condition, random);
    Vector6 solution;
    for (int k = 0; k < 6; ++k) solution(k) = random.uniform(-0.1, 0.1);
    const NormalEquations equations = equations_of(matrix, matrix * solution);
    const Vector6 exact = matrix_of(equations).ldlt().solve(gradient_of(equations));
    const double error = (in_units(solve(equations)) - exact).norm();
    const double bound = 1e-6 + condition * std::ldexp(1.0, -24);
    EXPECT_LT(error, bound) << "condition 2^" << std::log2(condition) << ", largest 2^" << std::log2(largest);
  }
}

// Unknowns of different units, in any order.
TEST(NormalEquations, SolutionOfUnknownsOfDifferentScaleIsThatOfDoublePrecision) {
  Random random(3);
  for (int i = 0; i < trials(4000); ++i) {
    Vector6 scale, solution;
    for (int k = 0; k < 6; ++k) {
      scale(k) = std::exp2(random.uniform(-7.0, 0.0));
      solution(k) = random.uniform(-0.1, 0.1);
    }
    const Matrix6 matrix = scale.asDiagonal() * random_matrix(1e12, 16.0, random) * scale.asDiagonal();
    const NormalEquations equations = equations_of(matrix, matrix * solution);
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(matrix_of(equations));
    const double condition = eigen.eigenvalues()(5) / eigen.eigenvalues()(0);
    if (condition > std::exp2(20.0)) continue;
    const Vector6 exact = matrix_of(equations).ldlt().solve(gradient_of(equations));
    ASSERT_LT((in_units(solve(equations)) - exact).norm(), 1e-6 + condition * std::ldexp(1.0, -24))
        << "condition 2^" << std::log2(condition);
  }
}

TEST(NormalEquations, SolutionIsLimited) {
  constexpr std::int32_t kLimit = 1 << 30;
  for (const double sign : {-1.0, 1.0}) {
    const NormalEquations equations = equations_of(Matrix6::Identity(), sign * 1000.0 * Vector6::Ones());
    for (const std::int32_t number : solve(equations)) {
      EXPECT_LE(std::abs(number), kLimit);
      EXPECT_GT(sign * number, 0.0);
    }
  }
}

TEST(NormalEquations, NoGradientIsNoMotion) {
  Random random(4);
  const NormalEquations equations = equations_of(random_matrix(1e9, 1000.0, random), Vector6::Zero());
  EXPECT_EQ(solve(equations), Motion6{});
}

// As of a frame that says nothing about some of the unknowns. Sanitizers tell an overflow.
TEST(NormalEquations, SingularMatrixGivesALimitedSolution) {
  Random random(5);
  for (int i = 0; i < trials(4000); ++i) {
    Matrix6 matrix = Matrix6::Zero();
    Vector6 gradient = Vector6::Zero();
    const double largest = std::exp2(random.uniform(4.0, 25.0));
    for (int row = 0; row < i % 6; ++row) {
      Vector6 any;
      for (int k = 0; k < 6; ++k)
        any(k) = i % 5 != 0 || k % 2 != 0 ? largest * random.uniform(-1.0, 1.0) : 0.0;
      matrix += any * any.transpose();
      gradient += any * random.uniform(-1.0, 1.0);
    }
    for (const std::int32_t number : solve(equations_of(matrix, gradient)))
      ASSERT_LE(std::abs(std::int64_t{number}), std::int64_t{1} << 30);
  }
  EXPECT_EQ(solve(NormalEquations()), Motion6{});
}

}  // namespace
}  // namespace tumblesight::gnc
