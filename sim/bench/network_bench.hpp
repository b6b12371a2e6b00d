// Run time of an estimator step and of its parts on one thread, for every instruction set, and of the same
// network in other runtimes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/bench/runtime.hpp"

namespace tumblesight::sim {

struct BenchRow {
  std::string name;  // step, depth image, network or convolutions; or the runtime's name
  std::string numerics;
  std::string isa;
  double median_us = 0.0;
  double min_us = 0.0;
  double macs = 0.0;  // multiply-accumulates per run; 0: not counted
  // Of the fastest run: multiply-accumulates per second over the measured peak of the core. They are those of
  // a direct convolution: kernels that need fewer may exceed 1.
  std::optional<double> share_of_peak;
};

struct BenchSubject {
  std::vector<std::uint8_t> image;  // a model image of either numerics
  std::vector<gnc::RangeImage> frames;
  double row_s = 0.6;  // measuring time per row
};

// Calls `started` with the names of numerics and instruction set before measuring them. Throws
// std::runtime_error if the image is refused.
std::vector<BenchRow> bench_numerics(const BenchSubject& subject,
                                     const std::function<void(const std::string&)>& started);

// Run time of the network in `runtime`: CNN and recurrent part, without the depth image. The state is kept
// from frame to frame. First compares the outputs with those of our network with the same weights, in float32
// or in fixed point (runtimes in int8), and throws std::runtime_error if they differ.
BenchRow bench_runtime(Runtime& runtime, const Float32Model& model,
                       const std::vector<gnc::RangeImage>& frames);
BenchRow bench_runtime(Runtime& runtime, const FixedPointModel& model,
                       const std::vector<gnc::RangeImage>& frames);

// Largest difference between the outputs of `runtime` and ours in these frames, relative to the largest value
// of that output. Outputs: of the CNN, features, and of the recurrent head.
double largest_difference(Runtime& runtime, const FixedPointModel& model,
                          const std::vector<gnc::RangeImage>& frames);

}  // namespace tumblesight::sim
