// The ONNX model of the whole step gives, in ONNX Runtime, the attitudes of the flight code in float32.
#include "sim/onnx/step_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "sim/bench/onnx_runtime_library.hpp"
#include "sim/bench/peer.hpp"
#include "sim/evaluation/host_estimator.hpp"
#include "sim/world/chaser_navigation.hpp"
#include "sim/world/frame_renderer.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

namespace shape = gnc::shape;
constexpr const char* kModel = TUMBLESIGHT_SOURCE_DIR "/fsw/models/near_shoemaker.float32.tsm";
constexpr const char* kTarget = "near_shoemaker";
const std::uint32_t kSequences = std::getenv("SEQS") ? std::atoi(std::getenv("SEQS")) : 5;
constexpr std::uint64_t kSeed = 11;
constexpr double kLargestDifference_deg = 0.05;

// The model in ONNX Runtime, as a user runs it: each run's next_state is the state of the next run.
class StepRunner {
 public:
  StepRunner(std::unique_ptr<OnnxRuntimeLibrary> library, const std::string& model)
      : library_(std::move(library)),
        environment_(library_->make_environment()),
        session_(library_->make_session(environment_, model)) {
    add(inputs_, input_names_, "image", image, {1, 1, shape::kImageSide, shape::kImageSide});
    add(inputs_, input_names_, "r_lrf_view", r_lrf_view, {1, 3, 3});
    add(inputs_, input_names_, "elapsed_s", elapsed_s, {1, 1});
    add(inputs_, input_names_, "q_now_last", q_now_last, {1, 4});
    add(inputs_, input_names_, "state", state, {1, kStepState});
    add(outputs_, output_names_, "q_lrf_trf", q_lrf_trf, {1, 4});
    add(outputs_, output_names_, "expected_error_rad", expected_error_rad, {1, 1});
    add(outputs_, output_names_, "rate_lrf_rad_s", rate_lrf_rad_s, {1, 3});
    add(outputs_, output_names_, "q_lrf_trf_hypotheses", q_lrf_trf_hypotheses, {1, shape::kHypotheses, 4});
    add(outputs_, output_names_, "probabilities", probabilities, {1, shape::kHypotheses});
    add(outputs_, output_names_, "next_state", next_state_, {1, kStepState});
  }

  void start() { state.fill(0.0F); }
  void run() {
    library_->run(session_, input_names_, inputs_, output_names_, outputs_);
    state = next_state_;
  }

  std::array<float, shape::kImageSide * shape::kImageSide> image{};
  std::array<float, 9> r_lrf_view{};
  std::array<float, 1> elapsed_s{};
  std::array<float, 4> q_now_last{};
  std::array<float, kStepState> state{};
  std::array<float, 4> q_lrf_trf{};
  std::array<float, 1> expected_error_rad{};
  std::array<float, 3> rate_lrf_rad_s{};
  std::array<float, 4 * shape::kHypotheses> q_lrf_trf_hypotheses{};
  std::array<float, shape::kHypotheses> probabilities{};

 private:
  using Library = OnnxRuntimeLibrary;

  template <class Numbers>
  void add(std::vector<Library::Object*>& objects, std::vector<const char*>& names, const char* name,
           Numbers& numbers, const std::vector<std::int64_t>& size) {
    tensors_.push_back(library_->make_tensor(numbers.data(), numbers.size(), size));
    objects.push_back(tensors_.back().get());
    names.push_back(name);
  }

  std::unique_ptr<Library> library_;
  Library::Handle environment_, session_;
  std::vector<Library::Handle> tensors_;
  std::vector<const char*> input_names_, output_names_;
  std::vector<Library::Object*> inputs_, outputs_;
  std::array<float, kStepState> next_state_{};
};

// The largest differences from the flight code.
struct Differences {
  double attitude_deg = 0.0, expected_error_deg = 0.0, rate_deg_s = 0.0;
  int frames = 0, unlike = 0;
};

Eigen::Quaterniond quaternion(const float* q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

class StepModel : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string reason;
    auto library = OnnxRuntimeLibrary::open("", reason);
    if (library == nullptr) GTEST_SKIP() << reason;
    image_ = read_model_bytes(kModel);
    estimator_ = std::make_unique<HostEstimator>(image_);
    ASSERT_EQ(estimator_->status(), gnc::ModelStatus::kOk);
    step_ = std::make_unique<StepRunner>(std::move(library), step_as_onnx(*read_float32_model(kModel)));
  }

  Differences differences(Condition condition, const Disturbances& disturbances = {}) {
    ScenarioSettings scenario =
        scenario_settings(condition, kFramesPerSequence, kTarget, inertia_kg_m2(kTarget));
    scenario.disturbances = disturbances;
    const FlashLidar lidar(target_by_name(kTarget));
    const FrameRenderer renderer(lidar, 1e-3 * estimator_->model().projection.swath_mm);
    Differences largest;
    for (std::uint32_t i = 0; i < kSequences; ++i) {
      const Sequence sequence = make_sequence(scenario, kSeed, i);
      estimator_->reset();
      step_->start();
      has_chaser_ = false;
      for (std::uint32_t k = 0; k < sequence.frames.size(); ++k) {
        if (!sequence.frames[k].lost) compare(renderer, sequence, k, largest);
      }
    }
    std::printf("unlike %d of ", largest.unlike); std::printf("%d frames: attitude %.5f deg, expected error %.5f deg, rate %.5f deg/s\n", largest.frames,
                largest.attitude_deg, largest.expected_error_deg, largest.rate_deg_s);
    return largest;
  }

  static void expect_small(const Differences& largest) {
    EXPECT_GE(largest.frames, static_cast<int>(kSequences) * 6);
    EXPECT_LT(largest.attitude_deg, kLargestDifference_deg);
    EXPECT_LT(largest.expected_error_deg, kLargestDifference_deg);
    EXPECT_LT(largest.rate_deg_s, kLargestDifference_deg);
  }

 private:
  void compare(const FrameRenderer& renderer, const Sequence& sequence, std::uint32_t k,
               Differences& largest) {
    renderer.render(sequence, k, frame_);
    const gnc::ChaserAttitude chaser =
        chaser_attitude(sequence.frames[k], frame_.exposure_time_ns, true);
    const gnc::FrameOutcome outcome = estimator_->step(frame_, chaser);
    ASSERT_TRUE(outcome.used());
    set_inputs(chaser);
    step_->run();
    const gnc::AttitudeEstimate& estimate = outcome.estimate;
    const double attitude_rad =
        gnc::to_double(estimate.q_lrf_trf).angularDistance(quaternion(step_->q_lrf_trf.data()));
    double rate_rad_s = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      rate_rad_s = std::max(rate_rad_s, std::abs(1e-6 * estimate.rate_lrf_urad_s[i] -
                                                 static_cast<double>(step_->rate_lrf_rad_s[i])));
    const double error_rad = std::abs(1e-6 * estimate.predicted_error_urad -
                                      static_cast<double>(step_->expected_error_rad[0]));
    largest.attitude_deg = std::max(largest.attitude_deg, kDegPerRad * attitude_rad);
    largest.rate_deg_s = std::max(largest.rate_deg_s, kDegPerRad * rate_rad_s);
    largest.expected_error_deg = std::max(largest.expected_error_deg, kDegPerRad * error_rad);
    ++largest.frames;
    largest.unlike += kDegPerRad * attitude_rad > 0.05;
  }

  void set_inputs(const gnc::ChaserAttitude& chaser) {
    gnc::DepthImage image;
    ASSERT_EQ(gnc::make_depth_image(frame_, estimator_->model().projection, scratch_, image),
              gnc::FrameStatus::kOk);
    const PeerImage pixels(image);
    std::copy(pixels.values.begin(), pixels.values.end(), step_->image.begin());
    for (std::size_t i = 0; i < 9; ++i)
      step_->r_lrf_view[i] =
          gnc::converted<float>(image.r_lrf_view(static_cast<int>(i) / 3, static_cast<int>(i) % 3));
    const Eigen::Quaterniond q_inertial_lrf = gnc::to_double(chaser.q_inertial_lrf);
    const Eigen::Quaterniond turn =
        has_chaser_ ? q_inertial_lrf.conjugate() * q_inertial_lrf_ : Eigen::Quaterniond::Identity();
    step_->q_now_last = {static_cast<float>(turn.w()), static_cast<float>(turn.x()),
                         static_cast<float>(turn.y()), static_cast<float>(turn.z())};
    step_->elapsed_s = {static_cast<float>(1e-9 * static_cast<double>(frame_.exposure_time_ns - time_ns_))};
    q_inertial_lrf_ = q_inertial_lrf;
    time_ns_ = frame_.exposure_time_ns;
    has_chaser_ = true;
  }

  std::vector<std::uint8_t> image_;
  std::unique_ptr<HostEstimator> estimator_;
  std::unique_ptr<StepRunner> step_;
  gnc::RangeImage frame_;
  gnc::DepthImageScratch scratch_;
  Eigen::Quaterniond q_inertial_lrf_;
  std::int64_t time_ns_ = 0;
  bool has_chaser_ = false;
};

// Verifies TS-TRN-070.
TEST_F(StepModel, FollowsASpinAsTheFlightCodeDoes) {
  expect_small(differences(Condition::kNominal));
}

// Verifies TS-TRN-070.
TEST_F(StepModel, FollowsATumblingTargetAsTheFlightCodeDoes) {
  expect_small(differences(Condition::kTumbling));
}

// Verifies TS-TRN-070.
TEST_F(StepModel, CoastsThroughAGapWithATurningChaserAsTheFlightCodeDoes) {
  Disturbances disturbances;
  disturbances.lost_frames = 4;
  disturbances.well_frames = 3;
  disturbances.chaser_rate_deg_s = 2.0;
  expect_small(differences(Condition::kTumbling, disturbances));
}

// Verifies TS-TRN-070.
TEST_F(StepModel, FindsARateFromFramesFarApartAsTheFlightCodeDoes) {
  Disturbances disturbances;
  disturbances.period_s = 8.0;
  disturbances.period_jitter = 0.5;
  disturbances.chaser_rate_deg_s = 1.0;
  expect_small(differences(Condition::kTumbling, disturbances));
}

// Verifies TS-TRN-070.
TEST_F(StepModel, FollowsFramesCloseTogetherAsTheFlightCodeDoes) {
  Disturbances disturbances;
  disturbances.period_s = 1.3;
  disturbances.period_jitter = 0.3;
  expect_small(differences(Condition::kTumbling, disturbances));
}

}  // namespace
}  // namespace tumblesight::sim
