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

hal::dds::NavigationSample navigation_sample(const StepOfRun& step, const gnc::ChaserAttitude& attitude) {
  hal::dds::NavigationSample sample{};
  sample.run_id = step.run_id;
  sample.k = step.k;
  sample.time_ns = attitude.time_ns;
  std::copy(attitude.q_inertial_lrf.begin(), attitude.q_inertial_lrf.end(), sample.q_inertial_lrf);
  sample.valid = attitude.valid ? 1 : 0;
  return sample;
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

}  // namespace tumblesight::sim
