#include "sim/quantization/layer.hpp"

#include <algorithm>
#include <cmath>

namespace tumblesight::sim {

void add_rows(FloatLayer& layer, const float* weights, std::size_t inputs) {
  for (std::size_t i = 0; i < inputs; ++i)
    layer.rows.push_back(weights + i * static_cast<std::size_t>(layer.channels));
}

double largest_weight(const FloatLayer& layer, int channel) {
  double largest = std::abs(static_cast<double>(layer.bias[channel])) * 1e-6;
  for (std::size_t i = 0; i < layer.rows.size(); ++i)
    largest = std::max(largest, std::abs(layer.weight(i, channel)));
  return largest > 0.0 ? largest : 1.0;
}

IntegerLayer integers_of(const FloatLayer& layer, const std::vector<double>& scales,
                         const InputStatistics& inputs) {
  const auto count = static_cast<Eigen::Index>(layer.rows.size());
  const Eigen::VectorXd unit =
      Eigen::Map<const Eigen::VectorXd>(layer.input_scale.data(), count).cwiseInverse();
  const Eigen::Map<const Eigen::VectorXd> scale(scales.data(), layer.channels);
  Eigen::MatrixXd exact(count, layer.channels);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int c = 0; c < layer.channels; ++c)
      exact(i, c) = layer.weight(static_cast<std::size_t>(i), c) / scale[c];
  }
  const Eigen::MatrixXd covariance = unit.asDiagonal() * inputs.covariance() * unit.asDiagonal();
  const Eigen::MatrixXd integers = rounded_weights(exact, covariance, kLargestWeight);
  const Eigen::MatrixXd lost = exact - integers;
  const Eigen::VectorXd squares = lost.cwiseProduct(covariance * lost).colwise().sum().transpose();
  return {integers, lost.transpose() * unit.cwiseProduct(inputs.mean()),
          squares.cwiseProduct(scale.cwiseAbs2())};
}

}  // namespace tumblesight::sim
