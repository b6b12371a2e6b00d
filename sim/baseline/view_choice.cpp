#include "sim/baseline/view_choice.hpp"

#include <algorithm>

namespace tumblesight::sim {
namespace {

constexpr std::size_t kFewestPoints = 10;
constexpr double kCoarseCell_m = 0.2;
constexpr double kMisfitLimit_m = 0.3;
constexpr double kSameSide = 0.6;  // cosine between the view's direction and the sensor's

SurfaceCloud moved(SurfaceCloud cloud, const Eigen::Isometry3f& pose) {
  for (Eigen::Vector3f& point_m : cloud.points_m) point_m = pose * point_m;
  for (Eigen::Vector3f& normal : cloud.normals) normal = pose.linear() * normal;
  return cloud;
}

}  // namespace

CentredScan::CentredScan(const TargetScan& scan, double cell_m) : towards_sensor_(-scan.towards) {
  SurfaceCloud cloud = cloud_of(scan);
  const Eigen::Vector3f centre_m = (scan.centre_range_m * scan.towards).cast<float>();
  for (Eigen::Vector3f& point_m : cloud.points_m) point_m -= centre_m;
  cloud_ = thinned(cloud, cell_m);
  coarse_ = thinned(cloud, kCoarseCell_m);
}

bool CentredScan::is_usable() const {
  return std::min(cloud_.size(), coarse_.size()) >= kFewestPoints;
}

bool CentredScan::could_show(const SurfaceView& view, const Eigen::Isometry3d& trf_scan) const {
  return (trf_scan.linear() * towards_sensor_).dot(view.towards_sensor.cast<double>()) > kSameSide;
}

std::vector<SurfaceView> coarse(std::vector<SurfaceView> views) {
  for (SurfaceView& view : views) view.cloud = thinned(view.cloud, kCoarseCell_m);
  return views;
}

ViewChoice::ViewChoice(const std::vector<SurfaceView>& views, const CentredScan& scan)
    : views_(views), scan_(scan) {}

void ViewChoice::offer(const Eigen::Isometry3d& trf_scan) {
  const Eigen::Vector3f towards_sensor = (trf_scan.linear() * scan_.towards_sensor()).cast<float>();
  const auto nearest =
      std::max_element(views_.begin(), views_.end(), [&](const SurfaceView& a, const SurfaceView& b) {
        return a.towards_sensor.dot(towards_sensor) < b.towards_sensor.dot(towards_sensor);
      });
  if (nearest == views_.end()) return;
  const SurfaceCloud scan_trf = moved(scan_.coarse(), trf_scan.cast<float>());
  const double misfit = misfit_m2(scan_trf, nearest->cloud, kMisfitLimit_m);
  if (misfit >= least_misfit_m2_) return;
  least_misfit_m2_ = misfit;
  best_ = {Eigen::Quaterniond(trf_scan.linear()).normalized().conjugate(), true};
}

}  // namespace tumblesight::sim
