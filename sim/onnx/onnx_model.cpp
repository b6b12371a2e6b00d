#include "sim/onnx/onnx_model.hpp"

#include <map>
#include <vector>

#include "sim/model/network_layers.hpp"
#include "sim/onnx/graph_builder.hpp"
#include "sim/onnx/new_model.hpp"
#include "sim/onnx/weight_layout.hpp"
#include "sim/terminal/write_file.hpp"

namespace tumblesight::sim {

namespace shape = gnc::shape;
namespace {

// Adds the network's layers to a graph. Values are known by the names in the network's table.
class LayerGraph {
 public:
  explicit LayerGraph(GraphBuilder& graph) : graph_(graph) {}

  // The layers that read `name` get the ONNX value `value`.
  void set_input(const char* name, const std::string& value) { values_[name] = value; }

  void add(const Float32Layer& layer) {
    switch (layer.row.kind) {
      case gnc::LayerKind::kConvolution:
        return add_convolution(layer);
      case gnc::LayerKind::kDense:
        return add_dense(layer);
      case gnc::LayerKind::kLstm:
        return add_lstm(layer);
    }
  }

 private:
  void add_convolution(const Float32Layer& layer) {
    const std::string name = layer.row.name;
    const std::int64_t out = layer.row.outputs, in = layer.row.inputs;
    graph_.weights(name + ".weight", {out, in, 3, 3}, convolution_of_onnx(layer));
    graph_.weights(name + ".bias", {out}, values_of(layer.bias));
    onnx::NodeProto& node =
        graph_.node("Conv", {values_.at(layer.row.reads[0]), name + ".weight", name + ".bias"}, {name});
    set_attribute(node, "kernel_shape", OnnxShape{3, 3});
    set_attribute(node, "pads", OnnxShape{1, 1, 1, 1});
    const std::string activated = graph_.flow("Relu", {name}, name + ".relu");
    const bool average = layer.row.output == gnc::LayerOutput::kAveragePooled;
    onnx::NodeProto& pooling =
        graph_.node(average ? "AveragePool" : "MaxPool", {activated}, {activated + ".pooled"});
    set_attribute(pooling, "kernel_shape", OnnxShape{2, 2});
    set_attribute(pooling, "strides", OnnxShape{2, 2});
    values_[name] = pooling.output(0);
  }

  void add_dense(const Float32Layer& layer) {
    const std::string name = layer.row.name;
    const bool is_output = !is_hidden(layer.row);
    const std::string value = dense_input(layer.row);
    graph_.weights(name + ".weight", {layer.row.inputs, layer.row.outputs}, dense_of_onnx(layer));
    graph_.weights(name + ".bias", {layer.row.outputs}, values_of(layer.bias));
    graph_.flow("Gemm", {value, name + ".weight", name + ".bias"}, is_output ? "output" : name);
    if (is_output) return;
    const bool is_feature_layer = name == gnc::kLayers[gnc::kFeatureLayer].name;
    values_[name] = graph_.flow("Relu", {name}, is_feature_layer ? "features" : name + ".relu");
  }

  // The vector that a dense layer reads.
  std::string dense_input(const gnc::LayerRow& row) {
    if (reads_flat_image(row)) return graph_.flow("Flatten", {values_.at(row.reads[0])}, "flat");
    std::vector<std::string> values;
    for (const std::string& name : reads_of(row)) values.push_back(values_.at(name));
    if (values.size() == 1) return values.front();
    onnx::NodeProto& joined = graph_.node("Concat", values, {"head.input"});
    set_attribute(joined, "axis", 1);
    return joined.output(0);
  }

  // Reads the values "h" and "c", gives "h_next" and "c_next".
  void add_lstm(const Float32Layer& layer) {
    const std::int64_t in = layer.row.inputs, hidden = layer.row.outputs, gates = 4 * hidden;
    const auto units = static_cast<std::size_t>(hidden);
    std::vector<float> bias = gates_of_onnx(layer.bias, units);
    bias.resize(2 * bias.size());  // ONNX adds a second half
    graph_.weights("lstm.weight", {1, gates, in}, gates_of_onnx(layer.weight, units));
    graph_.weights("lstm.recurrent", {1, gates, hidden}, gates_of_onnx(layer.recurrent, units));
    graph_.weights("lstm.bias", {1, 2 * gates}, bias);
    const std::string step = graph_.reshape(values_.at(layer.row.reads[0]), {1, 1, in}, "step");
    const std::string h = graph_.reshape("h", {1, 1, hidden}, "h.before");
    const std::string c = graph_.reshape("c", {1, 1, hidden}, "c.before");
    const std::string no_lengths;  // every sequence has the full length
    onnx::NodeProto& node =
        graph_.node("LSTM", {step, "lstm.weight", "lstm.recurrent", "lstm.bias", no_lengths, h, c},
                    {"", "lstm", "cells"});
    set_attribute(node, "hidden_size", hidden);
    values_[layer.row.name] = graph_.reshape("lstm", {1, hidden}, "h_next");
    graph_.reshape("cells", {1, hidden}, "c_next");
  }

  GraphBuilder& graph_;
  std::map<std::string, std::string> values_;  // ONNX name by the table's name
};

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
  const std::string image =
      graph.input("image", {1, 1, shape::kImageSide, shape::kImageSide},
                  "Depth image, row 0 at the top. 0: nothing there; otherwise 0.5 + 0.5 (depth of the "
                  "centroid - depth) / radius of the target, nearer is brighter, up to 1. Its sides span "
                  "swath_mm across the line of sight to the centroid.");
  onnx::NodeProto& folding = graph.node("SpaceToDepth", {image}, {"folded"});
  set_attribute(folding, "blocksize", 2);
  LayerGraph layers(graph);
  layers.set_input(gnc::kDepthInput, "folded");
  const std::vector<Float32Layer> all = layers_of(model.weights);
  for (int i = 0; i < gnc::kLstmLayer; ++i) layers.add(all[i]);
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
  const std::vector<Float32Layer> all = layers_of(model.weights);
  for (int i = gnc::kLstmLayer; i < gnc::kLayerCount; ++i) layers.add(all[i]);
  describe_recurrent_outputs(graph);
  return result.SerializeAsString();
}

OnnxFiles write_onnx_files(const Float32Model& model, const std::string& prefix) {
  const std::string cnn = cnn_as_onnx(model), recurrent = recurrent_as_onnx(model);
  const OnnxFiles files{{prefix + ".cnn.onnx", cnn.size()}, {prefix + ".recurrent.onnx", recurrent.size()}};
  write_file(files.cnn.path, cnn);
  write_file(files.recurrent.path, recurrent);
  return files;
}

}  // namespace tumblesight::sim
