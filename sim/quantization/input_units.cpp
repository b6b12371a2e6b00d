#include "sim/quantization/input_units.hpp"

#include <string>

#include "sim/model/network_layers.hpp"

namespace tumblesight::sim {

constexpr double kQ15 = 1.0 / 32768.0;

void put_depth_scales(Scales& scales) {
  scales[gnc::kDepthInput].assign(gnc::shape::kSpaceToDepthChannels, 1.0 / 256.0);
}

void put_lstm_scales(const gnc::LayerRow& lstm, Scales& scales) {
  scales[gnc::kLstmInput] = scales.at(gnc::kLayers[gnc::kFeatureLayer].name);
  scales[gnc::kLstmInput].resize(static_cast<std::size_t>(lstm.inputs), kQ15);
  scales[lstm.name].assign(static_cast<std::size_t>(lstm.outputs), kQ15);
}

std::vector<double> input_units(const gnc::LayerRow& row, const Scales& scales) {
  std::vector<double> units;
  const auto append = [&](const std::string& name, int times) {
    const std::vector<double>& of = scales.at(name);
    for (int i = 0; i < times; ++i) units.insert(units.end(), of.begin(), of.end());
  };
  for (const std::string& name : reads_of(row)) {
    append(name, is_image_layer(row) ? pixels_per_sum(row)
                                     : gnc::values_per_frame(name.c_str()) / channels_of(name));
  }
  if (sums_of(row.kind).read_state) append(row.name, 1);
  return units;
}

}  // namespace tumblesight::sim
