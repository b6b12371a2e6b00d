#include "gnc/lidar/depth_loops/plain.hpp"
#include "gnc/lidar/depth_loops/sets.hpp"

namespace tumblesight::gnc::depth_loops {
namespace {

Survey survey(const RangeImage& frame) {
  return survey_of(frame);
}
void sum_depths(const RangeImage& frame, Rays& rays) {
  sum_all_depths(frame, rays);
}
void accumulate(const RangeImage& frame, const Rays& rays, const View& view, std::uint32_t* cells) {
  accumulate_all(frame, rays, view, cells);
}
void encode(const std::uint32_t* cells, std::uint16_t* depth) {
  encode_all(cells, depth);
}

}  // namespace

const DepthLoops kAvx512{InstructionSet::kAvx512, survey, sum_depths, accumulate, encode};

}  // namespace tumblesight::gnc::depth_loops
