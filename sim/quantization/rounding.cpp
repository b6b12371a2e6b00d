#include "sim/quantization/rounding.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tumblesight::sim {
namespace {

// Added to the covariance's diagonal, as a fraction of the diagonal's mean: there are few samples per input.
constexpr double kDamping = 0.01;

}  // namespace

void InputStatistics::add(const std::vector<double>& sample) {
  const int inputs = this->inputs();
  count_ += 1.0;
  for (int i = 0; i < inputs; ++i) {
    const double value = sample[i];
    if (value == 0.0) continue;
    sum_[i] += value;
    double* row = squares_.data() + static_cast<std::ptrdiff_t>(i) * inputs;
    for (int k = i; k < inputs; ++k) row[k] += value * sample[k];
  }
}

Eigen::VectorXd InputStatistics::mean() const {
  return sum_ / std::max(1.0, count_);
}

Eigen::VectorXd InputStatistics::variance() const {
  return squares_.diagonal() / std::max(1.0, count_) - mean().cwiseAbs2();
}

Eigen::MatrixXd InputStatistics::covariance() const {
  const Eigen::VectorXd average = mean();
  const Eigen::MatrixXd full = squares_.selfadjointView<Eigen::Upper>();
  return full / std::max(1.0, count_) - average * average.transpose();
}

Eigen::MatrixXd rounded_weights(Eigen::MatrixXd weights, const Eigen::MatrixXd& covariance, double largest) {
  const Eigen::Index inputs = weights.rows();
  Eigen::MatrixXd damped = covariance;
  const double damping = kDamping * covariance.diagonal().mean() + 1e-12;
  damped.diagonal().array() += damping;
  const Eigen::MatrixXd inverse = damped.llt().solve(Eigen::MatrixXd::Identity(inputs, inputs));
  const Eigen::MatrixXd upper = inverse.llt().matrixU();
  Eigen::MatrixXd integers(inputs, weights.cols());
  for (Eigen::Index i = 0; i < inputs; ++i) {
    for (Eigen::Index c = 0; c < weights.cols(); ++c) {
      integers(i, c) = std::min(largest, std::max(-largest, std::round(weights(i, c))));
    }
    const Eigen::RowVectorXd error = (weights.row(i) - integers.row(i)) / upper(i, i);
    for (Eigen::Index k = i + 1; k < inputs; ++k) weights.row(k) -= upper(i, k) * error;
  }
  return integers;
}

}  // namespace tumblesight::sim
