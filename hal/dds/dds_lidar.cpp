#include "hal/dds/dds_lidar.hpp"

#include <algorithm>
#include <iterator>

namespace tumblesight::hal::dds {

static_assert(tumblesight_icd_RANGES == gnc::RangeImage::kMaxReturns,
              "a frame of the wire definition fills a RangeImage");

void DdsLidar::put(const LidarFrameSample& sample) {
  const MailboxLock lock(mutex_);
  Entry& entry = waiting_.push();
  entry.wrong_size = sample.rays == 0 || sample.rays > gnc::RangeImage::kMaxRays;
  entry.frame.exposure_time_ns = sample.exposure_time_ns;
  entry.frame.sequence_number = sample.sequence_number;
  entry.frame.fov_urad = sample.fov_urad;
  entry.frame.rays = sample.rays;
  std::copy(std::begin(sample.ranges), std::end(sample.ranges), entry.frame.ranges.begin());
}

LidarStatus DdsLidar::receive(gnc::RangeImage& frame) {
  const MailboxLock lock(mutex_);
  const Entry* entry = waiting_.pop();
  if (entry == nullptr) return LidarStatus::kNoFrame;
  if (entry->wrong_size) return LidarStatus::kWrongSize;
  frame = entry->frame;
  return LidarStatus::kFrame;
}

std::uint32_t DdsLidar::take_dropped() {
  const MailboxLock lock(mutex_);
  return waiting_.take_dropped();
}

}  // namespace tumblesight::hal::dds
