#include "sim/training/flight_layout.hpp"

namespace tumblesight::sim {

torch::Tensor tensor_of(const TensorView& values) {
  return torch::from_blob(const_cast<float*>(values.data), {static_cast<std::int64_t>(values.size)},
                          torch::kFloat);
}

torch::Tensor weight_from_flight(const gnc::LayerRow& row, const torch::Tensor& flat) {
  const int sums = sum_channels(row);
  if (is_image_layer(row)) {
    const int window = sums_of(row.kind).window;
    return flat.view({window, window, row.inputs, sums}).permute({3, 2, 0, 1});
  }
  if (reads_flat_image(row)) {
    return flat.view({-1, channels_of(row.reads[0]), sums}).permute({2, 1, 0}).flatten(1);
  }
  return flat.view({-1, sums}).t();
}

torch::Tensor weight_to_flight(const gnc::LayerRow& row, const torch::Tensor& weight) {
  if (is_image_layer(row)) return weight.permute({2, 3, 1, 0});
  if (reads_flat_image(row)) {
    return weight.view({sum_channels(row), channels_of(row.reads[0]), -1}).permute({2, 1, 0});
  }
  return weight.t();
}

}  // namespace tumblesight::sim
