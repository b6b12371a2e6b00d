#include "gnc/estimation/attitude_estimator.hpp"

#include <algorithm>

#include "gnc/attitude/quaternion.hpp"
#include "gnc/estimation/pose_agreement.hpp"
#include "gnc/lidar/depth_loops.hpp"
#include "gnc/numerics/conversion.hpp"
#include "gnc/numerics/crc.hpp"
#include "gnc/numerics/division.hpp"

namespace tumblesight::gnc {

static_assert(sizeof(AttitudeEstimator<FixedPoint>) <= 144 * 1024 + kKernelScratchBytes,
              "working memory exceeds its budget");
static_assert(kModelImageSize<FixedPoint> <= 1'500'000, "the model image exceeds its budget");

namespace {

// Not inlined, to keep the code small.
[[gnu::noinline]] Fixed trace_of_product(const Matrix3<Fixed>& a, const Matrix3<Fixed>& b) {
  return trace_of_transpose_product<Fixed>(a, b);
}

// Expected error in microradians; pi if `attitude` is not a rotation, as damaged weights or a damaged state
// may cause.
std::uint32_t error_urad(const Matrix3<Fixed>& attitude, Fixed predicted_rad) {
  const Fixed trace = trace_of_product(attitude, attitude);
  const bool is_rotation = abs(trace - Fixed(3.0)) < Fixed(0.1);
  const std::int64_t scaled = std::int64_t{predicted_rad.raw()} * 1'000'000;
  const std::int64_t urad = (scaled + (1 << (Fixed::kFractionBits - 1))) >> Fixed::kFractionBits;
  return select(is_rotation, static_cast<std::uint32_t>(min<std::int64_t>(kPi_urad, urad)), kPi_urad);
}

QuaternionQ30 select(bool condition, const QuaternionQ30& yes, const QuaternionQ30& no) {
  QuaternionQ30 result;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = gnc::select(condition, yes[i], no[i]);
  return result;
}

// A position on the +y axis of the view frame.
std::array<std::int32_t, 3> position_lrf_mm(const DepthImage& image) {
  std::array<std::int32_t, 3> position;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t scaled = std::int64_t{image.r_lrf_view(i, 1).raw()} * image.centroid_distance_mm;
    position[static_cast<std::size_t>(i)] =
        static_cast<std::int32_t>((scaled + (1 << (Fixed::kFractionBits - 1))) >> Fixed::kFractionBits);
  }
  return position;
}

// The alternative to `attitude` among the hypotheses of a frame.
struct Alternative {
  QuaternionQ30 q_lrf_trf;
  std::uint32_t odds_ppm;
  Fixed share;  // its probability over that of both
};
template <class Real>
Alternative second_of(const Hypotheses<Real>& hypotheses, const Matrix3<Real>& attitude) {
  // Masks instead of an index: the time of a copy can depend on the alignment of what it copies.
  std::int32_t same = 0, largest = 0;
  std::array<std::int32_t, 9> second{};
  for (int i = 0; i < shape::kHypotheses; ++i) {
    const auto is_same = mask_if<std::int32_t>(same_attitude<Real>(hypotheses.r_lrf_trf[i], attitude));
    const std::int32_t probability = converted<Fixed>(hypotheses.probability[i]).raw();
    same += probability & is_same;
    const std::int32_t is_second = ~is_same & less_mask(largest, probability);
    largest ^= (largest ^ probability) & is_second;
    for (int k = 0; k < 9; ++k) {
      std::int32_t& element = second[static_cast<std::size_t>(k)];
      element ^= (element ^ converted<Fixed>(hypotheses.r_lrf_trf[i](k)).raw()) & is_second;
    }
  }
  constexpr std::int64_t kMostOdds_ppm = 1'000'000'000;
  const std::int64_t divisor = max<std::int64_t>(same, 1);
  const std::int64_t odds_ppm = min(kMostOdds_ppm, divide(std::int64_t{largest} * 1'000'000, divisor));
  const Fixed share =
      Fixed::from_raw(divide(std::int64_t{largest} << Fixed::kFractionBits, max(same + largest, 1)));
  Matrix3<Fixed> r_lrf_trf;
  for (int k = 0; k < 9; ++k) r_lrf_trf(k) = Fixed::from_raw(second[static_cast<std::size_t>(k)]);
  const QuaternionQ30 q_lrf_trf = quaternion_from_rotation(r_lrf_trf);
  return {select(is_less(0, largest), q_lrf_trf, kIdentityQ30), static_cast<std::uint32_t>(odds_ppm), share};
}

// Whether this rate turns the target by more than kLargestTurn_rad in this time.
bool turns_too_far(const Vector3<Fixed>& rate, Fixed periods) {
  const Vector3<Fixed> turn = scaled<Fixed>(rate, periods);
  return dot(turn, turn) > constant<Fixed>(kLargestTurn_rad * kLargestTurn_rad);
}

template <class N>
void reset_unless(bool kept, LstmState<N>& lstm) {
  for (auto& value : lstm.h) value = gnc::select(kept, value, {});
  for (auto& value : lstm.c) value = gnc::select(kept, value, {});
}

[[maybe_unused]] void add_to(Crc32& crc, const float* values, std::size_t count) {
  crc.add_f32(values, count);
}
void add_to(Crc32& crc, const Fixed* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) crc.add_u32(static_cast<std::uint32_t>(values[i].raw()));
}
void add_to(Crc32& crc, const std::int16_t* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) crc.add_u32(static_cast<std::uint32_t>(values[i]));
}

void add_to(Crc32& crc, const std::array<std::int32_t, 3>& values) {
  for (const std::int32_t value : values) crc.add_u32(static_cast<std::uint32_t>(value));
}
void add_to(Crc32& crc, const PoseTrackerState& state) {
  crc.add_u32(static_cast<std::uint32_t>(state.history.count));
  for (const PoseMeasurement& measurement : state.history.poses) {
    add_to(crc, measurement.pose.r_lrf_trf.data(), 9);
    add_to(crc, measurement.pose.origin_lrf_um);
    for (const std::int32_t value : measurement.information) crc.add_u32(static_cast<std::uint32_t>(value));
    crc.add_u32(static_cast<std::uint32_t>(measurement.age_ns));
    crc.add_u32(static_cast<std::uint32_t>(measurement.age_ns >> 32));
  }
  add_to(crc, state.motion.turning.r_lrf_trf.data(), 9);
  add_to(crc, state.motion.turning.rate_lrf.data(), 3);
  add_to(crc, state.motion.origin_lrf_um);
  add_to(crc, state.motion.velocity_um_period);
  crc.add_u32(static_cast<std::uint32_t>(state.motion_model));
  crc.add_u32(static_cast<std::uint32_t>(state.challenger));
  crc.add_u32(static_cast<std::uint32_t>(state.owes_comparison));
  crc.add_u32(static_cast<std::uint32_t>(state.llr_q8));
  crc.add_u32(static_cast<std::uint32_t>(state.conservative_llr_q8));
}

}  // namespace

template <class N>
ModelStatus AttitudeEstimator<N>::load(const std::uint8_t* image, std::size_t size_bytes,
                                       const char* expected_target) {
  const ModelStatus status =
      read_model_image<N>(image, size_bytes, expected_target, model_, network_.weights());
  if (status == ModelStatus::kOk) {
    motion_models_ = motion_models<Real>(converted<Real>(model_.inertia));
    surface_ = surface_of<N>(image);
    mesh_ = surface_mesh_of<N>(image);
    has_model_ = true;
    reset();
  }
  return status;
}

template <class N>
ModelStatus AttitudeEstimator<N>::check(const std::uint8_t* image, std::size_t size_bytes,
                                        const char* expected_target) const {
  return check_model_image<N>(image, size_bytes, expected_target, network_.weights());
}

template <class N>
void AttitudeEstimator<N>::reload(const std::uint8_t* image) {
  take_model_image<N>(image, model_, network_.weights());
  motion_models_ = motion_models<Real>(converted<Real>(model_.inertia));
  surface_ = surface_of<N>(image);
  mesh_ = surface_mesh_of<N>(image);
  network_.use(fastest_kernels<N>());
  has_model_ = true;
}

template <class N>
void AttitudeEstimator<N>::reset() {
  state_ = State{};
}

template <class N>
FrameStatus AttitudeEstimator<N>::step(const RangeImage& frame, const FrameInterval& interval,
                                       AttitudeEstimate& estimate, Deadline* deadline) {
  const DepthLoops& loops = fastest_depth_loops(network_.kernels().set);
  const FrameStatus status =
      make_depth_image(frame, model_.projection, memory_.projection(), depth_image(), loops);
  if (status != FrameStatus::kOk) return status;
  mask_ = memory_.projection().mask;
  // That of a depth image, which returns nothing; cppcheck takes it for this function.
  // cppcheck-suppress ignoredReturnValue
  step(depth_image(), interval, estimate);
  register_pose(frame, interval, deadline, estimate);
  return status;
}

template <class N>
void AttitudeEstimator<N>::register_pose(const RangeImage& frame, const FrameInterval& interval,
                                         [[maybe_unused]] Deadline* deadline, AttitudeEstimate& estimate) {
  if constexpr (N::kIsInteger) {
    const Motion<Real>& motion = state_.track.motion[estimate.motion_model];
    const PoseFrame pose_frame{frame,
                               mask_,
                               interval.elapsed_ns,
                               rotation_from_quaternion(interval.q_now_last),
                               {converted<Fixed>(motion.r_lrf_trf), converted<Fixed>(motion.rate_lrf)},
                               rotation_from_quaternion(estimate.q_lrf_trf_second),
                               estimate.second_odds_ppm,
                               estimate.centroid_lrf_mm,
                               motion_models_,
                               estimate.motion_model};
    track_pose({mesh_, model_.projection.target_radius_mm, model_.noise}, pose_frame, memory_.pose(),
               screen_vertices(), state_.pose, estimate.pose, WorkBudget::kOfAFrame, deadline);
    add_pose(estimate.pose, estimate.q_lrf_trf, estimate.evidence);
    const Matrix3<Fixed> attitude = rotation_from_quaternion(estimate.q_lrf_trf);
    if (estimate.evidence.has_pose && estimate.predicted_error_urad < kPi_urad)
      estimate.predicted_error_urad = error_urad(attitude, expected_error_rad(estimate.evidence));
  }
}

template <class N>
void AttitudeEstimator<N>::step(const DepthImage& image, const FrameInterval& interval,
                                AttitudeEstimate& estimate) {
  const TrackedAttitude<Real> tracked = follow(image, interval);
  describe(image, tracked, estimate);
  judge(image, tracked, estimate);
}

template <class N>
TrackedAttitude<typename N::Real> AttitudeEstimator<N>::follow(const DepthImage& image,
                                                               const FrameInterval& interval) {
  auto& [output, hypotheses, prediction, input, head] = intermediates_;
  if (interval.gives_up_track) reset();
  state_.track.forget_rate(interval.rate_is_unknown & !finds_no_rate(interval));
  network_.infer_frame(image, memory_.activations(), output);
  hypotheses = decode_hypotheses<Real>(output, converted<Real>(image.r_lrf_view));
  prediction = predict<Real>(state_.track, motion_models_, hypotheses, interval);
  if (finds_no_rate(interval))
    reset_unless<N>(keep_confirmed<Real>(hypotheses, interval, prediction, state_.track), state_.lstm);
  fill_lstm_input<N>(network_.features(), hypotheses, prediction.r_lrf_trf(), input);
  network_.infer_sequence(input, memory_.activations(), state_.lstm, head);
  return advance<Real>(hypotheses, prediction, head, state_.track);
}

template <class N>
void AttitudeEstimator<N>::describe(const DepthImage& image, const TrackedAttitude<Real>& tracked,
                                    AttitudeEstimate& estimate) const {
  const Hypotheses<Real>& hypotheses = intermediates_.hypotheses;
  const Prediction<Real>& prediction = intermediates_.prediction;
  const Matrix3<Fixed> single_frame = converted<Fixed>(mean_attitude<Real>(
      hypotheses.r_lrf_trf.data(), hypotheses.probability.data(), shape::kHypotheses, hypotheses.likeliest));
  estimate.q_lrf_trf = quaternion_from_rotation(converted<Fixed>(tracked.r_lrf_trf));
  estimate.q_lrf_trf_single_frame = quaternion_from_rotation(single_frame);
  estimate.predicted_error_single_frame_urad =
      error_urad(single_frame, converted<Fixed>(hypotheses.predicted_error_rad));
  estimate.frames_since_reset = state_.track.frames;
  estimate.motion_model = state_.track.motion_model();
  const Vector3<Fixed> rate = converted<Fixed>(state_.track.motion[estimate.motion_model].rate_lrf);
  const QuaternionQ30 predicted = quaternion_from_rotation(converted<Fixed>(prediction.r_lrf_trf()));
  estimate.q_lrf_trf_predicted = select(prediction.has_track, predicted, kIdentityQ30);
  estimate.has_prediction = prediction.has_track;
  estimate.rate_lrf_urad_s = rate_urad_s(rate);
  estimate.rate_is_ambiguous = prediction.has_track & turns_too_far(rate, prediction.elapsed_periods);
  estimate.centroid_lrf_mm = position_lrf_mm(image);
  estimate.pose = {};
}

template <class N>
void AttitudeEstimator<N>::judge(const DepthImage& image, const TrackedAttitude<Real>& tracked,
                                 AttitudeEstimate& estimate) {
  const auto& [output, hypotheses, prediction, input, head] = intermediates_;
  const Matrix3<Fixed> attitude = converted<Fixed>(tracked.r_lrf_trf);
  const Alternative second = second_of<Real>(hypotheses, tracked.r_lrf_trf);
  estimate.q_lrf_trf_second = second.q_lrf_trf;
  estimate.second_odds_ppm = second.odds_ppm;
  estimate.explained =
      inlier_ratios(image, model_.projection, model_.noise, attitude, surface_, memory_.inlier_ratios());
  const Fixed innovation_squared =
      constant<Fixed>(3.0) - trace_of_product(converted<Fixed>(prediction.r_lrf_trf()), attitude);
  const Fixed network_error_rad = converted<Fixed>(tracked.predicted_error_rad);
  estimate.evidence = {};
  estimate.evidence.network_error_rad = network_error_rad;
  estimate.evidence.network_logit = converted<Fixed>(head[2 * shape::kCandidates + 1]);
  estimate.evidence.misfit = misfit_of(estimate.explained);
  estimate.evidence.innovation_squared = select(prediction.has_track, innovation_squared, Fixed{});
  estimate.evidence.second_share = second.share;
  const Fixed error_rad = expected_error_rad(estimate.evidence);
  estimate.predicted_error_urad =
      error_urad(attitude, select(estimate.explained.is_known, error_rad, network_error_rad));
}

template <class N>
PropagatedMotion AttitudeEstimator<N>::propagated(const FrameInterval& interval) const {
  const int motion_model = state_.track.motion_model();
  const Motion<Real> later = turned<Real>(
      propagate<Real>(state_.track.motion[motion_model], motion_models_[motion_model], interval.elapsed_ns),
      converted<Real>(rotation_from_quaternion(interval.q_now_last)));
  return {quaternion_from_rotation(converted<Fixed>(later.r_lrf_trf)),
          rate_urad_s(converted<Fixed>(later.rate_lrf))};
}

template <class N>
PoseState AttitudeEstimator<N>::propagated_pose(const FrameInterval& interval) const {
  if constexpr (N::kIsInteger) {
    return pose_state(later_pose(state_.pose, motion_models_, interval.elapsed_ns,
                                 rotation_from_quaternion(interval.q_now_last)));
  } else {
    return {};
  }
}

template <class N>
std::uint32_t AttitudeEstimator<N>::crc32_of(const State& state) {
  Crc32 crc;
  add_to(crc, state.lstm.h.data(), state.lstm.h.size());
  add_to(crc, state.lstm.c.data(), state.lstm.c.size());
  for (const Motion<Real>& motion : state.track.motion) {
    add_to(crc, motion.r_lrf_trf.data(), 9);
    add_to(crc, motion.rate_lrf.data(), 3);
  }
  add_to(crc, state.track.log_likelihood.data(), state.track.log_likelihood.size());
  crc.add_u32(state.track.frames);
  add_to(crc, state.pose);
  return crc.value();
}

template <class N>
std::uint32_t AttitudeEstimator<N>::constants_crc32() const {
  Crc32 crc;
  const auto add = [&crc](const auto& object) {
    crc.add(reinterpret_cast<const std::uint8_t*>(&object), sizeof object);
  };
  if constexpr (N::kIsInteger) {
    for_each_tensor(network_.weights(),
                    [&add](const char*, const char*, const auto& tensor) { add(tensor); });
  }
  add(reinterpret_cast<std::uintptr_t>(&network_.kernels()));
  add(model_);
  add(motion_models_);
  add(surface_);
  add(mesh_);
  add(has_model_);
  return crc.value();
}

template class AttitudeEstimator<FixedPoint>;
#if TUMBLESIGHT_FLOAT32
template class AttitudeEstimator<Float32>;
#endif

}  // namespace tumblesight::gnc
