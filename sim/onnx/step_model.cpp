#include "sim/onnx/step_model.hpp"

#include <vector>

#include "sim/onnx/graph_builder.hpp"
#include "sim/onnx/layer_graph.hpp"
#include "sim/onnx/new_model.hpp"
#include "sim/onnx/track_graph.hpp"

namespace tumblesight::sim {

namespace shape = gnc::shape;
namespace {

constexpr double kNominalPeriod_s = 1e-9 * gnc::kNominalPeriod_ns;
constexpr int kMotionModels = gnc::kMotionModels;

struct StepState {
  OnnxTensor h, c;  // [1, kLstm]
  TrackGraph track;
};

StepState unpacked(const OnnxTensor& state) {
  std::int64_t next = 0;
  const auto take = [&](std::int64_t count) {
    next += count;
    return slice(state, 1, next - count, next);
  };
  const OnnxTensor h = take(shape::kLstm), c = take(shape::kLstm);
  const OnnxTensor r_lrf_trf = reshaped(take(9 * kMotionModels), {kMotionModels, 3, 3});
  const OnnxTensor rate_lrf = reshaped(take(3 * kMotionModels), {kMotionModels, 3, 1});
  const OnnxTensor log_likelihood = reshaped(take(kMotionModels), {kMotionModels, 1, 1});
  const OnnxTensor frames = reshaped(take(1), {1, 1, 1}), has_found_rate = reshaped(take(1), {1, 1, 1});
  return {h, c, {{r_lrf_trf, rate_lrf}, log_likelihood, frames, has_found_rate}};
}

OnnxTensor packed(const StepState& state) {
  const TrackGraph& track = state.track;
  std::vector<OnnxTensor> parts{state.h, state.c};
  for (const OnnxTensor& part : {track.motion.r_lrf_trf, track.motion.rate_lrf, track.log_likelihood,
                                 track.frames, track.has_found_rate})
    parts.push_back(reshaped(part, {1, -1}));
  return joined(parts, 1);
}

struct StepInputs {
  OnnxTensor r_lrf_view;
  IntervalGraph interval;
  OnnxTensor state;
};

StepInputs describe_inputs(GraphBuilder& graph) {
  const auto input = [&graph](const char* name, const OnnxShape& size, const char* description) {
    return OnnxTensor(graph, graph.input(name, size, description));
  };
  const OnnxTensor r_lrf_view =
      input("r_lrf_view", {1, 3, 3},
            "Rotation matrix, row by row, from the view to the LiDAR's frame: v_lrf = r_lrf_view v_view. The "
            "shortest one that takes +y to the direction of the centroid of the returns.");
  const OnnxTensor elapsed_s =
      input("elapsed_s", {1, 1},
            "Seconds between the exposures of the last frame and of this one; not used at the first frame. "
            "Values outside 0.1 to 43.2 are taken for the nearer limit.");
  const OnnxTensor q_now_last =
      input("q_now_last", {1, 4},
            "Turn of the LiDAR, with the chaser, since the last frame: unit quaternion w, x, y, z with v_lrf "
            "now = q_now_last v_lrf last, for vectors that are fixed in inertial space; 1, 0, 0, 0 for a "
            "chaser that does not turn.");
  const OnnxTensor state =
      input("state", {1, kStepState}, "next_state of the last frame; zeros at the first frame of a track.");
  return {r_lrf_view, {reshaped(elapsed_s, {1, 1, 1}), rotation_from_quaternion(q_now_last)}, state};
}

void describe_outputs(const TrackedGraph& tracked, const HypothesesGraph& hypotheses,
                      const OnnxTensor& next_state) {
  add_output(quaternion_from_rotation(tracked.motion.r_lrf_trf), "q_lrf_trf", {1, 4},
             "The attitude, from all frames so far: unit quaternion w, x, y, z, w >= 0, from the target's to "
             "the LiDAR's frame: v_lrf = q_lrf_trf v_trf.");
  add_output(tracked.expected_error_rad, "expected_error_rad", {1, 1},
             "The angle by which the network expects q_lrf_trf to be wrong, 0 to pi.");
  add_output(reshaped(tracked.motion.rate_lrf / kNominalPeriod_s, {1, 3}), "rate_lrf_rad_s", {1, 3},
             "Angular rate of the target relative to inertial space, in the LiDAR's frame.");
  add_output(reshaped(quaternion_from_rotation(hypotheses.r_lrf_trf), {1, shape::kHypotheses, 4}),
             "q_lrf_trf_hypotheses", {1, shape::kHypotheses, 4},
             "The attitudes that this frame alone allows, as q_lrf_trf.");
  add_output(hypotheses.probabilities, "probabilities", {1, shape::kHypotheses},
             "Of the hypotheses; their sum is 1.");
  add_output(next_state, "next_state", {1, kStepState}, "For the next frame's state.");
}

}  // namespace

std::string step_as_onnx(const Float32Model& model) {
  onnx::ModelProto result =
      new_model(model.header, "step",
                "One step of the estimator: a frame's depth image and the state to the attitude and the next "
                "state.");
  GraphBuilder graph(*result.mutable_graph());
  LayerGraph layers(graph);
  layers.add_cnn(model.weights);
  const StepInputs inputs = describe_inputs(graph);
  const StepState state = unpacked(inputs.state);
  const auto motion_models = gnc::motion_models<float>(gnc::converted<float>(model.header.inertia));

  const HypothesesGraph hypotheses =
      decoded_hypotheses(OnnxTensor(graph, layers.cnn_output()), inputs.r_lrf_view);
  const PredictionGraph prediction = predicted(state.track, motion_models, hypotheses, inputs.interval);

  const OnnxTensor forgets = reshaped(prediction.starts_anew, {1, 1});
  layers.set_input("h", where(forgets, 0.0, state.h).name());
  layers.set_input("c", where(forgets, 0.0, state.c).name());
  layers.set_input(gnc::kLstmInput,
                   lstm_input(OnnxTensor(graph, layers.features()), hypotheses, prediction).name());
  layers.add_recurrent(model.weights);

  const TrackedGraph tracked = advanced(hypotheses, prediction, OnnxTensor(graph, layers.head_output()));
  describe_outputs(
      tracked, hypotheses,
      packed({OnnxTensor(graph, layers.next_h()), OnnxTensor(graph, layers.next_c()), tracked.track}));
  return result.SerializeAsString();
}

}  // namespace tumblesight::sim
