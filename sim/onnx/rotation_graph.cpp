#include "sim/onnx/rotation_graph.hpp"

#include <vector>

namespace tumblesight::sim {
namespace {

constexpr int kStepsPerPeriod = 4;  // of the midpoint method, as in gnc/attitude/motion.cpp
constexpr double kLargestElement = static_cast<double>(gnc::kLargestRate) * 0.577;  // of the turn of a step
// A time this little above a whole number of periods counts as that number, since seconds in float32 are
// rounded.
constexpr double kRoundingOfPeriods = 4e-5;

// x below this is raised to it before a division or a root.
constexpr double kSmallestSquare = 1e-12;

OnnxTensor length_of(const OnnxTensor& v) {
  return operation("Sqrt", {maximum(dot_product(v, v), kSmallestSquare)});
}

OnnxTensor normalized(const OnnxTensor& v) {
  return v / length_of(v);
}

OnnxTensor identity(GraphBuilder& graph) {
  return constant_tensor<float>(graph, {1, 3, 3}, {1, 0, 0, 0, 1, 0, 0, 0, 1});
}

// [v]x
OnnxTensor cross_matrix(const OnnxTensor& v) {
  const OnnxTensor elements = constant_tensor<float>(v.graph(), {1, 9, 3}, {0,  0,  0,   // row 0: 0, -z, y
                                                                            0,  0,  -1,  //
                                                                            0,  1,  0,   //
                                                                            0,  0,  1,   // row 1: z, 0, -x
                                                                            0,  0,  0,   //
                                                                            -1, 0,  0,   //
                                                                            0,  -1, 0,   // row 2: -y, x, 0
                                                                            1,  0,  0,   //
                                                                            0,  0,  0});
  return reshaped(product(elements, v), {-1, 3, 3});
}

// 1 - cos(angle) of a rotation.
OnnxTensor versine_of(const OnnxTensor& rotation) {
  return 0.5 * (3.0 - trace_of_transpose_product(rotation, identity(rotation.graph())));
}

// angle / sin(angle) as a power series in y = 1 - cos(angle).
OnnxTensor angle_over_sine(const OnnxTensor& y) {
  OnnxTensor f = 1.0 + (8.0 / 17.0) * y;
  for (int n = 7; n >= 1; --n) f = 1.0 + (n / (2.0 * n + 1.0)) * y * f;
  return f;
}

template <class Member>
OnnxTensor matrices(GraphBuilder& graph, const gnc::MotionModels<float>& motion_models, Member member) {
  std::vector<float> elements;
  for (const gnc::Inertia<float>& motion_model : motion_models) {
    for (int i = 0; i < 9; ++i) elements.push_back((motion_model.*member)(i / 3, i % 3));
  }
  return constant_tensor(graph, {gnc::kMotionModels, 3, 3}, elements);
}

// Angular rate of bodies with these inverse inertias and the angular momentum `momentum_lrf`.
OnnxTensor rate_from_momentum(const OnnxTensor& r_lrf_trf, const OnnxTensor& momentum_lrf,
                              const OnnxTensor& inverse_trf) {
  const OnnxTensor momentum_trf = product(transposed(r_lrf_trf), momentum_lrf);
  return product(r_lrf_trf, product(inverse_trf, momentum_trf));
}

}  // namespace

OnnxTensor dot_product(const OnnxTensor& a, const OnnxTensor& b) {
  return sum(a * b, {1});
}

OnnxTensor trace_of_transpose_product(const OnnxTensor& a, const OnnxTensor& b) {
  return sum(a * b, {1, 2});
}

OnnxTensor rotation_from_columns(const OnnxTensor& a, const OnnxTensor& b) {
  const OnnxTensor first = normalized(a);
  const OnnxTensor second = normalized(b - dot_product(first, b) * first);
  return joined({first, second, product(cross_matrix(first), second)}, 2);
}

OnnxTensor two_columns(const OnnxTensor& rotation) {
  return reshaped(slice(transposed(rotation), 1, 0, 2), {1, -1});
}

OnnxTensor rotation_from_quaternion(const OnnxTensor& q) {
  // Nine elements from the sixteen products of two parts of q: ww, wx, wy, wz, xw, ...
  const OnnxTensor from_products = constant_tensor<float>(
      q.graph(), {1, 9, 16}, {1, 0,  0,  0,  0, 1,  0, 0, 0, 0, -1, 0, 0, 0, 0, -1,   // xx
                              0, 0,  0,  -2, 0, 0,  2, 0, 0, 0, 0,  0, 0, 0, 0, 0,    // xy
                              0, 0,  2,  0,  0, 0,  0, 2, 0, 0, 0,  0, 0, 0, 0, 0,    // xz
                              0, 0,  0,  2,  0, 0,  2, 0, 0, 0, 0,  0, 0, 0, 0, 0,    // yx
                              1, 0,  0,  0,  0, -1, 0, 0, 0, 0, 1,  0, 0, 0, 0, -1,   // yy
                              0, -2, 0,  0,  0, 0,  0, 0, 0, 0, 0,  2, 0, 0, 0, 0,    // yz
                              0, 0,  -2, 0,  0, 0,  0, 2, 0, 0, 0,  0, 0, 0, 0, 0,    // zx
                              0, 2,  0,  0,  0, 0,  0, 0, 0, 0, 0,  2, 0, 0, 0, 0,    // zy
                              1, 0,  0,  0,  0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1});  // zz
  const OnnxTensor products = product(reshaped(q, {-1, 4, 1}), reshaped(q, {-1, 1, 4}));
  return reshaped(product(from_products, reshaped(products, {-1, 16, 1})), {-1, 3, 3});
}

// As gnc::quaternion_from_rotation(): row k of `candidates` is 4 q_k q, and the one with the largest q_k is
// taken.
OnnxTensor quaternion_from_rotation(const OnnxTensor& rotation) {
  GraphBuilder& graph = rotation.graph();
  const OnnxTensor from_elements =
      constant_tensor<float>(graph, {1, 16, 9}, {1,  0,  0, 0, 1,  0,  0,  0, 1,    // ww
                                                 0,  0,  0, 0, 0,  -1, 0,  1, 0,    // wx
                                                 0,  0,  1, 0, 0,  0,  -1, 0, 0,    // wy
                                                 0,  -1, 0, 1, 0,  0,  0,  0, 0,    // wz
                                                 0,  0,  0, 0, 0,  -1, 0,  1, 0,    // xw
                                                 1,  0,  0, 0, -1, 0,  0,  0, -1,   // xx
                                                 0,  1,  0, 1, 0,  0,  0,  0, 0,    // xy
                                                 0,  0,  1, 0, 0,  0,  1,  0, 0,    // xz
                                                 0,  0,  1, 0, 0,  0,  -1, 0, 0,    // yw
                                                 0,  1,  0, 1, 0,  0,  0,  0, 0,    // yx
                                                 -1, 0,  0, 0, 1,  0,  0,  0, -1,   // yy
                                                 0,  0,  0, 0, 0,  1,  0,  1, 0,    // yz
                                                 0,  -1, 0, 1, 0,  0,  0,  0, 0,    // zw
                                                 0,  0,  1, 0, 0,  0,  1,  0, 0,    // zx
                                                 0,  0,  0, 0, 0,  1,  0,  1, 0,    // zy
                                                 -1, 0,  0, 0, -1, 0,  0,  0, 1});  // zz
  const OnnxTensor one =
      constant_tensor<float>(graph, {1, 4, 4}, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  const OnnxTensor candidates =
      reshaped(product(from_elements, reshaped(rotation, {-1, 9, 1})), {-1, 4, 4}) + one;
  const OnnxTensor best = index_of_largest(sum(candidates * one, {2}), 1);
  const OnnxTensor places = constant_tensor<std::int64_t>(graph, {1, 1, 4}, {0, 1, 2, 3});
  const OnnxTensor is_best = as_number(operation("Equal", {best, places}));
  const OnnxTensor q = normalized(transposed(product(is_best, candidates)));  // [K, 4, 1]
  return reshaped(where(slice(q, 1, 0, 1) < 0.0, -q, q), {-1, 4});
}

OnnxTensor rotation_by(const OnnxTensor& turn) {
  const OnnxTensor angle = length_of(turn);
  const OnnxTensor half_sine = operation("Sin", {0.5 * angle}) / angle;
  return operation("Cos", {angle}) * identity(turn.graph()) +
         operation("Sin", {angle}) / angle * cross_matrix(turn) +
         2.0 * half_sine * half_sine * product(turn, transposed(turn));
}

OnnxTensor rotation_vector(const OnnxTensor& rotation, const OnnxTensor& largest_versine) {
  const OnnxTensor q = reshaped(quaternion_from_rotation(rotation), {-1, 4, 1});
  const OnnxTensor turn = 2.0 * angle_over_sine(1.0 - slice(q, 1, 0, 1)) * slice(q, 1, 1, 4);
  return where(operation("Less", {versine_of(rotation), largest_versine}), turn, 0.0);
}

MotionGraph where(const OnnxTensor& condition, const MotionGraph& yes, const MotionGraph& no) {
  return {where(condition, yes.r_lrf_trf, no.r_lrf_trf), where(condition, yes.rate_lrf, no.rate_lrf)};
}

MotionGraph turned(const MotionGraph& motion, const OnnxTensor& r_now_last) {
  return {product(r_now_last, motion.r_lrf_trf), product(r_now_last, motion.rate_lrf)};
}

MotionGraph propagated(const MotionGraph& motion, const gnc::MotionModels<float>& motion_models,
                       const OnnxTensor& periods) {
  GraphBuilder& graph = periods.graph();
  const OnnxTensor tensor_trf = matrices(graph, motion_models, &gnc::Inertia<float>::tensor_trf);
  const OnnxTensor inverse_trf = matrices(graph, motion_models, &gnc::Inertia<float>::inverse_trf);
  const OnnxTensor parts = maximum(operation("Ceil", {periods - kRoundingOfPeriods}), 1.0);
  const OnnxTensor steps = kStepsPerPeriod * parts;
  const OnnxTensor step = periods / steps;
  // The rate limited to kLargestRate.
  const double most = gnc::kLargestRate;
  const OnnxTensor rate = minimum(most / length_of(motion.rate_lrf), 1.0) * motion.rate_lrf;
  const OnnxTensor momentum_lrf =
      product(motion.r_lrf_trf, product(tensor_trf, product(transposed(motion.r_lrf_trf), rate)));
  const auto midpoint_step = [&](const OnnxTensor& r) {
    const auto turned_at = [&](const OnnxTensor& r_at, double part) {
      const OnnxTensor rate_at = rate_from_momentum(r_at, seen_by(r, momentum_lrf), seen_by(r, inverse_trf));
      const OnnxTensor turn = part * rate_at * seen_by(r, step);
      return product(rotation_by(clamped(turn, -kLargestElement, kLargestElement)), r);
    };
    return turned_at(turned_at(r, 0.5), 1.0);
  };
  const OnnxTensor r =
      repeated(as_integer(steps), motion.r_lrf_trf, {gnc::kMotionModels, 3, 3}, midpoint_step);
  return {r, rate_from_momentum(r, momentum_lrf, inverse_trf)};
}

}  // namespace tumblesight::sim
