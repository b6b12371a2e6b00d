#include "sim/onnx/onnx_tensor.hpp"

namespace tumblesight::sim {
namespace {

std::vector<std::string> names_of(const std::vector<OnnxTensor>& tensors) {
  std::vector<std::string> names;
  for (const OnnxTensor& tensor : tensors) names.push_back(tensor.name());
  return names;
}

// For setting attributes. `result` is set to the node's output.
onnx::NodeProto& add_node(const std::string& name, const std::vector<OnnxTensor>& inputs,
                          std::string& result) {
  GraphBuilder& graph = inputs.front().graph();
  result = graph.new_name(name);
  return graph.node(name, names_of(inputs), {result});
}

OnnxTensor with_attribute(const std::string& name, const std::vector<OnnxTensor>& inputs,
                          const std::string& attribute, std::int64_t value) {
  std::string result;
  set_attribute(add_node(name, inputs, result), attribute, value);
  return {inputs.front().graph(), result};
}

OnnxTensor with_attribute(const std::string& name, const std::vector<OnnxTensor>& inputs,
                          const std::string& attribute, const OnnxShape& values) {
  std::string result;
  set_attribute(add_node(name, inputs, result), attribute, values);
  return {inputs.front().graph(), result};
}

OnnxTensor integers(GraphBuilder& graph, const OnnxShape& values) {
  return constant_tensor(graph, {static_cast<std::int64_t>(values.size())}, values);
}

OnnxTensor scalar_like(const OnnxTensor& a, double value) {
  return scalar(a.graph(), value);
}

}  // namespace

template <class Number>
OnnxTensor constant_tensor(GraphBuilder& graph, const OnnxShape& shape, const std::vector<Number>& values) {
  return {graph, graph.weights(graph.new_name("constant"), shape, values)};
}
template OnnxTensor constant_tensor(GraphBuilder&, const OnnxShape&, const std::vector<float>&);
template OnnxTensor constant_tensor(GraphBuilder&, const OnnxShape&, const std::vector<std::int64_t>&);

OnnxTensor scalar(GraphBuilder& graph, double value) {
  return constant_tensor<float>(graph, {}, {static_cast<float>(value)});
}

void add_output(const OnnxTensor& value, const std::string& name, const OnnxShape& shape,
                const std::string& description) {
  value.graph().output(value.graph().flow("Identity", {value.name()}, name), shape, description);
}

OnnxTensor operation(const std::string& name, const std::vector<OnnxTensor>& inputs) {
  std::string result;
  add_node(name, inputs, result);
  return {inputs.front().graph(), result};
}

OnnxTensor operator+(const OnnxTensor& a, const OnnxTensor& b) {
  return operation("Add", {a, b});
}
OnnxTensor operator-(const OnnxTensor& a, const OnnxTensor& b) {
  return operation("Sub", {a, b});
}
OnnxTensor operator*(const OnnxTensor& a, const OnnxTensor& b) {
  return operation("Mul", {a, b});
}
OnnxTensor operator/(const OnnxTensor& a, const OnnxTensor& b) {
  return operation("Div", {a, b});
}
OnnxTensor operator+(double a, const OnnxTensor& b) {
  return scalar_like(b, a) + b;
}
OnnxTensor operator-(double a, const OnnxTensor& b) {
  return scalar_like(b, a) - b;
}
OnnxTensor operator*(double a, const OnnxTensor& b) {
  return scalar_like(b, a) * b;
}
OnnxTensor operator/(double a, const OnnxTensor& b) {
  return scalar_like(b, a) / b;
}
OnnxTensor operator-(const OnnxTensor& a, double b) {
  return a - scalar_like(a, b);
}
OnnxTensor operator/(const OnnxTensor& a, double b) {
  return a / scalar_like(a, b);
}
OnnxTensor operator-(const OnnxTensor& a) {
  return operation("Neg", {a});
}
OnnxTensor minimum(const OnnxTensor& a, double b) {
  return operation("Min", {a, scalar_like(a, b)});
}
OnnxTensor maximum(const OnnxTensor& a, double b) {
  return operation("Max", {a, scalar_like(a, b)});
}
OnnxTensor clamped(const OnnxTensor& a, double lowest, double highest) {
  return operation("Clip", {a, scalar_like(a, lowest), scalar_like(a, highest)});
}

OnnxTensor operator<(const OnnxTensor& a, double b) {
  return operation("Less", {a, scalar_like(a, b)});
}
OnnxTensor operator>(const OnnxTensor& a, double b) {
  return operation("Greater", {a, scalar_like(a, b)});
}
OnnxTensor operator&(const OnnxTensor& a, const OnnxTensor& b) {
  return operation("And", {a, b});
}
OnnxTensor operator!(const OnnxTensor& a) {
  return operation("Not", {a});
}
OnnxTensor where(const OnnxTensor& condition, const OnnxTensor& yes, const OnnxTensor& no) {
  return operation("Where", {condition, yes, no});
}
OnnxTensor where(const OnnxTensor& condition, const OnnxTensor& yes, double no) {
  return where(condition, yes, scalar_like(yes, no));
}
OnnxTensor where(const OnnxTensor& condition, double yes, const OnnxTensor& no) {
  return where(condition, scalar_like(no, yes), no);
}
OnnxTensor as_number(const OnnxTensor& condition) {
  return with_attribute("Cast", {condition}, "to", onnx::TensorProto::FLOAT);
}
OnnxTensor as_integer(const OnnxTensor& a) {
  return with_attribute("Cast", {a}, "to", onnx::TensorProto::INT64);
}

OnnxTensor product(const OnnxTensor& a, const OnnxTensor& b) {
  return operation("MatMul", {a, b});
}
OnnxTensor transposed(const OnnxTensor& a) {
  return with_attribute("Transpose", {a}, "perm", OnnxShape{0, 2, 1});
}

OnnxTensor sum(const OnnxTensor& a, const OnnxShape& axes) {
  return operation("ReduceSum", {a, integers(a.graph(), axes)});
}
OnnxTensor largest(const OnnxTensor& a, std::int64_t axis) {
  return with_attribute("ReduceMax", {a}, "axes", OnnxShape{axis});
}
OnnxTensor index_of_largest(const OnnxTensor& a, std::int64_t axis) {
  return with_attribute("ArgMax", {a}, "axis", axis);
}
OnnxTensor softmax(const OnnxTensor& a, std::int64_t axis) {
  return with_attribute("Softmax", {a}, "axis", axis);
}

OnnxTensor reshaped(const OnnxTensor& a, const OnnxShape& shape) {
  return operation("Reshape", {a, integers(a.graph(), shape)});
}
OnnxTensor expanded(const OnnxTensor& a, const OnnxShape& shape) {
  return operation("Expand", {a, integers(a.graph(), shape)});
}
OnnxTensor slice(const OnnxTensor& a, std::int64_t axis, std::int64_t first, std::int64_t end) {
  GraphBuilder& graph = a.graph();
  return operation("Slice", {a, integers(graph, {first}), integers(graph, {end}), integers(graph, {axis})});
}
OnnxTensor joined(const std::vector<OnnxTensor>& parts, std::int64_t axis) {
  return with_attribute("Concat", parts, "axis", axis);
}
OnnxTensor picked(const OnnxTensor& a, const OnnxTensor& index, std::int64_t axis) {
  return with_attribute("Gather", {a, reshaped(index, {1})}, "axis", axis);
}

OnnxTensor repeated(const OnnxTensor& times, const OnnxTensor& value, const OnnxShape& shape,
                    const std::function<OnnxTensor(const OnnxTensor&)>& step) {
  GraphBuilder& around = value.graph();
  const std::string result = around.new_name("Loop");
  const std::string no_condition;  // it runs `times` times
  onnx::NodeProto& node =
      around.node("Loop", {reshaped(times, {1}).name(), no_condition, value.name()}, {result});
  GraphBuilder body(set_graph_attribute(node, "body"), result + ".");
  body.input(body.new_name("iteration"), {}, "", onnx::TensorProto::INT64);
  const std::string goes_on = body.input(body.new_name("goes_on"), {}, "", onnx::TensorProto::BOOL);
  const OnnxTensor before(body, body.input(body.new_name("before"), shape, ""));
  const OnnxTensor after = step(before);
  body.output(body.flow("Identity", {goes_on}, body.new_name("Identity")), {}, "", onnx::TensorProto::BOOL);
  body.output(after.name(), shape, "");
  return reshaped({around, result}, shape);  // tools do not derive the shape of what a loop gives
}

}  // namespace tumblesight::sim
