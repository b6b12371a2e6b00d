// The model images that `tumblesight bench` measures.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

// The images of a target that are measured. `float32` and `model` hold the same one.
struct BenchImages {
  std::vector<std::uint8_t> fixed;
  std::vector<std::uint8_t> float32;
  std::unique_ptr<Float32Model> model;
};
// Reads both before anything is measured. Throws as read_model_bytes and read_float32_model do.
BenchImages read_bench_images(const std::string& folder, const std::string& target);

}  // namespace tumblesight::sim
