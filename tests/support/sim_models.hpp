// Models for tests of the ground.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/model/model_file.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::sim {

// A float32 model as the ground reads it from a file, with random weights.
inline std::unique_ptr<Float32Model> random_float32_model(unsigned seed) {
  auto model = std::make_unique<Float32Model>();
  model->header = gnc::test_header();
  gnc::fill_random(model->weights, seed);
  return model;
}

// A valid model image with arbitrary weights: its estimates are wrong, but it gives one for every frame.
inline std::vector<std::uint8_t> arbitrary_model(const char* target, std::uint32_t swath_mm = 7000) {
  gnc::ModelHeader header = gnc::test_header();
  header.projection = {swath_mm, 3800};
  if (!gnc::set_target(header, target)) return {};
  return gnc::random_model_image<gnc::FixedPoint>(4711, header);
}

}  // namespace tumblesight::sim
