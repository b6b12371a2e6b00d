#include "sim/quantization/calibration.hpp"

#include <memory>
#include <stdexcept>

#include "gnc/rcnn/network_flow.hpp"
#include "sim/world/frame_renderer.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

constexpr int kFrames = 10;
constexpr std::uint64_t kSeed = 0xCA11B8A7E;  // hashed below: no user gives such a seed

template <class Number, int kSide, int kChannels>
void append(const gnc::PaddedImage<Number, kSide, kChannels>& image, std::vector<double>& to) {
  auto copy = std::make_unique<gnc::PaddedImage<Number, kSide, kChannels>>(image);
  for (int y = 0; y < kSide; ++y) to.insert(to.end(), copy->row(y), copy->row(y) + kSide * kChannels);
}
template <class Number, std::size_t kCount>
void append(const std::array<Number, kCount>& numbers, std::vector<double>& to) {
  to.insert(to.end(), numbers.begin(), numbers.end());
}

}  // namespace

ImageSequence calibration_sequence(const std::vector<const FlashLidar*>& lidars,
                                   const gnc::DepthProjection& projection, std::uint64_t number,
                                   const ScenarioSettings& seen) {
  const std::vector<Condition> conditions = calibration_conditions();
  auto frame = std::make_unique<gnc::RangeImage>();
  auto scratch = std::make_unique<gnc::DepthImageScratch>();
  const FrameRenderer renderer(*lidars[number % lidars.size()], 1e-3 * projection.swath_mm);
  ScenarioSettings scenario = seen;
  scenario.condition = conditions[number / lidars.size() % conditions.size()];
  scenario.frames = kFrames;
  const Sequence truth = make_sequence(scenario, mix(kSeed, number), number);
  ImageSequence images;
  for (int k = 0; k < kFrames; ++k) {
    renderer.render(truth, static_cast<std::uint32_t>(k), *frame);
    gnc::DepthImage image;
    if (make_depth_image(*frame, projection, *scratch, image) != gnc::FrameStatus::kOk) break;
    images.push_back(image);
  }
  return images;
}

namespace {

// Runs one sequence through the steps of the estimator and returns the attitudes. Calls note(layer, output)
// for every layer.
template <class N, class Note>
std::vector<gnc::Matrix3<typename N::Real>> follow(const gnc::NetworkWeights<N>& weights,
                                                   const gnc::MotionModels<typename N::Real>& motion_models,
                                                   const ImageSequence& sequence, Note&& note) {
  using Real = typename N::Real;
  const gnc::Kernels<N>& kernels = gnc::fastest_kernels<N>();
  auto activations = std::make_unique<gnc::Activations<N>>();
  gnc::LstmState<N> state;
  gnc::AttitudeTrack<Real> track;
  std::vector<gnc::Matrix3<Real>> attitudes;
  for (const gnc::DepthImage& image : sequence) {
    gnc::Features<N> features;
    gnc::OutputVector<Real> output;
    gnc::LstmInput<N> input;
    gnc::HeadOutput<Real> head;
    gnc::run_frame<N>(kernels, weights, image, *activations, features, output, note);
    const auto hypotheses = gnc::decode_hypotheses<Real>(output, gnc::converted<Real>(image.r_lrf_view));
    const auto prediction = gnc::predict<Real>(track, motion_models, hypotheses);
    gnc::fill_lstm_input<N>(features, hypotheses, prediction.r_lrf_trf(), input);
    note("lstm_input", input);
    gnc::run_sequence<N>(kernels, weights, input, *activations, state, head, note);
    attitudes.push_back(gnc::advance<Real>(hypotheses, prediction, head, track).r_lrf_trf);
  }
  return attitudes;
}

}  // namespace

template <class N>
Observations observe(const gnc::NetworkWeights<N>& weights,
                     const gnc::MotionModels<typename N::Real>& motion_models,
                     const ImageSequence& sequence) {
  Observations observations;
  follow<N>(weights, motion_models, sequence,
            [&observations](const char* layer, const auto& output) { append(output, observations[layer]); });
  return observations;
}

template <class N>
std::vector<gnc::Matrix3<typename N::Real>> attitudes_of(
    const gnc::NetworkWeights<N>& weights, const gnc::MotionModels<typename N::Real>& motion_models,
    const ImageSequence& sequence) {
  return follow<N>(weights, motion_models, sequence, [](const char*, const auto&) {});
}

#define TUMBLESIGHT_INSTANTIATE(N)                                                                   \
  template Observations observe<N>(const gnc::NetworkWeights<N>&, const gnc::MotionModels<N::Real>&, \
                                   const ImageSequence&);                                            \
  template std::vector<gnc::Matrix3<N::Real>> attitudes_of<N>(                                       \
      const gnc::NetworkWeights<N>&, const gnc::MotionModels<N::Real>&, const ImageSequence&)
TUMBLESIGHT_INSTANTIATE(gnc::Float32);
TUMBLESIGHT_INSTANTIATE(gnc::FixedPoint);

}  // namespace tumblesight::sim
