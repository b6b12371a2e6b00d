#include "sim/recording/step_samples.hpp"

#include <algorithm>
#include <iterator>

namespace tumblesight::sim {

void fill(hal::dds::LidarFrameSample& sample, const StepOfRun& step, const gnc::RangeImage& frame) {
  sample.run_id = step.run_id;
  sample.k = step.k;
  sample.sequence_number = frame.sequence_number;
  sample.exposure_time_ns = frame.exposure_time_ns;
  sample.fov_urad = frame.fov_urad;
  sample.rays = frame.rays;
  std::copy(frame.ranges.begin(), frame.ranges.end(), sample.ranges);
}

gnc::RangeImage frame_of(const hal::dds::LidarFrameSample& sample) {
  gnc::RangeImage frame{};
  frame.rays = sample.rays;
  frame.fov_urad = sample.fov_urad;
  frame.sequence_number = sample.sequence_number;
  frame.exposure_time_ns = sample.exposure_time_ns;
  std::copy(std::begin(sample.ranges), std::end(sample.ranges), frame.ranges.begin());
  return frame;
}

hal::dds::NavigationSample navigation_sample(const StepOfRun& step, const gnc::ChaserAttitude& attitude) {
  hal::dds::NavigationSample sample{};
  sample.run_id = step.run_id;
  sample.k = step.k;
  sample.time_ns = attitude.time_ns;
  std::copy(attitude.q_inertial_lrf.begin(), attitude.q_inertial_lrf.end(), sample.q_inertial_lrf);
  sample.valid = attitude.valid ? 1 : 0;
  return sample;
}

gnc::ChaserAttitude attitude_of(const hal::dds::NavigationSample& sample) {
  gnc::ChaserAttitude attitude;
  attitude.time_ns = sample.time_ns;
  std::copy(std::begin(sample.q_inertial_lrf), std::end(sample.q_inertial_lrf),
            attitude.q_inertial_lrf.begin());
  attitude.valid = sample.valid != 0;
  return attitude;
}

hal::dds::CommandSample command_sample(const StepOfRun& step, const hal::CommandPacket& packet) {
  hal::dds::CommandSample sample{};
  sample.run_id = step.run_id;
  sample.k = step.k;
  sample.size = packet.size;
  std::copy(packet.bytes.begin(), packet.bytes.end(), sample.bytes);
  return sample;
}

hal::CommandPacket packet_of(const hal::dds::CommandSample& sample) {
  hal::CommandPacket packet;
  packet.size = sample.size;
  std::copy(std::begin(sample.bytes), std::end(sample.bytes), packet.bytes.begin());
  return packet;
}

hal::dds::TruthSample truth_sample(const StepOfRun& step, std::uint32_t sequence, std::uint32_t frame,
                                   const FrameTruth& truth, std::int64_t time_ns) {
  hal::dds::TruthSample sample{};
  sample.run_id = step.run_id;
  sample.k = step.k;
  sample.time_ns = time_ns;
  sample.sequence_index = sequence;
  sample.frame_index = frame;
  const Eigen::Quaternionf q = truth.q_lrf_trf.cast<float>();
  const float scalar_first[] = {q.w(), q.x(), q.y(), q.z()};
  std::copy(std::begin(scalar_first), std::end(scalar_first), sample.q_lrf_trf);
  for (int i = 0; i < 3; ++i) sample.rate_lrf_rad_s[i] = static_cast<float>(truth.rate_lrf_rad_s[i]);
  sample.range_m = static_cast<float>(truth.range_m);
  return sample;
}

FrameTruth frame_truth_of(const hal::dds::TruthSample& sample) {
  FrameTruth truth{};
  const float* const q = sample.q_lrf_trf;
  const float* const rate = sample.rate_lrf_rad_s;
  truth.q_lrf_trf = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  truth.rate_lrf_rad_s = Eigen::Vector3d(rate[0], rate[1], rate[2]);
  truth.range_m = sample.range_m;
  return truth;
}

}  // namespace tumblesight::sim
