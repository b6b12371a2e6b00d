// The algebra of gnc/attitude (rotation.hpp, motion.hpp) in ONNX. Shapes: rotation matrices [K, 3, 3],
// vectors [K, 3, 1], scalars [K, 1, 1], quaternions [K, 4], scalar first.
#pragma once

#include "gnc/attitude/motion.hpp"
#include "sim/onnx/onnx_tensor.hpp"

namespace tumblesight::sim {

OnnxTensor dot_product(const OnnxTensor& a, const OnnxTensor& b);
// trace(a^T b)
OnnxTensor trace_of_transpose_product(const OnnxTensor& a, const OnnxTensor& b);
// Gram-Schmidt orthonormalization; the third column is their cross product.
OnnxTensor rotation_from_columns(const OnnxTensor& a, const OnnxTensor& b);
// The first column, then the second: [1, 6 K].
OnnxTensor two_columns(const OnnxTensor& rotation);

OnnxTensor rotation_from_quaternion(const OnnxTensor& q);
OnnxTensor quaternion_from_rotation(const OnnxTensor& rotation);  // unit, w >= 0

// Rotation by the vector `turn` [rad].
OnnxTensor rotation_by(const OnnxTensor& turn);
// gnc::rotation_vector(): zero for angles whose versine is not below `largest_versine`.
OnnxTensor rotation_vector(const OnnxTensor& rotation, const OnnxTensor& largest_versine);

struct MotionGraph {
  OnnxTensor r_lrf_trf;  // [K, 3, 3]
  OnnxTensor rate_lrf;   // [K, 3, 1], rad per nominal period
};
// For a condition [1, 1, 1].
MotionGraph where(const OnnxTensor& condition, const MotionGraph& yes, const MotionGraph& no);
// gnc::turned()
MotionGraph turned(const MotionGraph& motion, const OnnxTensor& r_now_last);
// gnc::propagate() of each motion model's motion (K = gnc::kMotionModels), over `periods` [1, 1, 1], nominal
// periods.
MotionGraph propagated(const MotionGraph& motion, const gnc::MotionModels<float>& motion_models,
                       const OnnxTensor& periods);

}  // namespace tumblesight::sim
