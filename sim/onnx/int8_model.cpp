#include "sim/onnx/int8_model.hpp"

#include <cstdint>
#include <vector>

#include "sim/model/int8_layers.hpp"
#include "sim/model/network_layers.hpp"
#include "sim/onnx/graph_builder.hpp"
#include "sim/onnx/new_model.hpp"
#include "sim/onnx/weight_layout.hpp"

namespace tumblesight::sim {

namespace shape = gnc::shape;
namespace {

constexpr float kAverageUnits = 4.0F;  // the sum of four has four times the unit of their mean

class Int8Graph {
 public:
  explicit Int8Graph(GraphBuilder& graph) : graph_(graph) { graph_.weights<std::uint8_t>("zero", {}, {0}); }

  // Appends the layer to `value` and returns its output.
  std::string add(const Int8Layer& layer, const std::string& value) {
    return is_image_layer(layer.row) ? add_convolution(layer, value) : add_dense(layer, value);
  }

  std::string dequantized(const std::string& value, float unit, const std::string& name) {
    return graph_.flow("DequantizeLinear", {value, scalar(name + ".unit", unit), "zero"}, name);
  }

 private:
  std::string scalar(const std::string& name, float value) {
    return graph_.weights<float>(name, {}, {value});
  }

  // Input and weights of a layer with their scales and zero points, in the order of the operators.
  std::vector<std::string> operands(const Int8Layer& layer, const std::string& value,
                                    const OnnxShape& weight_shape, const std::vector<std::int8_t>& weight) {
    const std::string name = layer.row.name;
    const std::int64_t out = layer.row.outputs;
    std::vector<float> weight_scale = layer.scale;
    for (float& scale : weight_scale) scale *= layer.output_unit / layer.input_unit;
    graph_.weights(name + ".weight", weight_shape, weight);
    graph_.weights(name + ".weight_scale", {out}, weight_scale);
    graph_.weights(name + ".weight_zero", {out}, std::vector<std::int8_t>(weight_scale.size()));
    graph_.weights(name + ".bias", {out}, layer.bias);
    return {value,
            scalar(name + ".input_scale", layer.input_unit),
            "zero",
            name + ".weight",
            name + ".weight_scale",
            name + ".weight_zero"};
  }

  std::string add_convolution(const Int8Layer& layer, const std::string& value) {
    const std::string name = layer.row.name;
    std::vector<std::string> inputs =
        operands(layer, value, {layer.row.outputs, layer.row.inputs, 3, 3}, convolution_of_onnx(layer));
    inputs.insert(inputs.end(), {scalar(name + ".output_scale", layer.output_unit), "zero", name + ".bias"});
    onnx::NodeProto& node = graph_.node("QLinearConv", inputs, {name});
    set_attribute(node, "kernel_shape", OnnxShape{3, 3});
    set_attribute(node, "pads", OnnxShape{1, 1, 1, 1});
    if (layer.row.output == gnc::LayerOutput::kMaxPooled) return pooled("MaxPool", name);
    const float unit = kAverageUnits * layer.output_unit;
    const std::string mean = pooled("AveragePool", dequantized(name, unit, name + ".counts"));
    return graph_.flow("QuantizeLinear", {mean, scalar(name + ".mean_scale", unit), "zero"}, name + ".mean");
  }

  std::string pooled(const std::string& operation, const std::string& value) {
    onnx::NodeProto& node = graph_.node(operation, {value}, {value + ".pooled"});
    set_attribute(node, "kernel_shape", OnnxShape{2, 2});
    set_attribute(node, "strides", OnnxShape{2, 2});
    return node.output(0);
  }

  std::string add_dense(const Int8Layer& layer, const std::string& value) {
    const std::string name = layer.row.name;
    const std::string in = reads_flat_image(layer.row) ? graph_.flow("Flatten", {value}, "flat") : value;
    std::vector<std::string> inputs =
        operands(layer, in, {layer.row.inputs, layer.row.outputs}, dense_of_onnx(layer));
    inputs.push_back(name + ".bias");
    // Without a scale of the output, QGemm's output is float32.
    if (is_hidden(layer.row))
      inputs.insert(inputs.end(), {scalar(name + ".output_scale", layer.output_unit), "zero"});
    onnx::NodeProto& node = graph_.node("QGemm", inputs, {is_hidden(layer.row) ? name : "output"});
    node.set_domain("com.microsoft");
    return node.output(0);
  }

  GraphBuilder& graph_;
};

}  // namespace

std::string int8_cnn_as_onnx(const gnc::ModelHeader& header,
                             const gnc::NetworkWeights<gnc::FixedPoint>& weights) {
  onnx::ModelProto result =
      new_model(header, "cnn_int8", "Attitude hypotheses from one depth image, in int8.");
  onnx::OperatorSetIdProto& operators = *result.add_opset_import();
  operators.set_domain("com.microsoft");
  operators.set_version(1);
  GraphBuilder graph(*result.mutable_graph());
  const std::string image =
      graph.input("image", {1, 1, shape::kImageSide, shape::kImageSide},
                  "Depth image as in the float32 model, times 256, rounded.", onnx::TensorProto::UINT8);
  onnx::NodeProto& folding = graph.node("SpaceToDepth", {image}, {"folded"});
  set_attribute(folding, "blocksize", 2);
  Int8Graph layers(graph);
  std::string value = folding.output(0);
  for (const Int8Layer& layer : int8_layers_of(weights)) {
    value = layers.add(layer, value);
    if (gnc::layer_index(layer.row.name) == gnc::kFeatureLayer)
      layers.dequantized(value, layer.output_unit, "features");
  }
  graph.output("features", {1, shape::kDense2}, "Output of the feature layer, in counts.");
  graph.output("output", {1, shape::kOutput}, "As in the float32 model.");
  return result.SerializeAsString();
}

}  // namespace tumblesight::sim
