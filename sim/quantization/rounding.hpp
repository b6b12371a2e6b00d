// Rounding of weights so that the sums change as little as possible: each weight's rounding error is made up
// for by the weights after it, as far as their inputs go together (Frantar et al. 2023, GPTQ).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tumblesight::sim {

// Mean and covariance of a layer's inputs, from samples.
class InputStatistics {
 public:
  explicit InputStatistics(int inputs) : sum_(Eigen::VectorXd::Zero(inputs)), squares_(inputs, inputs) {
    squares_.setZero();
  }
  void add(const std::vector<double>& sample);
  int inputs() const { return static_cast<int>(sum_.size()); }
  Eigen::VectorXd mean() const;
  Eigen::MatrixXd covariance() const;
  Eigen::VectorXd variance() const;

 private:
  double count_ = 0.0;
  Eigen::VectorXd sum_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> squares_;  // upper triangle
};

// `weights`: [input][channel], in units of the integers wanted. Returns integers within +-largest.
Eigen::MatrixXd rounded(Eigen::MatrixXd weights, const Eigen::MatrixXd& covariance, double largest);

}  // namespace tumblesight::sim
