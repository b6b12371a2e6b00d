// GraphBuilder: writes an ONNX graph node by node. A value is a tensor, identified by its name.
#pragma once

#include <onnx/onnx_pb.h>

#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

using OnnxShape = std::vector<std::int64_t>;

class GraphBuilder {
 public:
  explicit GraphBuilder(onnx::GraphProto& graph) : graph_(graph) {}

  // Each returns the name of the new value. `description` becomes the doc string.
  std::string input(const std::string& name, const OnnxShape& shape, const std::string& description,
                    onnx::TensorProto::DataType type = onnx::TensorProto::FLOAT);
  // Number: float, std::int8_t, std::uint8_t or std::int32_t. Throws std::logic_error if the number of values
  // does not match the shape.
  template <class Number>
  std::string weights(const std::string& name, const OnnxShape& shape, const std::vector<Number>& values);
  std::string reshape(const std::string& value, const OnnxShape& shape, const std::string& name);
  // A node with one output and no attributes.
  std::string flow(const std::string& operation, const std::vector<std::string>& inputs,
                   const std::string& name);

  // Makes an existing value, in float32, an output of the graph.
  void output(const std::string& name, const OnnxShape& shape, const std::string& description);

  // A node with any inputs and outputs, for setting attributes. It is named after its first named output.
  onnx::NodeProto& node(const std::string& operation, const std::vector<std::string>& inputs,
                        const std::vector<std::string>& outputs);

 private:
  onnx::GraphProto& graph_;
};

void set_attribute(onnx::NodeProto& node, const std::string& name, std::int64_t value);
void set_attribute(onnx::NodeProto& node, const std::string& name, const OnnxShape& values);

}  // namespace tumblesight::sim
