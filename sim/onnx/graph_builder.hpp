// GraphBuilder: writes an ONNX graph node by node. A value is a tensor, identified by its name.
#pragma once

#include <onnx/onnx_pb.h>

#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

using OnnxShape = std::vector<std::int64_t>;
inline constexpr std::int64_t kAnySize = -1;  // in the shape of an input: known at run time only

class GraphBuilder {
 public:
  // `prefix` begins the names that the builder makes. The graph inside a node needs one, since its names must
  // differ from those around it.
  explicit GraphBuilder(onnx::GraphProto& graph, const std::string& prefix = "")
      : graph_(graph), prefix_(prefix) {}

  // Each returns the name of the new value. `description` becomes the doc string.
  std::string input(const std::string& name, const OnnxShape& shape, const std::string& description,
                    onnx::TensorProto::DataType type = onnx::TensorProto::FLOAT);
  // Number: float, std::int8_t, std::uint8_t, std::int32_t or std::int64_t. Throws std::logic_error if the
  // number of values does not match the shape.
  template <class Number>
  std::string weights(const std::string& name, const OnnxShape& shape, const std::vector<Number>& values);
  std::string reshape(const std::string& value, const OnnxShape& shape, const std::string& name);
  // A node with one output and no attributes.
  std::string flow(const std::string& operation, const std::vector<std::string>& inputs,
                   const std::string& name);
  // A name that no other value of the graph has.
  std::string new_name(const std::string& operation);

  // Makes an existing value an output of the graph.
  void output(const std::string& name, const OnnxShape& shape, const std::string& description,
              onnx::TensorProto::DataType type = onnx::TensorProto::FLOAT);

  // A node with any inputs and outputs, for setting attributes. It is named after its first named output.
  onnx::NodeProto& node(const std::string& operation, const std::vector<std::string>& inputs,
                        const std::vector<std::string>& outputs);

 private:
  onnx::GraphProto& graph_;
  std::string prefix_;
  int names_ = 0;
};

void set_attribute(onnx::NodeProto& node, const std::string& name, std::int64_t value);
void set_attribute(onnx::NodeProto& node, const std::string& name, const OnnxShape& values);
// An empty graph inside the node, to be filled.
onnx::GraphProto& set_graph_attribute(onnx::NodeProto& node, const std::string& name);

}  // namespace tumblesight::sim
