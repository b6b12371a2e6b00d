#include "sim/console/console_target.hpp"

#include "gnc/rcnn/model_image.hpp"
#include "gnc/surface/surface_mesh.hpp"
#include "sim/console/little_endian.hpp"
#include "sim/model/model_file.hpp"

namespace tumblesight::sim {
namespace {

std::string mesh_of(const gnc::SurfaceMesh& mesh, double radius_m) {
  std::string bytes;
  if (!mesh.is_known()) return bytes;
  put_u32(bytes, static_cast<std::uint32_t>(mesh.vertices()));
  put_u32(bytes, static_cast<std::uint32_t>(mesh.triangles()));
  for (int i = 0; i < mesh.vertices(); ++i)
    for (const std::int16_t element : mesh.vertex(i))
      put_f32(bytes, static_cast<float>(radius_m * element / gnc::SurfaceMesh::kRadius));
  for (int i = 0; i < mesh.triangles(); ++i)
    for (const std::uint16_t corner : mesh.triangle(i)) put_u16(bytes, corner);
  return bytes;
}

}  // namespace

ConsoleTarget::ConsoleTarget(const std::string& model) {
  projection_ = read_fixed_point_header(model).projection;
  const std::vector<std::uint8_t> image = read_model_bytes(model);
  mesh_ = mesh_of(gnc::surface_mesh_of<gnc::FixedPoint>(image.data()), radius_m());
}

double ConsoleTarget::radius_m() const {
  return 1e-3 * projection_.target_radius_mm;
}

std::string ConsoleTarget::depth(const gnc::RangeImage& frame) const {
  const auto scratch = std::make_unique<gnc::DepthImageScratch>();
  const auto image = std::make_unique<gnc::DepthImage>();
  std::string bytes;
  if (gnc::make_depth_image(frame, projection_, *scratch, *image) != gnc::FrameStatus::kOk) return bytes;
  put_u16(bytes, gnc::DepthImage::kSide);
  put_u16(bytes, 0);
  for (const std::uint16_t depth : image->depth) {
    // 1/2 is at the centroid, and nearer is more.
    constexpr int kEmpty = -32768, kQ12 = 4096;
    const int farther_q12 = kQ12 - 2 * kQ12 * depth / gnc::DepthImage::kLargest;
    put_u16(bytes, static_cast<std::uint16_t>(depth == 0 ? kEmpty : farther_q12));
  }
  return bytes;
}

}  // namespace tumblesight::sim
