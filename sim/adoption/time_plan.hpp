// TimePlan: how an adoption shares out its time.
#pragma once

#include <cstdint>

namespace tumblesight::sim {

struct TimePlan {
  double cnn_s = 0.0;
  double rcnn_s = 0.0;
  double after_s = 0.0;           // kept for quantization, evaluation and flight
  std::uint32_t sequences = 0;    // of each row of the evaluation
  int calibration_sequences = 0;  // of the scales in fixed point
};

// `seconds`: what is left when training begins. `rows`: of the evaluation. `sequence_s`: measured time of one
// sequence, all threads together. `sequences`: wanted; 0: as many as the time allows, at most 900. Throws
// std::invalid_argument that names the least time if less than half of it would be left for training.
TimePlan time_plan(double seconds, std::uint32_t rows, double sequence_s, std::uint32_t sequences);

}  // namespace tumblesight::sim
