// OpenCV's surface matching: point pair features vote for poses (Drost et al., 2010), and ICP refines the
// best.
//
// What was tried, on 16 nominal frames of Magellan and 24 of NEAR Shoemaker (parametric meshes; share within
// 20 degrees):
//   one model of the whole target is not possible: OpenCV's sampling averages the two sides of thin panels;
//   14 or 30 views: NEAR 17 % and 50 %;
//   sampling and distance step of 0.05 or 0.07 of a view's size: Magellan 50 % and 69 %, by votes;
//   20 or 30 angles: 31 % and 69 %, by votes; 30 or 40: 94 % and 81 %, by misfit_m2;
//   every fifth or every second point of the scan votes: NEAR 17 % and 25 %, with 14 views and twice the
//   time; choice among the candidates by votes 69 %, by the residual of OpenCV's ICP 12 %, by misfit_m2 94 %;
//   10 or 25 candidates: 94 % and 88 % for Magellan; 10 or 20: 50 % for NEAR with either.
#include <algorithm>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <opencv2/surface_matching.hpp>
#include <opencv2/surface_matching/ppf_helpers.hpp>

#include "sim/baseline/pose_peer.hpp"
#include "sim/baseline/surface_cloud.hpp"
#include "sim/baseline/view_choice.hpp"

namespace tumblesight::sim {
namespace {

namespace ppf = cv::ppf_match_3d;

constexpr int kViews = 30;
constexpr double kCell_m = 0.1;  // of the clouds that OpenCV gets
constexpr double kStep = 0.07;   // of the size of a cloud, as OpenCV samples it
constexpr int kAngles = 30;
constexpr double kVotingShare = 0.2;  // of the points of the scan
constexpr double kNoClustering = 1e-9;
constexpr double kSameAttitude_rad = 0.25;
constexpr double kSamePlace_m = 0.3;
constexpr std::size_t kCandidates = 10;
constexpr int kIcpIterations = 50;
constexpr float kIcpTolerance = 0.005F;
constexpr float kIcpRejection_sigma = 2.5F;
constexpr int kIcpLevels = 4;

cv::Mat mat_of(const SurfaceCloud& cloud) {
  cv::Mat mat(static_cast<int>(cloud.size()), 6, CV_32F);
  for (int i = 0; i < mat.rows; ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (int axis = 0; axis < 3; ++axis) {
      mat.at<float>(i, axis) = cloud.points_m[k][axis];
      mat.at<float>(i, 3 + axis) = cloud.normals[k][axis];
    }
  }
  return mat;
}

Eigen::Isometry3d isometry_of(const cv::Matx44d& pose) {
  Eigen::Isometry3d made = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) made(row, column) = pose(row, column);
  }
  return made;
}

struct Vote {
  Eigen::Isometry3d scan_trf;
  cv::Matx44d pose;
  double votes = 0.0;
  std::size_t view = 0;
};

bool same_pose(const Vote& a, const Vote& b) {
  const Eigen::AngleAxisd turn(a.scan_trf.linear().transpose() * b.scan_trf.linear());
  return turn.angle() < kSameAttitude_rad &&
         (a.scan_trf.translation() - b.scan_trf.translation()).norm() < kSamePlace_m;
}

void sort_by_votes(std::vector<Vote>& votes) {
  std::stable_sort(votes.begin(), votes.end(),
                   [](const Vote& a, const Vote& b) { return a.votes > b.votes; });
}

// The strongest pose of each cluster, with the votes of the whole cluster.
std::vector<Vote> clustered(std::vector<Vote> votes) {
  sort_by_votes(votes);
  std::vector<Vote> clusters;
  std::vector<double> sums;
  for (const Vote& vote : votes) {
    bool is_new = true;
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      if (!same_pose(clusters[i], vote)) continue;
      sums[i] += vote.votes;
      is_new = false;
    }
    if (!is_new) continue;
    clusters.push_back(vote);
    sums.push_back(vote.votes);
  }
  for (std::size_t i = 0; i < clusters.size(); ++i) clusters[i].votes = sums[i];
  sort_by_votes(clusters);
  if (clusters.size() > kCandidates) clusters.resize(kCandidates);
  return clusters;
}

// OpenCV divides its loops among threads unless told otherwise.
class OneThread {
 public:
  OneThread() : before_(cv::getNumThreads()) { cv::setNumThreads(1); }
  ~OneThread() { cv::setNumThreads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

class OpencvPpf final : public PosePeer {
 public:
  OpencvPpf(const TriangleMesh& mesh, double swath_m) {
    const std::vector<SurfaceView> views = surface_views(mesh, swath_m, kViews);
    views_ = coarse(views);
    for (const SurfaceView& view : views) {
      clouds_.push_back(mat_of(thinned(view.cloud, kCell_m)));
      detectors_.push_back(std::make_unique<ppf::PPF3DDetector>(kStep, kStep, kAngles));
      // OpenCV's clusters compare the angles of two rotations but not their axes, so they would mix
      // attitudes.
      detectors_.back()->setSearchParams(kNoClustering, kNoClustering, false);
      detectors_.back()->trainModel(clouds_.back());
    }
  }

  Result match(const gnc::RangeImage& frame) const override {
    const auto scan = scan_of(frame);
    if (!scan) return {};
    const CentredScan centred(*scan, kCell_m);
    if (!centred.is_usable()) return {};
    const OneThread one_thread;
    const cv::Mat scene = mat_of(centred.cloud());
    ppf::ICP icp(kIcpIterations, kIcpTolerance, kIcpRejection_sigma, kIcpLevels);
    ViewChoice choice(views_, centred);
    for (const Vote& candidate : clustered(votes_of(scene, centred))) {
      const cv::Matx44d start = candidate.pose.inv();
      cv::Matx44d turn = cv::Matx44d::eye();
      double residual = 0.0;
      icp.registerModelToScene(ppf::transformPCPose(scene, start), clouds_[candidate.view], residual, turn);
      choice.offer(isometry_of(turn * start));
    }
    return choice.best();
  }

 private:
  std::vector<Vote> votes_of(const cv::Mat& scene, const CentredScan& centred) const {
    std::vector<Vote> votes;
    for (std::size_t view = 0; view < views_.size(); ++view) {
      std::vector<ppf::Pose3DPtr> poses;
      detectors_[view]->match(scene, poses, kVotingShare, kStep);
      for (const ppf::Pose3DPtr& pose : poses) {
        const Vote vote{isometry_of(pose->pose), pose->pose, static_cast<double>(pose->numVotes), view};
        if (centred.could_show(views_[view], vote.scan_trf.inverse())) votes.push_back(vote);
      }
    }
    return votes;
  }

  std::vector<SurfaceView> views_;
  std::vector<cv::Mat> clouds_;
  std::vector<std::unique_ptr<ppf::PPF3DDetector>> detectors_;
};

}  // namespace

std::unique_ptr<PosePeer> make_opencv_ppf(const TriangleMesh& mesh, double swath_m) {
  return std::make_unique<OpencvPpf>(mesh, swath_m);
}

}  // namespace tumblesight::sim
