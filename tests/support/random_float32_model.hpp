// A float32 model as the ground reads it from a file, with random weights.
#pragma once

#include <memory>

#include "sim/model/model_file.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::sim {

inline std::unique_ptr<Float32Model> random_float32_model(unsigned seed) {
  auto model = std::make_unique<Float32Model>();
  model->header = gnc::test_header();
  gnc::fill_random(model->weights, seed);
  return model;
}

}  // namespace tumblesight::sim
