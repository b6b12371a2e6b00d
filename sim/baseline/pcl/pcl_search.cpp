#include "sim/baseline/pcl/pcl_search.hpp"

#include <pcl/features/fpfh.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>
#include <pcl/registration/transformation_estimation_point_to_plane_lls.h>

namespace tumblesight::sim {
namespace {

static_assert(alignof(Eigen::Matrix4f) == 16, "PCL's classes would have another layout than in its library");

constexpr double kIcpTolerance = 1e-6;

using Point = pcl::PointNormal;
using Cloud = pcl::PointCloud<Point>;
using Feature = pcl::FPFHSignature33;
using Features = pcl::PointCloud<Feature>;
using Ransac = pcl::SampleConsensusPrerejective<Point, Point, Feature>;
using Icp = pcl::IterativeClosestPointWithNormals<Point, Point>;
using RowMajor = Eigen::Matrix<float, 4, 4, Eigen::RowMajor>;

// A scan of one plane leaves motions along it open: PCL then has a step that is not a number, on which its
// search for neighbours ends the program. Here such a step is none.
class FiniteSteps final : public pcl::registration::TransformationEstimationPointToPlaneLLS<Point, Point> {
 public:
  using Base = pcl::registration::TransformationEstimationPointToPlaneLLS<Point, Point>;
  using Base::estimateRigidTransformation;
  void estimateRigidTransformation(const Cloud& source, const Cloud& target,
                                   const pcl::Correspondences& pairs, Matrix4& step) const override {
    Base::estimateRigidTransformation(source, target, pairs, step);
    if (!step.allFinite()) step.setIdentity();
  }
};

Cloud::Ptr cloud_of(const PclPoints& points) {
  auto cloud = std::make_shared<Cloud>();
  for (std::size_t i = 0; i + 2 < points.points_m.size(); i += 3) {
    Point point;
    point.getVector3fMap() = Eigen::Map<const Eigen::Vector3f>(&points.points_m[i]);
    point.getNormalVector3fMap() = Eigen::Map<const Eigen::Vector3f>(&points.normals[i]);
    cloud->push_back(point);
  }
  return cloud;
}

Features::Ptr features_of(const Cloud::Ptr& cloud, double radius_m) {
  pcl::FPFHEstimation<Point, Point, Feature> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  estimation.setRadiusSearch(radius_m);
  auto features = std::make_shared<Features>();
  estimation.compute(*features);
  return features;
}

PclPose pose_of(const Eigen::Matrix4f& matrix) {
  PclPose pose;
  Eigen::Map<RowMajor>(pose.data()) = matrix;
  return pose;
}

}  // namespace

class PclSearch::Scan {
 public:
  Scan(const PclPoints& scan, const PclSettings& settings)
      : cloud(sim::cloud_of(scan)), features(features_of(cloud, settings.feature_radius_m)) {}
  Cloud::Ptr cloud;
  Features::Ptr features;
};

struct PclSearch::Parts {
  Ransac ransac;
  Icp icp;
};

PclSearch::PclSearch(const PclPoints& coarse, const PclPoints& fine, const PclSettings& settings)
    : parts_(std::make_unique<Parts>()) {
  const Cloud::Ptr cloud = cloud_of(coarse);
  Ransac& ransac = parts_->ransac;
  ransac.setInputTarget(cloud);
  ransac.setTargetFeatures(features_of(cloud, settings.feature_radius_m));
  ransac.setMaximumIterations(settings.iterations);
  ransac.setNumberOfSamples(settings.samples);
  ransac.setCorrespondenceRandomness(settings.similar_features);
  ransac.setSimilarityThreshold(settings.similarity);
  ransac.setMaxCorrespondenceDistance(settings.inlier_m);
  ransac.setInlierFraction(settings.inlier_share);
  Icp& icp = parts_->icp;
  icp.setTransformationEstimation(std::make_shared<FiniteSteps>());
  icp.setInputTarget(cloud_of(fine));
  icp.setMaxCorrespondenceDistance(settings.icp_pair_m);
  icp.setMaximumIterations(settings.icp_iterations);
  icp.setTransformationEpsilon(kIcpTolerance);
}

PclSearch::~PclSearch() = default;
PclSearch::PclSearch(PclSearch&&) noexcept = default;
PclSearch& PclSearch::operator=(PclSearch&&) noexcept = default;

std::shared_ptr<const PclSearch::Scan> PclSearch::prepared(const PclPoints& scan,
                                                           const PclSettings& settings) {
  return std::make_shared<const Scan>(scan, settings);
}

std::optional<PclPose> PclSearch::ransac(const std::shared_ptr<const Scan>& scan) const {
  Ransac& ransac = parts_->ransac;
  ransac.setInputSource(scan->cloud);
  ransac.setSourceFeatures(scan->features);
  Cloud moved;
  ransac.align(moved);
  if (!ransac.hasConverged()) return std::nullopt;
  return pose_of(ransac.getFinalTransformation());
}

PclPose PclSearch::icp(const std::shared_ptr<const Scan>& scan, const PclPose& start) const {
  Icp& icp = parts_->icp;
  icp.setInputSource(scan->cloud);
  Cloud moved;
  icp.align(moved, Eigen::Matrix4f(Eigen::Map<const RowMajor>(start.data())));
  return pose_of(icp.getFinalTransformation());
}

}  // namespace tumblesight::sim
