// OnnxTensor: a value of an ONNX graph. Operators and functions of tensors add nodes to the graph, so that
// algebra reads as such. Shapes follow ONNX's rules of broadcasting.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/onnx/graph_builder.hpp"

namespace tumblesight::sim {

class OnnxTensor {
 public:
  // An existing value of the graph. The graph must outlive the tensor.
  OnnxTensor(GraphBuilder& graph, std::string name) : graph_(&graph), name_(std::move(name)) {}
  const std::string& name() const { return name_; }
  GraphBuilder& graph() const { return *graph_; }

 private:
  GraphBuilder* graph_;
  std::string name_;
};

// A new constant. Number: float or std::int64_t.
template <class Number>
OnnxTensor constant_tensor(GraphBuilder& graph, const OnnxShape& shape, const std::vector<Number>& values);
OnnxTensor scalar(GraphBuilder& graph, double value);

// Makes a value an output of its graph, under this name.
void add_output(const OnnxTensor& value, const std::string& name, const OnnxShape& shape,
                const std::string& description);

// Any operation without attributes. The node goes into the graph of the first input.
OnnxTensor operation(const std::string& name, const std::vector<OnnxTensor>& inputs);

// Element by element.
OnnxTensor operator+(const OnnxTensor& a, const OnnxTensor& b);
OnnxTensor operator-(const OnnxTensor& a, const OnnxTensor& b);
OnnxTensor operator*(const OnnxTensor& a, const OnnxTensor& b);
OnnxTensor operator/(const OnnxTensor& a, const OnnxTensor& b);
OnnxTensor operator+(double a, const OnnxTensor& b);
OnnxTensor operator-(double a, const OnnxTensor& b);
OnnxTensor operator*(double a, const OnnxTensor& b);
OnnxTensor operator/(double a, const OnnxTensor& b);
OnnxTensor operator-(const OnnxTensor& a, double b);
OnnxTensor operator/(const OnnxTensor& a, double b);
OnnxTensor operator-(const OnnxTensor& a);
OnnxTensor minimum(const OnnxTensor& a, double b);
OnnxTensor maximum(const OnnxTensor& a, double b);
OnnxTensor clamped(const OnnxTensor& a, double lowest, double highest);

// Truth values.
OnnxTensor operator<(const OnnxTensor& a, double b);
OnnxTensor operator>(const OnnxTensor& a, double b);
OnnxTensor operator&(const OnnxTensor& a, const OnnxTensor& b);
OnnxTensor operator!(const OnnxTensor& a);
OnnxTensor where(const OnnxTensor& condition, const OnnxTensor& yes, const OnnxTensor& no);
OnnxTensor where(const OnnxTensor& condition, const OnnxTensor& yes, double no);
OnnxTensor where(const OnnxTensor& condition, double yes, const OnnxTensor& no);
OnnxTensor as_number(const OnnxTensor& condition);  // 1 or 0
OnnxTensor as_integer(const OnnxTensor& a);         // int64

// Products of matrices: the last two dimensions. transposed() takes tensors [K, rows, columns].
OnnxTensor product(const OnnxTensor& a, const OnnxTensor& b);
OnnxTensor transposed(const OnnxTensor& a);

// Sums and maxima keep the dimensions, with the size 1.
OnnxTensor sum(const OnnxTensor& a, const OnnxShape& axes);
OnnxTensor largest(const OnnxTensor& a, std::int64_t axis);
// Index of the largest value, the first if several are equal: int64, with the size 1 along `axis`.
OnnxTensor index_of_largest(const OnnxTensor& a, std::int64_t axis);
OnnxTensor softmax(const OnnxTensor& a, std::int64_t axis);

OnnxTensor reshaped(const OnnxTensor& a, const OnnxShape& shape);
OnnxTensor expanded(const OnnxTensor& a, const OnnxShape& shape);
OnnxTensor slice(const OnnxTensor& a, std::int64_t axis, std::int64_t first, std::int64_t end);
OnnxTensor joined(const std::vector<OnnxTensor>& parts, std::int64_t axis);
// The entry along `axis`, which keeps the size 1. `index`: one value of int64, of any shape.
OnnxTensor picked(const OnnxTensor& a, const OnnxTensor& index, std::int64_t axis);

// value = step(value), `times` times. `times`: one value of int64. `step` adds its nodes to the graph of its
// argument; it reads a tensor of the surrounding graph through seen_by().
OnnxTensor repeated(const OnnxTensor& times, const OnnxTensor& value, const OnnxShape& shape,
                    const std::function<OnnxTensor(const OnnxTensor&)>& step);
// `outer` as a tensor of the graph of `inner`.
inline OnnxTensor seen_by(const OnnxTensor& inner, const OnnxTensor& outer) {
  return {inner.graph(), outer.name()};
}

}  // namespace tumblesight::sim
