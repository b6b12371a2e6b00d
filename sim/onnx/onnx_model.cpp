#include "sim/onnx/onnx_model.hpp"

#include <array>
#include <cstdio>
#include <vector>

#include "sim/onnx/graph_builder.hpp"
#include "sim/onnx/weight_layout.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

constexpr int kIrVersion = 8;
constexpr int kOpset = 13;

template <class Layer>
std::string convolution(GraphBuilder& graph, const std::string& name, const Layer& layer,
                        const std::string& value) {
  const auto out = static_cast<std::int64_t>(layer.bias.size());
  const auto in = static_cast<std::int64_t>(layer.weight.size()) / out / 9;
  graph.weights(name + ".weight", {out, in, 3, 3}, convolution_of_onnx(layer));
  graph.weights(name + ".bias", {out}, values_of(layer.bias));
  onnx::NodeProto& node = graph.node("Conv", {value, name + ".weight", name + ".bias"}, {name});
  set_attribute(node, "kernel_shape", OnnxShape{3, 3});
  set_attribute(node, "pads", OnnxShape{1, 1, 1, 1});
  return graph.flow("Relu", {name}, name + ".relu");
}

std::string pooled_2x2(GraphBuilder& graph, const std::string& operation, const std::string& value) {
  onnx::NodeProto& node = graph.node(operation, {value}, {value + ".pooled"});
  set_attribute(node, "kernel_shape", OnnxShape{2, 2});
  set_attribute(node, "strides", OnnxShape{2, 2});
  return node.output(0);
}

// `weight`: [in][out], as the layer's own.
template <class Bias>
std::string dense(GraphBuilder& graph, const std::string& name, const std::vector<float>& weight,
                  const Bias& bias, const std::string& value, const std::string& result) {
  const auto out = static_cast<std::int64_t>(bias.size());
  const auto in = static_cast<std::int64_t>(weight.size()) / out;
  graph.weights(name + ".weight", {in, out}, weight);
  graph.weights(name + ".bias", {out}, values_of(bias));
  return graph.flow("Gemm", {value, name + ".weight", name + ".bias"}, result);
}

// Gives the new hidden state; the new cells are the value "cells".
template <class Layer>
std::string lstm(GraphBuilder& graph, const Layer& layer, const std::string& input) {
  constexpr std::int64_t kIn = shape::kLstmInput, kHidden = shape::kLstm, kGates = 4 * kHidden;
  std::vector<float> bias = gates_of_onnx(layer.bias);
  bias.resize(2 * kGates);  // the second half is added as well
  graph.weights("lstm.weight", {1, kGates, kIn}, gates_of_onnx(layer.weight));
  graph.weights("lstm.recurrent", {1, kGates, kHidden}, gates_of_onnx(layer.recurrent));
  graph.weights("lstm.bias", {1, 2 * kGates}, bias);
  const std::string step = graph.reshape(input, {1, 1, kIn}, "step");
  const std::string h = graph.reshape("h", {1, 1, kHidden}, "h.before");
  const std::string c = graph.reshape("c", {1, 1, kHidden}, "c.before");
  const std::string whole_batch;  // no lengths of sequences
  onnx::NodeProto& node = graph.node(
      "LSTM", {step, "lstm.weight", "lstm.recurrent", "lstm.bias", whole_batch, h, c}, {"", "lstm", "cells"});
  set_attribute(node, "hidden_size", kHidden);
  return "lstm";
}

void add_metadata(onnx::ModelProto& model, const std::string& key, const std::string& value) {
  onnx::StringStringEntryProto& entry = *model.add_metadata_props();
  entry.set_key(key);
  entry.set_value(value);
}

onnx::ModelProto new_model(const gnc::ModelHeader& header, const std::string& graph,
                           const std::string& description) {
  onnx::ModelProto model;
  model.set_ir_version(kIrVersion);
  onnx::OperatorSetIdProto& operators = *model.add_opset_import();
  operators.set_domain("");
  operators.set_version(kOpset);
  model.set_producer_name("Tumblesight");
  model.set_producer_version(TUMBLESIGHT_VERSION);
  model.set_doc_string(description);
  model.mutable_graph()->set_name(graph);
  std::array<char, 9> crc32{};
  std::snprintf(crc32.data(), crc32.size(), "%08x", static_cast<unsigned>(header.crc32));
  add_metadata(model, "target", header.target.data());
  add_metadata(model, "crc32", crc32.data());
  add_metadata(model, "swath_mm", std::to_string(header.projection.swath_mm));
  add_metadata(model, "target_radius_mm", std::to_string(header.projection.target_radius_mm));
  return model;
}

std::string text(const char* before, int number, const char* after) {
  return before + std::to_string(number) + after;
}

void describe_cnn_outputs(GraphBuilder& graph) {
  graph.output("features", {1, shape::kDense2}, "What the recurrent model's input begins with.");
  graph.output(
      "output", {1, shape::kOutput},
      text("For each of ", shape::kHypotheses,
           " hypotheses the first two columns of the attitude, the rotation from the target's frame to the "
           "view (x right, y along the line of sight, z up), six numbers to be orthonormalised; then ") +
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
  const auto& weights = model.weights;
  onnx::ModelProto result = new_model(model.header, "cnn", "Attitude hypotheses from one depth image.");
  GraphBuilder graph(*result.mutable_graph());
  std::string x =
      graph.input("image", {1, 1, shape::kImageSide, shape::kImageSide},
                  "Depth image, row 0 at the top. 0: nothing there; otherwise 0.5 + 0.5 (depth of the "
                  "centroid - depth) / radius of the target, nearer is brighter, up to 1. Its sides span "
                  "swath_mm across the line of sight to the centroid.");
  onnx::NodeProto& folding = graph.node("SpaceToDepth", {x}, {"folded"});
  set_attribute(folding, "blocksize", 2);
  x = pooled_2x2(graph, "MaxPool", convolution(graph, "conv1", weights.conv1, "folded"));
  x = pooled_2x2(graph, "MaxPool", convolution(graph, "conv2", weights.conv2, x));
  x = pooled_2x2(graph, "MaxPool", convolution(graph, "conv3", weights.conv3, x));
  x = pooled_2x2(graph, "AveragePool", convolution(graph, "conv4", weights.conv4, x));
  x = graph.flow("Flatten", {x}, "flat");
  x = dense(graph, "dense1", dense_after_flattening(weights.dense1), weights.dense1.bias, x, "dense1");
  x = graph.flow("Relu", {x}, "dense1.relu");
  x = dense(graph, "dense2", values_of(weights.dense2.weight), weights.dense2.bias, x, "dense2");
  x = graph.flow("Relu", {x}, "features");
  dense(graph, "cnn_out", values_of(weights.cnn_out.weight), weights.cnn_out.bias, x, "output");
  describe_cnn_outputs(graph);
  return result.SerializeAsString();
}

std::string recurrent_as_onnx(const Float32Model& model) {
  const auto& weights = model.weights;
  onnx::ModelProto result = new_model(model.header, "recurrent",
                                      "What to believe of one frame's hypotheses, from all frames so far.");
  GraphBuilder graph(*result.mutable_graph());
  describe_recurrent_inputs(graph);
  lstm(graph, weights.lstm, "input");
  std::string x = graph.reshape("lstm", {1, shape::kLstm}, "h_next");
  graph.reshape("cells", {1, shape::kLstm}, "c_next");
  onnx::NodeProto& both = graph.node("Concat", {x, "input"}, {"head.input"});
  set_attribute(both, "axis", 1);
  x = dense(graph, "head1", values_of(weights.head1.weight), weights.head1.bias, "head.input", "head1");
  x = graph.flow("Relu", {x}, "head1.relu");
  dense(graph, "head2", values_of(weights.head2.weight), weights.head2.bias, x, "output");
  describe_recurrent_outputs(graph);
  return result.SerializeAsString();
}

}  // namespace tumblesight::sim
