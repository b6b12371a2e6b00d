#include "sim/onnx/image_model.hpp"

#include <numeric>
#include <vector>

#include "sim/onnx/graph_builder.hpp"
#include "sim/onnx/new_model.hpp"
#include "sim/onnx/onnx_tensor.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kSide = gnc::DepthImage::kSide;
constexpr double kSmallest = gnc::DepthImage::kSmallest / 65536.0;

// The shortest rotation that takes +y to `direction` [1, 3]: [3, 3].
OnnxTensor rotation_of_y_to(const OnnxTensor& direction) {
  const auto part = [&direction](int i) { return slice(direction, 1, i, i + 1); };
  const OnnxTensor x = part(0), y = part(1), z = part(2), s = 1.0 / (1.0 + y);
  const OnnxTensor xz = -(s * x * z);
  return reshaped(joined({1.0 - s * x * x, x, xz, -x, y, -z, xz, z, 1.0 - s * z * z}, 1), {3, 3});
}

// For cells counted from the image's left or top [n, 1]: 1 at the cell, else 0 [n, kSide]. All 0 outside.
OnnxTensor marked(const OnnxTensor& cells) {
  std::vector<float> numbers(kSide);
  std::iota(numbers.begin(), numbers.end(), 0.0F);
  return as_number(
      operation("Equal", {operation("Floor", {cells}), constant_tensor(cells.graph(), {1, kSide}, numbers)}));
}

// Sum of the values [n, 1] in each cell: [kSide, kSide].
OnnxTensor summed(const OnnxTensor& values, const OnnxTensor& rows, const OnnxTensor& columns) {
  return product(operation("Transpose", {values * rows}), columns);
}

}  // namespace

std::string image_as_onnx(const gnc::ModelHeader& header) {
  onnx::ModelProto result = new_model(header, "image", "The step's depth image from the target's returns.");
  GraphBuilder graph(*result.mutable_graph());
  const OnnxTensor points(
      graph,
      graph.input("points_lrf_m", {kAnySize, 3},
                  "The target's returns as points in the LiDAR's frame: +x right, +y boresight, +z up. "
                  "In metres; 0, 0, 0 is no return."));
  const double cells_per_m = 1000.0 * kSide / header.projection.swath_mm;
  const double radius_m = 1e-3 * header.projection.target_radius_mm;

  const OnnxTensor is_return = as_number(sum(points * points, {1}) > 0.0);
  const OnnxTensor centroid = sum(points, {0}) / maximum(sum(is_return, {0}), 1.0);
  const OnnxTensor distance_m = operation("Sqrt", {sum(centroid * centroid, {1})});
  const OnnxTensor r_lrf_view = rotation_of_y_to(centroid / distance_m);

  const OnnxTensor points_view = product(points, r_lrf_view);
  const OnnxTensor columns = marked(kSide / 2 + cells_per_m * slice(points_view, 1, 0, 1));
  const OnnxTensor rows = marked(kSide / 2 - cells_per_m * slice(points_view, 1, 2, 3));
  const OnnxTensor nearer = clamped((distance_m - slice(points_view, 1, 1, 2)) / radius_m, -1.0, 1.0);
  const OnnxTensor returns = summed(is_return, rows, columns);
  const OnnxTensor mean = summed(is_return * (0.5 + 0.5 * nearer), rows, columns) / maximum(returns, 1.0);
  const OnnxTensor image = where(returns > 0.0, maximum(mean, kSmallest), 0.0);

  add_output(reshaped(image, {1, 1, kSide, kSide}), "image", {1, 1, kSide, kSide}, "For the step's image.");
  add_output(reshaped(r_lrf_view, {1, 3, 3}), "r_lrf_view", {1, 3, 3}, "For the step's r_lrf_view.");
  add_output(distance_m, "distance_m", {1, 1}, "Of the centroid of the returns.");
  return result.SerializeAsString();
}

}  // namespace tumblesight::sim
