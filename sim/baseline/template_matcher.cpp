#include "sim/baseline/template_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

namespace tumblesight::sim {
namespace {

constexpr double kQuarterTurn_rad = 1.5707963267948966;
constexpr double kGoldenAngle_rad = 2.399963229728653;
constexpr double kTemplateRange_m =
    40.0;  // a compromise between near frames, with much perspective, and far ones
constexpr int kTemplateRays = 64;
constexpr int kCoarseRays = 64;
constexpr int kFineRays = 128;
constexpr int kFinalists = 4;           // candidates that are refined on fine renderings
constexpr int kFinalIterations = 2;     // times icp_iterations
constexpr double kShift_radii = 0.2;    // of the centroid if a part of the target is hidden
constexpr int kRanked = 3000;           // templates among which candidates are sought
constexpr double kDistinct_rad = 0.13;  // candidates closer to each other converge to the same attitude
constexpr double kDepthTrust_m = 0.15;  // range noise of a cell at which depth counts half as much as cover
constexpr double kRaysPerCell = 28.0;   // in a full frame

void require(bool holds, const std::string& name, int value, const std::string& limit) {
  if (!holds) {
    throw std::invalid_argument("template matcher: " + name + " is " + std::to_string(value) +
                                ", but must be " + limit);
  }
}

TemplateMatcherSettings checked(const TemplateMatcherSettings& settings) {
  require(settings.directions >= 1, "directions", settings.directions, "at least 1");
  require(settings.rolls >= 4 && settings.rolls % 4 == 0, "rolls", settings.rolls,
          "a positive multiple of 4");
  require(settings.candidates >= 1, "candidates", settings.candidates, "at least 1");
  require(settings.icp_iterations >= 0, "icp_iterations", settings.icp_iterations, "at least 0");
  return settings;
}

// Attitude whose boresight is direction `index` of a Fibonacci lattice in the TRF.
Eigen::Quaterniond lattice_attitude(int index, int count) {
  const double z = 1.0 - (2.0 * index + 1.0) / count;
  const double r = std::sqrt(1.0 - z * z);
  const double angle = kGoldenAngle_rad * index;
  const Eigen::Vector3d boresight_trf(r * std::cos(angle), r * std::sin(angle), z);
  return Eigen::Quaterniond::FromTwoVectors(boresight_trf, Eigen::Vector3d::UnitY());
}

Eigen::Quaterniond rolled(double roll_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitY()));
}

Eigen::Quaterniond centring(const Eigen::Vector3d& towards) {
  return Eigen::Quaterniond::FromTwoVectors(towards, Eigen::Vector3d::UnitY());
}

// Possible directions of the centroid if nothing were hidden: the measured one, and others around it if a
// part of the target is hidden.
std::vector<Eigen::Vector3d> possible_centres(const TargetScan& scan, double target_radius_m) {
  std::vector<Eigen::Vector3d> centres{scan.towards};
  if (std::find(scan.kind.begin(), scan.kind.end(), RayKind::kBlocked) == scan.kind.end()) return centres;
  const double step = kShift_radii * target_radius_m / scan.centre_range_m;
  for (int right = -1; right <= 1; ++right) {
    for (int up = -1; up <= 1; ++up) {
      if (right == 0 && up == 0) continue;
      centres.push_back((scan.towards + step * Eigen::Vector3d(right, 0.0, up)).normalized());
    }
  }
  return centres;
}

}  // namespace

TemplateMatcher::TemplateMatcher(const TriangleMesh& mesh, double swath_m,
                                 const TemplateMatcherSettings& settings)
    : settings_(checked(settings)),
      target_radius_m_(mesh.radius_m()),
      swath_m_(swath_m),
      lidar_(mesh),
      alignment_(lidar_, swath_m, settings_.pairs) {
  render_templates();
}

// One rendering per direction. Rolls within a quarter turn use the same returns; the other quarters are
// covered by turning the frame's signature.
void TemplateMatcher::render_templates() {
  const int rolls = settings_.rolls / 4;
  templates_.reserve(static_cast<std::size_t>(settings_.directions) * static_cast<std::size_t>(rolls));
  for (int i = 0; i < settings_.directions; ++i) {
    const Eigen::Quaterniond q_lrf_trf = lattice_attitude(i, settings_.directions);
    const FrameTruth truth{q_lrf_trf, Eigen::Vector3d::Zero(), kTemplateRange_m};
    const auto scan = scan_of(lidar_.true_ranges(truth, kTemplateRays, swath_m_));
    if (!scan) continue;  // edge-on and thinner than the ray spacing: no frame shows it either
    for (int k = 0; k < rolls; ++k) {
      const double roll_rad = kQuarterTurn_rad * k / rolls;
      const Eigen::Quaterniond turn = rolled(roll_rad) * centring(scan->towards);
      const Eigen::Vector3d centre_m(0.0, scan->centre_range_m, 0.0);
      templates_.push_back({signature_of(*scan, scan->towards, roll_rad, target_radius_m_), turn * q_lrf_trf,
                            turn * Eigen::Vector3d(0.0, kTemplateRange_m, 0.0) - centre_m});
    }
  }
}

std::vector<TemplateMatcher::Candidate> TemplateMatcher::ranked(
    const TargetScan& scan, const std::vector<Eigen::Vector3d>& centres) const {
  const double noise_m = range_sigma_m(scan.centre_range_m) / std::sqrt(kRaysPerCell);
  const double depth_weight = 1.0 / (1.0 + (noise_m / kDepthTrust_m) * (noise_m / kDepthTrust_m));
  std::vector<Candidate> all;
  all.reserve(4 * centres.size() * templates_.size());
  for (std::size_t centre = 0; centre < centres.size(); ++centre) {
    Signature frame = signature_of(scan, centres[centre], 0.0, target_radius_m_);
    for (int quarter = 0; quarter < 4; ++quarter) {
      for (std::size_t i = 0; i < templates_.size(); ++i) {
        const double d = difference(frame, templates_[i].signature, depth_weight);
        all.push_back({d, static_cast<int>(i), quarter, static_cast<int>(centre)});
      }
      frame = quarter_turned(frame);
    }
  }
  const auto better = [](const Candidate& a, const Candidate& b) {
    return std::tie(a.difference, a.entry, a.quarter_turns, a.centre) <
           std::tie(b.difference, b.entry, b.quarter_turns, b.centre);
  };
  const auto kept = static_cast<std::ptrdiff_t>(std::min<std::size_t>(kRanked, all.size()));
  std::partial_sort(all.begin(), all.begin() + kept, all.end(), better);
  all.resize(static_cast<std::size_t>(kept));
  return all;
}

TargetPose TemplateMatcher::pose_of(const Candidate& candidate, const Eigen::Vector3d& centre,
                                    double range_m) const {
  const Template& t = templates_[static_cast<std::size_t>(candidate.entry)];
  const Eigen::Quaterniond to_lrf =
      centring(centre).conjugate() * rolled(-kQuarterTurn_rad * candidate.quarter_turns);
  return {(to_lrf * t.q_view_trf).normalized(),
          to_lrf * (Eigen::Vector3d(0.0, range_m, 0.0) + t.origin_view_m)};
}

// The poses of the best templates, only one of those close to each other.
std::vector<TargetPose> TemplateMatcher::starts(const TargetScan& scan) const {
  const std::vector<Eigen::Vector3d> centres = possible_centres(scan, target_radius_m_);
  std::vector<TargetPose> poses;
  for (const Candidate& candidate : ranked(scan, centres)) {
    const Eigen::Vector3d& centre = centres[static_cast<std::size_t>(candidate.centre)];
    const TargetPose pose = pose_of(candidate, centre, scan.centre_range_m);
    const bool is_new = std::none_of(poses.begin(), poses.end(), [&](const TargetPose& other) {
      return other.q_lrf_trf.angularDistance(pose.q_lrf_trf) < kDistinct_rad;
    });
    if (is_new) poses.push_back(pose);
    if (static_cast<int>(poses.size()) == settings_.candidates) break;
  }
  return poses;
}

TemplateMatcher::Result TemplateMatcher::match(const gnc::RangeImage& frame) const {
  const auto scan = scan_of(frame);
  if (!scan) return {};
  const SilhouetteField silhouette(*scan);

  struct Refined {
    TargetPose pose;
    double residual_m;
  };
  std::vector<Refined> refined;
  for (const TargetPose& start : starts(*scan)) {
    const TargetPose pose =
        alignment_.refine(*scan, silhouette, start, kCoarseRays, settings_.icp_iterations);
    refined.push_back({pose, alignment_.residual_m(*scan, pose, kCoarseRays)});
  }
  const auto better = [](const Refined& a, const Refined& b) { return a.residual_m < b.residual_m; };
  std::stable_sort(refined.begin(), refined.end(), better);
  refined.resize(std::min<std::size_t>(refined.size(), kFinalists));
  for (Refined& finalist : refined) {
    finalist.pose = alignment_.refine(*scan, silhouette, finalist.pose, kFineRays,
                                      kFinalIterations * settings_.icp_iterations);
    finalist.residual_m = alignment_.residual_m(*scan, finalist.pose, kFineRays);
  }
  const auto best = std::min_element(refined.begin(), refined.end(), better);
  if (best == refined.end()) return {};
  return {best->pose.q_lrf_trf, best->residual_m, true};
}

}  // namespace tumblesight::sim
