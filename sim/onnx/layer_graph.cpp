#include "sim/onnx/layer_graph.hpp"

#include <vector>

#include "sim/onnx/weight_layout.hpp"

namespace tumblesight::sim {

void LayerGraph::add_cnn(const gnc::NetworkWeights<gnc::Float32>& weights) {
  const std::string image =
      graph_.input("image", {1, 1, gnc::shape::kImageSide, gnc::shape::kImageSide},
                   "Depth image, row 0 at the top. 0: nothing there; otherwise 0.5 + 0.5 (depth of the "
                   "centroid - depth) / radius of the target, nearer is brighter, up to 1. Its sides span "
                   "swath_mm across the line of sight to the centroid.");
  onnx::NodeProto& folding = graph_.node("SpaceToDepth", {image}, {"folded"});
  set_attribute(folding, "blocksize", 2);
  set_input(gnc::kDepthInput, "folded");
  const std::vector<Float32Layer> layers = layers_of(weights);
  for (int i = 0; i < gnc::kLstmLayer; ++i) add(layers[static_cast<std::size_t>(i)]);
}

void LayerGraph::add_recurrent(const gnc::NetworkWeights<gnc::Float32>& weights) {
  const std::vector<Float32Layer> layers = layers_of(weights);
  for (int i = gnc::kLstmLayer; i < gnc::kLayerCount; ++i) add(layers[static_cast<std::size_t>(i)]);
}

void LayerGraph::add(const Float32Layer& layer) {
  switch (layer.row.kind) {
    case gnc::LayerKind::kConvolution:
      return add_convolution(layer);
    case gnc::LayerKind::kDense:
      return add_dense(layer);
    case gnc::LayerKind::kLstm:
      return add_lstm(layer);
  }
}

void LayerGraph::add_convolution(const Float32Layer& layer) {
  const std::string name = layer.row.name;
  const std::int64_t out = layer.row.outputs, in = layer.row.inputs;
  graph_.weights(name + ".weight", {out, in, 3, 3}, convolution_of_onnx(layer));
  graph_.weights(name + ".bias", {out}, values_of(layer.bias));
  onnx::NodeProto& node =
      graph_.node("Conv", {value(layer.row.reads[0]), name + ".weight", name + ".bias"}, {name});
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

void LayerGraph::add_dense(const Float32Layer& layer) {
  const std::string name = layer.row.name;
  const std::string input = dense_input(layer.row);
  graph_.weights(name + ".weight", {layer.row.inputs, layer.row.outputs}, dense_of_onnx(layer));
  graph_.weights(name + ".bias", {layer.row.outputs}, values_of(layer.bias));
  values_[name] = graph_.flow("Gemm", {input, name + ".weight", name + ".bias"}, name);
  if (is_hidden(layer.row)) values_[name] = graph_.flow("Relu", {name}, name + ".relu");
}

// The vector that a dense layer reads.
std::string LayerGraph::dense_input(const gnc::LayerRow& row) {
  if (reads_flat_image(row)) return graph_.flow("Flatten", {value(row.reads[0])}, "flat");
  std::vector<std::string> values;
  for (const std::string& name : reads_of(row)) values.push_back(value(name));
  if (values.size() == 1) return values.front();
  onnx::NodeProto& joined = graph_.node("Concat", values, {std::string(row.name) + ".input"});
  set_attribute(joined, "axis", 1);
  return joined.output(0);
}

void LayerGraph::add_lstm(const Float32Layer& layer) {
  const std::int64_t in = layer.row.inputs, hidden = layer.row.outputs, gates = 4 * hidden;
  const auto units = static_cast<std::size_t>(hidden);
  std::vector<float> bias = gates_of_onnx(layer.bias, units);
  bias.resize(2 * bias.size());  // ONNX adds a second half
  graph_.weights("lstm.weight", {1, gates, in}, gates_of_onnx(layer.weight, units));
  graph_.weights("lstm.recurrent", {1, gates, hidden}, gates_of_onnx(layer.recurrent, units));
  graph_.weights("lstm.bias", {1, 2 * gates}, bias);
  const std::string step = graph_.reshape(value(layer.row.reads[0]), {1, 1, in}, "lstm.step");
  const std::string h = graph_.reshape(value("h"), {1, 1, hidden}, "h.before");
  const std::string c = graph_.reshape(value("c"), {1, 1, hidden}, "c.before");
  const std::string no_lengths;  // every sequence has the full length
  onnx::NodeProto& node =
      graph_.node("LSTM", {step, "lstm.weight", "lstm.recurrent", "lstm.bias", no_lengths, h, c},
                  {"", "lstm.h", "lstm.c"});
  set_attribute(node, "hidden_size", hidden);
  values_[layer.row.name] = graph_.reshape("lstm.h", {1, hidden}, "h.after");
  values_["c_next"] = graph_.reshape("lstm.c", {1, hidden}, "c.after");
}

}  // namespace tumblesight::sim
