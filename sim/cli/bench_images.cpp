#include "sim/cli/bench_images.hpp"

namespace tumblesight::sim {

BenchImages read_bench_images(const std::string& folder, const std::string& target) {
  const std::string float32_path = folder + "/" + target + ".float32.tsm";
  return {read_model_bytes(folder + "/" + target + ".tsm"), read_model_bytes(float32_path),
          read_float32_model(float32_path)};
}

}  // namespace tumblesight::sim
