#include "gnc/registration/pose_history.hpp"

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kOverstated = 4;
constexpr std::int64_t kMostInformation = std::int64_t{1'313'000} * 16;  // (0.05 deg)^-2, Q4

// No element of a turned information is larger: 3 kMostInformation. Damaged ones are limited to it.
constexpr std::int64_t kMostTurned = std::int64_t{1} << 26;

using Block = std::array<std::array<std::int64_t, 3>, 3>;

// r block r^T.
Block turned(const Matrix3<Fixed>& r, const Block& block) {
  Block half{}, result{};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        half[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] +=
            (r(i, l).raw() * block[static_cast<std::size_t>(l)][static_cast<std::size_t>(k)]) >> 12;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        result[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] +=
            (half[static_cast<std::size_t>(i)][static_cast<std::size_t>(l)] * r(k, l).raw()) >> 12;
  for (auto& row : result)
    for (std::int64_t& value : row) value = (value + (1 << 23)) >> 24;
  return result;
}

void turn_information(const Matrix3<Fixed>& r, std::array<std::int32_t, kElements>& information) {
  for (int row = 0; row < kUnknowns; row += 3) {
    for (int column = 0; column <= row; column += 3) {
      Block block{};
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          block[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = clamp<std::int64_t>(
              information[symmetric_element(row + i, column + k)], -kMostTurned, kMostTurned);
      const Block result = turned(r, block);
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          if (row + i >= column + k)
            information[element(row + i, column + k)] = static_cast<std::int32_t>(clamp<std::int64_t>(
                result[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)], -(1 << 30), 1 << 30));
    }
  }
}

void turn(const Matrix3<Fixed>& r, Pose& pose) {
  pose.r_lrf_trf = product<Fixed>(r, pose.r_lrf_trf);
  pose.r_lrf_trf = rotation_from_columns<Fixed>(
      orthonormalize<Fixed>(Vector3<Fixed>(pose.r_lrf_trf.col(0)), Vector3<Fixed>(pose.r_lrf_trf.col(1))));
  pose.origin_lrf_um = turned_um(r, pose.origin_lrf_um);
}

}  // namespace

std::array<std::int32_t, 3> turned_um(const Matrix3<Fixed>& r, const std::array<std::int32_t, 3>& vector_um) {
  std::array<std::int32_t, 3> result{};
  for (int i = 0; i < 3; ++i) {
    std::int64_t sum = std::int64_t{1} << 23;
    for (int k = 0; k < 3; ++k) sum += std::int64_t{r(i, k).raw()} * vector_um[static_cast<std::size_t>(k)];
    constexpr std::int64_t kMost = 2'000'000'000;
    result[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(clamp(sum >> 24, -kMost, kMost));
  }
  return result;
}

PoseMeasurement measured_pose(const Pose& pose, const NormalEquations& equations) {
  PoseMeasurement measurement;
  measurement.pose = pose;
  std::int64_t largest = 1;
  for (int i = 0; i < kUnknowns; ++i) largest = max(largest, equations.information[element(i, i)] >> 8);
  largest = divide(largest, kOverstated);
  // More than the limit in the best known direction: all of it counts less.
  const std::int64_t share_q16 =
      largest > kMostInformation ? divide(kMostInformation << 16, largest) : 1 << 16;
  for (std::size_t i = 0; i < measurement.information.size(); ++i)
    measurement.information[i] = static_cast<std::int32_t>(
        clamp<std::int64_t>((divide(equations.information[i] >> 8, kOverstated) * share_q16) >> 16,
                            -kMostInformation, kMostInformation));
  for (int i = 0; i < kUnknowns; ++i) measurement.information[element(i, i)] += 16;
  return measurement;
}

void PoseHistory::add(const PoseMeasurement& measurement) {
  if (count == kMost) {
    for (std::size_t i = 0; i + 1 < kMost; ++i) poses[i] = poses[i + 1];
    --count;
  }
  poses[static_cast<std::size_t>(count++)] = measurement;
}

void PoseHistory::remove(std::uint32_t poses_to_forget) {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    if ((poses_to_forget >> i & 1U) != 0) continue;
    poses[static_cast<std::size_t>(kept++)] = poses[static_cast<std::size_t>(i)];
  }
  count = kept;
}

void PoseHistory::advance(std::int64_t elapsed_ns, const Matrix3<Fixed>& r_now_last) {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    PoseMeasurement& measurement = poses[static_cast<std::size_t>(i)];
    // Limited so that the sum does not overflow, whatever the time or a damaged age.
    measurement.age_ns = clamp<std::int64_t>(measurement.age_ns, 0, kOldest_ns) +
                         clamp<std::int64_t>(elapsed_ns, 0, kOldest_ns + 1);
    if (measurement.age_ns > kOldest_ns) continue;
    turn(r_now_last, measurement.pose);
    turn_information(r_now_last, measurement.information);
    poses[static_cast<std::size_t>(kept++)] = measurement;
  }
  count = kept;
}

}  // namespace tumblesight::gnc
