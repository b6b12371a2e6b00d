// Surface renderer: the target's surface as the sensor would see it at a pose, on the screen of a frame.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/rotation.hpp"
#include "gnc/registration/frame_view.hpp"
#include "gnc/registration/pose.hpp"
#include "gnc/registration/screen.hpp"
#include "gnc/registration/work_budget.hpp"
#include "gnc/surface/surface_mesh.hpp"

namespace tumblesight::gnc {

// Some of a mesh's triangles: a bit for each.
struct TriangleSet {
  static constexpr unsigned kPerWord = 32;
  static_assert(SurfaceMesh::kMaxTriangles % kPerWord == 0);
  std::array<std::uint32_t, SurfaceMesh::kMaxTriangles / kPerWord> words;

  void add(unsigned triangle) { words[triangle / kPerWord] |= 1U << (triangle % kPerWord); }
};

struct RenderedSurface {
  static constexpr std::int16_t kEmpty = -32768;
  int rays = 0;
  // False: a part was not drawn, since it is more than 128 rays from the middle of the screen or behind the
  // sensor, or since the work was more than the limit of a rendering, or than the budget.
  bool is_complete = true;
  bool has_dark = false;               // surfaces are dark (dark_surfaces.hpp)
  ScreenVertices* vertices = nullptr;  // of the mesh; memory that the caller lends
  alignas(8) std::array<std::int16_t, RangeImage::kMaxReturns> inverse_depth;
  RayMask filled;        // rays that are not kEmpty, and not dark
  RayMask dark;          // rays of dark surfaces
  TriangleSet covering;  // triangles that cover a ray, hidden or not

  // kEmpty outside the screen.
  std::int16_t at(int row, int column) const {
    if (row < 0 || column < 0 || row >= rays || column >= rays) return kEmpty;
    return inverse_depth[row * rays + column];
  }
  // False outside the screen.
  bool is_filled(int row, int column) const {
    return row >= 0 && column >= 0 && row < rays && column < rays && filled.has(row, column);
  }
};

// A point of the target in the axes of the LRF, from the TRF's origin, in units of 1/32767 radius.
using Arm = std::array<std::int32_t, 3>;

// Turns vertices in 32 bits: the rotation has 15 fraction bits.
class Turn {
 public:
  explicit Turn(const Matrix3<Fixed>& r_lrf_trf);
  // One element [radii]. A vertex is at most sqrt(3) long; of what is not a rotation, the element wraps.
  std::int32_t element_q30(std::size_t element, const SurfaceMesh::Vertex& v) const {
    const auto product = [&](std::size_t i) {
      return static_cast<std::uint32_t>(r_q15_[3 * element + i] * v[i]);
    };
    return static_cast<std::int32_t>(product(0) + product(1) + product(2));
  }
  // Within two units.
  Arm operator()(const SurfaceMesh::Vertex& v) const {
    const auto element = [&](std::size_t i) { return ((element_q30(i, v) >> 14) + 1) >> 1; };
    return {element(0), element(1), element(2)};
  }

 private:
  std::array<std::int32_t, 9> r_q15_{};
};

void render(const SurfaceMesh& mesh, const FrameView& view, const Pose& pose, RenderedSurface& surface,
            WorkBudget& budget);

}  // namespace tumblesight::gnc
