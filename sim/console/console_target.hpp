// ConsoleTarget: what the console draws of a target: its surface, and the frames as its network sees them.
// Out of the model image that flies.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/lidar/range_image.hpp"

namespace tumblesight::sim {

class ConsoleTarget {
 public:
  // `model`: path of an image in fixed point. Throws std::runtime_error that names it if it cannot be used.
  explicit ConsoleTarget(const std::string& model);

  double radius_m() const;
  // As /api/mesh gives it (docs/console.md). Empty: the image has no surface.
  const std::string& mesh() const { return mesh_; }
  // As /api/depth gives it. Empty: the network sees no target in the frame.
  std::string depth(const gnc::RangeImage& frame) const;

 private:
  gnc::DepthProjection projection_;
  std::string mesh_;
};

}  // namespace tumblesight::sim
