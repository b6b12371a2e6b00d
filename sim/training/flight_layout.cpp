#include "sim/training/flight_layout.hpp"

namespace tumblesight::sim {

torch::Tensor tensor_of(const TensorView& values) {
  return torch::from_blob(const_cast<float*>(values.data), {static_cast<std::int64_t>(values.size)},
                          torch::kFloat);
}

torch::Tensor weight_from_flight(const gnc::LayerRow& row, const torch::Tensor& flat) {
  if (row.kind == gnc::LayerKind::kConvolution) {
    return flat.view({3, 3, row.inputs, row.outputs}).permute({3, 2, 0, 1});
  }
  if (reads_flat_image(row)) {
    return flat.view({-1, channels_of(row.reads[0]), row.outputs}).permute({2, 1, 0}).flatten(1);
  }
  const int sums = row.kind == gnc::LayerKind::kLstm ? 4 * row.outputs : row.outputs;
  return flat.view({-1, sums}).t();
}

torch::Tensor weight_to_flight(const gnc::LayerRow& row, const torch::Tensor& weight) {
  if (row.kind == gnc::LayerKind::kConvolution) return weight.permute({2, 3, 1, 0});
  if (reads_flat_image(row)) {
    return weight.view({row.outputs, channels_of(row.reads[0]), -1}).permute({2, 1, 0});
  }
  return weight.t();
}

}  // namespace tumblesight::sim
