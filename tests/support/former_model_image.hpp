// A fixed-point model image as an earlier format version had it, for tests of what still reads those.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "gnc/rcnn/model_format.hpp"

namespace tumblesight::gnc {

// `image`: of today's version. `version`: 3, without points and mesh of the surface, or 4, without the mesh.
inline std::vector<std::uint8_t> former_model_image(int version, std::vector<std::uint8_t> image) {
  using namespace model_format;
  const std::uint32_t sections = version == 3 ? 31 : 32;
  image.resize(image.size() - SurfaceMesh::kMaxBytes - (version == 3 ? SurfaceModel::kBytes : 0));
  put_u16(image.data() + kOffsetVersion, static_cast<std::uint16_t>(version));
  put_u32(image.data() + kOffsetTotalSize, static_cast<std::uint32_t>(image.size()));
  put_u32(image.data() + kOffsetSectionCount, sections);
  std::fill_n(image.data() + kModelHeaderSize + sections * kModelSectionEntrySize,
              (33 - sections) * kModelSectionEntrySize, std::uint8_t{0});
  put_u32(image.data() + kOffsetHeaderCrc, header_crc(image.data(), sections));
  return image;
}

}  // namespace tumblesight::gnc
