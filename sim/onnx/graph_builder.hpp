// GraphBuilder: writes an ONNX graph node by node. A value is known by its name, a dense tensor of float32.
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

  // Each gives the name of the value that it makes; `description` becomes the doc string.
  std::string input(const std::string& name, const OnnxShape& shape, const std::string& description);
  std::string weights(const std::string& name, const OnnxShape& shape, const std::vector<float>& values);
  std::string reshape(const std::string& value, const OnnxShape& shape, const std::string& name);
  std::string flow(const std::string& operation, const std::vector<std::string>& inputs,
                   const std::string& name);

  // The value of that name leaves the graph.
  void output(const std::string& name, const OnnxShape& shape, const std::string& description);

  // For all else that a node may have; it is named after its first output.
  onnx::NodeProto& node(const std::string& operation, const std::vector<std::string>& inputs,
                        const std::vector<std::string>& outputs);

 private:
  onnx::GraphProto& graph_;
};

void set_attribute(onnx::NodeProto& node, const std::string& name, std::int64_t value);
void set_attribute(onnx::NodeProto& node, const std::string& name, const OnnxShape& values);

}  // namespace tumblesight::sim
