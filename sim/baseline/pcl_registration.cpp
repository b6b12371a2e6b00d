// PCL's registration: features of the surface (FPFH) pair the scan with the target, RANSAC with early
// rejection finds a pose from the pairs, and ICP refines it.
//
// What was tried, on 6 to 40 nominal frames of Magellan (parametric mesh; share within 20 degrees):
//   features of the whole target: 38 % without noise, where features of views have 100 %;
//   the features of all views in one search, best of three to six: 19 to 50 %; a search per view: up to 75 %;
//   24 or 48 views: 72 % and 75 %;
//   cells of 0.2, 0.25 and 0.3 m with radii of 1.0, 1.4 and 1.8 m: 17 %, 42 to 69 % and 62 to 72 %. The noise
//   asks for large ones; inliers to 0.2, 0.3 and 0.45 m: 25 %, 42 to 67 % and 72 %; an inlier share of 0.3
//   instead of 0.5: 62 %; 10 or 20 similar features: no difference; 2000 or 8000 iterations: no difference;
//   choice by PCL's own fitness score, with one search: none of three frames. So misfit_m2 chooses.
#include <cstdlib>

#include "sim/baseline/pcl/pcl_search.hpp"
#include "sim/baseline/pose_peer.hpp"
#include "sim/baseline/surface_cloud.hpp"
#include "sim/baseline/view_choice.hpp"

namespace tumblesight::sim {
namespace {
constexpr int kViews = 30;
constexpr double kFeatureCell_m = 0.3;
constexpr double kIcpCell_m = 0.08;
constexpr PclSettings settings_of_search() {
  PclSettings settings{};
  settings.feature_radius_m = 1.8;
  settings.iterations = 8000;
  settings.samples = 3;
  settings.similar_features = 10;
  settings.similarity = 0.9F;
  settings.inlier_m = 0.45;
  settings.inlier_share = 0.5F;
  settings.icp_pair_m = 0.5;
  settings.icp_iterations = 20;
  return settings;
}
constexpr PclSettings kSettings = settings_of_search();

PclPoints points_of(const SurfaceCloud& cloud) {
  PclPoints points;
  for (const Eigen::Vector3f& point_m : cloud.points_m)
    points.points_m.insert(points.points_m.end(), point_m.data(), point_m.data() + 3);
  for (const Eigen::Vector3f& normal : cloud.normals)
    points.normals.insert(points.normals.end(), normal.data(), normal.data() + 3);
  return points;
}

Eigen::Isometry3d isometry_of(const PclPose& pose) {
  const Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(pose.data()).cast<double>();
  Eigen::Isometry3d made = Eigen::Isometry3d::Identity();
  made.linear() =
      Eigen::Quaterniond(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>())).normalized().toRotationMatrix();
  made.translation() = matrix.topRightCorner<3, 1>();
  return made;
}

class PclRegistration final : public PosePeer {
 public:
  PclRegistration(const TriangleMesh& mesh, double swath_m) {
    const std::vector<SurfaceView> views = surface_views(mesh, swath_m, kViews);
    views_ = coarse(views);
    for (const SurfaceView& view : views) {
      searches_.emplace_back(points_of(thinned(view.cloud, kFeatureCell_m)),
                             points_of(thinned(view.cloud, kIcpCell_m)), kSettings);
    }
  }

  Result match(const gnc::RangeImage& frame) const override {
    const auto scan = scan_of(frame);
    if (!scan) return {};
    const CentredScan centred(*scan, kFeatureCell_m);
    if (!centred.is_usable()) return {};
    const auto prepared = PclSearch::prepared(points_of(centred.cloud()), kSettings);
    ViewChoice choice(views_, centred);
    std::srand(1);  // RANSAC draws from it
    for (std::size_t view = 0; view < views_.size(); ++view) {
      const std::optional<PclPose> start = searches_[view].ransac(prepared);
      if (!start || !centred.could_show(views_[view], isometry_of(*start))) continue;
      choice.offer(isometry_of(searches_[view].icp(prepared, *start)));
    }
    return choice.best();
  }

 private:
  std::vector<SurfaceView> views_;
  std::vector<PclSearch> searches_;
};

}  // namespace

std::unique_ptr<PosePeer> make_pcl_registration(const TriangleMesh& mesh, double swath_m) {
  return std::make_unique<PclRegistration>(mesh, swath_m);
}

}  // namespace tumblesight::sim
