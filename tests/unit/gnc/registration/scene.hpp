// Scenes for the tests of registration: small bodies, the section of a model image that describes them, and a
// ray caster in double precision, which shares no code with the renderer.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "gnc/registration/surface_renderer.hpp"

namespace tumblesight::gnc {

// Gives the same numbers on every platform for the same seed.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }
  int below(int limit) { return static_cast<int>(engine_() % static_cast<unsigned>(limit)); }
  bool happens(double probability) { return uniform(0.0, 1.0) < probability; }
  double normal() {  // Box and Muller
    return std::sqrt(-2.0 * std::log(uniform(1e-12, 1.0))) * std::cos(uniform(0.0, 2.0 * M_PI));
  }
  Eigen::Vector3d vector(double sigma) { return {sigma * normal(), sigma * normal(), sigma * normal()}; }
  Eigen::Matrix3d rotation() {
    // In braces, so that every compiler draws them in this order.
    return Eigen::Quaterniond{normal(), normal(), normal(), normal()}.normalized().toRotationMatrix();
  }

 private:
  std::mt19937 engine_;
};

// Triangles with their corners in metres, in the TRF. No corner is farther from the origin than the radius.
struct Body {
  double radius_m = 1.0;
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::array<int, 3>> triangles;

  // With two triangles a side, counterclockwise as seen from outside.
  void add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  // A rectangle across y.
  void add_plate(double left, double right, double low, double high, double y);
};

// A box with an arm on one corner and a shorter one on another: no attitude looks like another one. Radius
// 2.5 m.
Body lopsided_body();
// A rectangle across the boresight, 4 x 3 m. Radius 3 m.
Body plate();

// A ball of 1 m. Radius 1 m.
Body ball();
// A box with a boom to the right. Radius 3.5 m.
Body body_with_boom();

// The section of a body. Its edges are all edges of the triangles.
class MeshSection {
 public:
  enum class Sides { kBoth, kFront };  // that reflect; the front: where the corners run counterclockwise
  explicit MeshSection(const Body& body, Sides sides = Sides::kBoth);
  SurfaceMesh mesh() const { return SurfaceMesh(bytes_.data()); }
  std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};
// The body as the section has it: its corners are rounded to the unit of the vertices.
Body rounded(const Body& body);

struct Sensor {
  int rays = 64;
  double fov_deg = 20.0;
  double tan_half_fov() const { return std::tan(fov_deg * M_PI / 360.0); }
};

struct ExactPose {
  Eigen::Matrix3d r_lrf_trf = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
};
Pose fixed(const ExactPose& pose);
ExactPose exact(const Pose& pose);
// Turned about the TRF's origin, then moved; both in the axes of the LRF.
ExactPose moved(const ExactPose& pose, const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& move_m);

// Along the boresight; infinity: the ray meets nothing.
inline constexpr double kNothing = std::numeric_limits<double>::infinity();
// Direction of a ray with a depth of 1; rows and columns may be broken numbers.
Eigen::Vector3d ray(const Sensor& sensor, double row, double column);
// Where a point of the LRF is on the screen, in rays from its upper left corner: (column, row).
Eigen::Vector2d on_screen(const Sensor& sensor, const Eigen::Vector3d& point_m);
// Depths in metres, row by row.
std::vector<double> cast(const Body& body, const ExactPose& pose, const Sensor& sensor);

// A frame, and the mask of its target.
struct Frame {
  std::unique_ptr<RangeImage> image = std::make_unique<RangeImage>();
  std::unique_ptr<RayMask> mask = std::make_unique<RayMask>();

  explicit Frame(const Sensor& sensor);
  // A return of the target. Ranges of 0 and less are no return.
  void add(int row, int column, double range_m);
  void hide(int row, int column, double range_m);
};
// What a sensor sees without noise.
Frame frame_of(const std::vector<double>& depths_m, const Sensor& sensor);

// The view of a frame; expects that there is one.
std::unique_ptr<FrameView> view_of(const Frame& frame, double reference_depth_m, double radius_m,
                                   const RangeNoise& noise = {});
// The view of a frame without a return.
std::unique_ptr<FrameView> empty_view(const Sensor& sensor, double reference_depth_m, double radius_m);
// A rendering with the memory that it needs.
struct Rendering : RenderedSurface {
  WorkBudget budget;  // without a limit
  ScreenVertices memory;
  Rendering() { vertices = &memory; }
};

// What a ray shows: its inverse depth, or one of these.
inline constexpr std::int16_t kMissed = -32768, kHidden = -32767;
// Makes `view` show these rays, row by row; its means of blocks are theirs, rounded.
void show(const std::vector<std::int16_t>& rays, FrameView& view);
void show_all(std::int16_t shown, FrameView& view);
// A view's rays with a return or without one, at random.
void show_random_returns(Random& random, FrameView& view);
// (reference depth / depth - 1) 2^shift.
double inverse_depth_of(const FrameView& view, double depth_m);

}  // namespace tumblesight::gnc
