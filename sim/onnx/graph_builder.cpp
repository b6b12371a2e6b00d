#include "sim/onnx/graph_builder.hpp"

#include <functional>
#include <numeric>
#include <stdexcept>

namespace tumblesight::sim {
namespace {

void describe(onnx::ValueInfoProto& value, const std::string& name, const OnnxShape& shape,
              const std::string& description, onnx::TensorProto::DataType element) {
  value.set_name(name);
  value.set_doc_string(description);
  onnx::TypeProto::Tensor& type = *value.mutable_type()->mutable_tensor_type();
  type.set_elem_type(element);
  onnx::TensorShapeProto& sizes = *type.mutable_shape();  // that of a scalar is there, and empty
  for (const std::int64_t size : shape) {
    if (size == kAnySize)
      sizes.add_dim()->set_dim_param("n");
    else
      sizes.add_dim()->set_dim_value(size);
  }
}

onnx::TensorProto::DataType type_of(float) {
  return onnx::TensorProto::FLOAT;
}
onnx::TensorProto::DataType type_of(std::int8_t) {
  return onnx::TensorProto::INT8;
}
onnx::TensorProto::DataType type_of(std::uint8_t) {
  return onnx::TensorProto::UINT8;
}
onnx::TensorProto::DataType type_of(std::int32_t) {
  return onnx::TensorProto::INT32;
}
onnx::TensorProto::DataType type_of(std::int64_t) {
  return onnx::TensorProto::INT64;
}

onnx::AttributeProto& new_attribute(onnx::NodeProto& node, const std::string& name,
                                    onnx::AttributeProto::AttributeType type) {
  onnx::AttributeProto& attribute = *node.add_attribute();
  attribute.set_name(name);
  attribute.set_type(type);
  return attribute;
}

}  // namespace

std::string GraphBuilder::input(const std::string& name, const OnnxShape& shape,
                                const std::string& description, onnx::TensorProto::DataType type) {
  describe(*graph_.add_input(), name, shape, description, type);
  return name;
}

void GraphBuilder::output(const std::string& name, const OnnxShape& shape, const std::string& description,
                          onnx::TensorProto::DataType type) {
  describe(*graph_.add_output(), name, shape, description, type);
}

std::string GraphBuilder::new_name(const std::string& operation) {
  return prefix_ + operation + "." + std::to_string(names_++);
}

template <class Number>
std::string GraphBuilder::weights(const std::string& name, const OnnxShape& shape,
                                  const std::vector<Number>& values) {
  const auto count = std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>());
  if (count != static_cast<std::int64_t>(values.size()))
    throw std::logic_error(name + ": the number of values does not match the shape");
  onnx::TensorProto& tensor = *graph_.add_initializer();
  tensor.set_name(name);
  tensor.set_data_type(type_of(Number{}));
  tensor.mutable_dims()->Add(shape.begin(), shape.end());
  tensor.set_raw_data(values.data(), values.size() * sizeof(Number));
  return name;
}
template std::string GraphBuilder::weights(const std::string&, const OnnxShape&, const std::vector<float>&);
template std::string GraphBuilder::weights(const std::string&, const OnnxShape&,
                                           const std::vector<std::int8_t>&);
template std::string GraphBuilder::weights(const std::string&, const OnnxShape&,
                                           const std::vector<std::uint8_t>&);
template std::string GraphBuilder::weights(const std::string&, const OnnxShape&,
                                           const std::vector<std::int32_t>&);
template std::string GraphBuilder::weights(const std::string&, const OnnxShape&,
                                           const std::vector<std::int64_t>&);

std::string GraphBuilder::reshape(const std::string& value, const OnnxShape& shape, const std::string& name) {
  return flow("Reshape", {value, weights(name + ".shape", {static_cast<std::int64_t>(shape.size())}, shape)},
              name);
}

std::string GraphBuilder::flow(const std::string& operation, const std::vector<std::string>& inputs,
                               const std::string& name) {
  node(operation, inputs, {name});
  return name;
}

onnx::NodeProto& GraphBuilder::node(const std::string& operation, const std::vector<std::string>& inputs,
                                    const std::vector<std::string>& outputs) {
  onnx::NodeProto& node = *graph_.add_node();
  node.set_op_type(operation);
  for (const std::string& name : inputs) node.add_input(name);
  for (const std::string& name : outputs) node.add_output(name);
  for (const std::string& name : outputs) {
    if (node.name().empty()) node.set_name(name);
  }
  return node;
}

void set_attribute(onnx::NodeProto& node, const std::string& name, std::int64_t value) {
  new_attribute(node, name, onnx::AttributeProto::INT).set_i(value);
}

void set_attribute(onnx::NodeProto& node, const std::string& name, const OnnxShape& values) {
  onnx::AttributeProto& attribute = new_attribute(node, name, onnx::AttributeProto::INTS);
  attribute.mutable_ints()->Add(values.begin(), values.end());
}

onnx::GraphProto& set_graph_attribute(onnx::NodeProto& node, const std::string& name) {
  onnx::GraphProto& graph = *new_attribute(node, name, onnx::AttributeProto::GRAPH).mutable_g();
  graph.set_name(name);
  return graph;
}

}  // namespace tumblesight::sim
