#include "sim/quantization/quantize_file.hpp"

#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

using gnc::FixedPoint;
using gnc::Float32;

// One sequence in this many is kept for the report.
constexpr int kReportShare = 4;

Eigen::Quaterniond quaternion(const gnc::Matrix3<float>& rotation) {
  return Eigen::Quaterniond(rotation.cast<double>()).normalized();
}

// Angle between the attitudes of both numerics, per frame.
std::vector<double> differences_deg(const Float32Model& model, const gnc::NetworkWeights<FixedPoint>& fixed,
                                    const std::vector<ImageSequence>& sequences) {
  const auto float_laws = gnc::motion_laws<float>(gnc::converted<float>(model.header.inertia));
  const auto fixed_laws = gnc::motion_laws<gnc::Fixed>(model.header.inertia);
  std::vector<double> differences;
  for (const ImageSequence& sequence : sequences) {
    const auto expected = attitudes_of<Float32>(model.weights, float_laws, sequence);
    const auto found = attitudes_of<FixedPoint>(fixed, fixed_laws, sequence);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Eigen::Quaterniond other = quaternion(gnc::converted<float>(found[i]));
      differences.push_back(kDegPerRad * angular_error_rad(quaternion(expected[i]), other));
    }
  }
  return differences;
}

struct Rendered {
  std::vector<std::unique_ptr<FlashLidar>> lidars;
  std::vector<const FlashLidar*> each;
  explicit Rendered(const std::vector<TriangleMesh>& meshes) {
    for (const TriangleMesh& mesh : meshes) {
      lidars.push_back(std::make_unique<FlashLidar>(mesh));
      each.push_back(lidars.back().get());
    }
  }
};

}  // namespace

QuantizationReport quantize_to_file(const Float32Model& model, const std::vector<TriangleMesh>& meshes,
                                    int sequences, const std::string& path,
                                    const std::function<void(std::uint64_t)>& progress) {
  const Rendered rendered(meshes);
  const int held_back = sequences / kReportShare;
  Calibration calibration(model.weights,
                          gnc::motion_laws<float>(gnc::converted<float>(model.header.inertia)));
  std::vector<ImageSequence> kept;
  for (int i = 0; i < sequences; ++i) {
    ImageSequence sequence =
        calibration_sequence(rendered.each, model.header.projection, static_cast<std::uint64_t>(i));
    if (i < sequences - held_back) {
      calibration.add(sequence);
    } else {
      kept.push_back(std::move(sequence));
    }
    progress(static_cast<std::uint64_t>(i) + 1);
  }
  const std::unique_ptr<QuantizedNetwork> network = quantize(model.weights, calibration.statistics());

  QuantizationReport report;
  report.crc32 = write_model_file<FixedPoint>(path, model.header, network->weights);
  report.size_bytes = gnc::kModelImageSize<FixedPoint>;
  report.layers = compare(model.weights, *network, model.header.inertia, kept);
  report.difference = summarise(differences_deg(model, network->weights, kept));
  return report;
}

}  // namespace tumblesight::sim
