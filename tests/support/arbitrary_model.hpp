// A model image with arbitrary weights: valid, answers every frame, not trained.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/support/test_models.hpp"

namespace tumblesight::sim {

inline std::vector<std::uint8_t> arbitrary_model(const char* target, std::uint32_t swath_mm = 7000) {
  gnc::ModelHeader header = gnc::test_header();
  header.projection = {swath_mm, 3800};
  if (!gnc::set_target(header, target)) return {};
  return gnc::random_model_image<gnc::FixedPoint>(4711, header);
}

}  // namespace tumblesight::sim
