#include "sim/onnx/onnx_model.hpp"

#include "sim/onnx/graph_builder.hpp"
#include "sim/onnx/layer_graph.hpp"
#include "sim/onnx/new_model.hpp"

namespace tumblesight::sim {

namespace shape = gnc::shape;
namespace {

std::string text(const char* before, int number, const char* after) {
  return before + std::to_string(number) + after;
}

void describe_cnn_outputs(GraphBuilder& graph) {
  graph.output("features", {1, shape::kDense2}, "The first values of the recurrent model's input.");
  graph.output(
      "output", {1, shape::kOutput},
      text("For each of ", shape::kHypotheses,
           " hypotheses the first two columns of the attitude, the rotation from the target's frame to the "
           "view (x right, y along the line of sight, z up), six numbers to be orthonormalized; then ") +
          "the hypotheses' logits; last, the logit of the expected error over pi.");
}

void describe_recurrent_inputs(GraphBuilder& graph) {
  graph.input(
      "input", {1, shape::kLstmInput},
      "The CNN's features; for each hypothesis the first two columns of its turn relative to the predicted "
      "attitude, in the target's frame; the hypotheses' probabilities; the first two columns of the "
      "predicted attitude, the rotation from the target's frame to the LiDAR's.");
  graph.input("h", {1, shape::kLstm}, "Hidden state; zeros before the first frame.");
  graph.input("c", {1, shape::kLstm}, "Cells; zeros before the first frame.");
}

void describe_recurrent_outputs(GraphBuilder& graph) {
  graph.output(
      "output", {1, shape::kHeadOutput},
      text("For ", shape::kCandidates,
           " candidates, the hypotheses and the predicted attitude: corrections to the logits of choosing "
           "them, then to the logarithms of their weights; then to the gain of the rate; last, the logit of "
           "the expected error over pi."));
  graph.output("h_next", {1, shape::kLstm}, "Hidden state, for the next frame's h.");
  graph.output("c_next", {1, shape::kLstm}, "Cells, for the next frame's c.");
}

}  // namespace

std::string cnn_as_onnx(const Float32Model& model) {
  onnx::ModelProto result = new_model(model.header, "cnn", "Attitude hypotheses from one depth image.");
  GraphBuilder graph(*result.mutable_graph());
  LayerGraph layers(graph);
  layers.add_cnn(model.weights);
  graph.flow("Identity", {layers.features()}, "features");
  graph.flow("Identity", {layers.cnn_output()}, "output");
  describe_cnn_outputs(graph);
  return result.SerializeAsString();
}

std::string recurrent_as_onnx(const Float32Model& model) {
  onnx::ModelProto result =
      new_model(model.header, "recurrent", "Weights of one frame's hypotheses, from all frames so far.");
  GraphBuilder graph(*result.mutable_graph());
  describe_recurrent_inputs(graph);
  LayerGraph layers(graph);
  layers.set_input(gnc::kLstmInput, "input");
  layers.set_input("h", "h");
  layers.set_input("c", "c");
  layers.add_recurrent(model.weights);
  graph.flow("Identity", {layers.head_output()}, "output");
  graph.flow("Identity", {layers.next_h()}, "h_next");
  graph.flow("Identity", {layers.next_c()}, "c_next");
  describe_recurrent_outputs(graph);
  return result.SerializeAsString();
}

}  // namespace tumblesight::sim
