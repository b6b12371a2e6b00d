// One ONNX model (opset 13) of a whole step of the estimator, so that its user has no algebra to write: CNN,
// hypotheses, prediction over the time and the turn since the last frame, LSTM, fusion, next state. It is
// gnc::AttitudeEstimator in float32 from the depth image on. How to use it: docs/onnx.md.
#pragma once

#include <string>

#include "gnc/attitude/motion.hpp"
#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

// Values in the state, in this order: h, c of the LSTM; for each motion model the attitude's matrix, row by
// row, the rate and the log-likelihood, each for all motion models; frames of the track; whether its rate is
// found.
inline constexpr int kStepState = 2 * gnc::shape::kLstm + (9 + 3 + 1) * gnc::kMotionModels + 2;

// A serialized model, the contents of an .onnx file. Doc strings describe inputs and outputs.
//
// Inputs:  image [1, 1, 100, 100], r_lrf_view [1, 3, 3], elapsed_s [1, 1], q_now_last [1, 4],
//          state [1, kStepState]
// Outputs: q_lrf_trf [1, 4], expected_error_rad [1, 1], rate_lrf_rad_s [1, 3],
//          q_lrf_trf_hypotheses [1, 8, 4], probabilities [1, 8], next_state [1, kStepState]
std::string step_as_onnx(const Float32Model& model);

}  // namespace tumblesight::sim
