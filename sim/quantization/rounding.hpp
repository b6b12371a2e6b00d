// Rounds weights to integers so that the sums change as little as possible: the weights that are not yet
// rounded compensate each weight's rounding error, as far as their inputs are correlated (Frantar et al.
// 2023, GPTQ).
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
  void add(const std::vector<double>& sample);  // one value per input
  int inputs() const { return static_cast<int>(sum_.size()); }
  // All zero if there are no samples.
  Eigen::VectorXd mean() const;
  Eigen::VectorXd variance() const;
  Eigen::MatrixXd covariance() const;

 private:
  double count_ = 0.0;
  Eigen::VectorXd sum_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> squares_;  // upper triangle
};

// `weights`: [input][channel], in units of the integers. `covariance`: of the inputs. Returns integers within
// +-largest, as doubles.
Eigen::MatrixXd rounded_weights(Eigen::MatrixXd weights, const Eigen::MatrixXd& covariance, double largest);

}  // namespace tumblesight::sim
