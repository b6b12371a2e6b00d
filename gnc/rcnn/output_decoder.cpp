#include "gnc/rcnn/output_decoder.hpp"

#include <cmath>

#include "gnc/attitude/rotation.hpp"
#include "gnc/nn/activation.hpp"

namespace tumblesight::gnc {

DecodedAttitude decode_output(const OutputVector& output) {
  constexpr float kPi = 3.14159265F;
  const float* logits = output.data() + shape::kColumns;
  int best = 0;
  for (int k = 1; k < shape::kHypotheses; ++k) best = logits[k] > logits[best] ? k : best;

  const float* six = output.data() + 6 * best;
  const Eigen::Matrix3f rotation =
      rotation_from_columns(orthonormalise({six[0], six[1], six[2]}, {six[3], six[4], six[5]}));
  // Adding up keeps every infinity and NaN; entries of a rotation cannot overflow.
  float sum = 0.0F;
  for (int i = 0; i < 9; ++i) sum += rotation(i / 3, i % 3);
  const float error_rad = kPi * sigmoid(output[shape::kColumns + shape::kHypotheses]);
  return {quaternion_from_rotation(rotation), std::isfinite(sum) ? error_rad : kPi};
}

}  // namespace tumblesight::gnc
