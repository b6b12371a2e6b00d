#include "gnc/rcnn/attitude_estimator.hpp"

#include <cmath>

#include "gnc/attitude/rotation.hpp"
#include "gnc/rcnn/crc32.hpp"
#include "gnc/rcnn/hypotheses.hpp"

namespace tumblesight::gnc {
namespace {

constexpr float kPi = 3.14159265F;

// Of what is no rotation, as damaged weights or state may make it, nothing is expected.
float error_of(const Eigen::Matrix3f& attitude, float predicted_rad) {
  const float trace = trace_of_transpose_product(attitude, attitude);
  return std::abs(trace - 3.0F) < 0.1F ? predicted_rad : kPi;
}

}  // namespace

ModelStatus AttitudeEstimator::load(const std::uint8_t* image, std::size_t size_bytes,
                                    const char* expected_target) {
  const ModelStatus status = read_model_image(image, size_bytes, expected_target, model_, network_.weights());
  if (status == ModelStatus::kOk) {
    laws_ = motion_laws(model_.inertia);
    has_model_ = true;
    reset();
  }
  return status;
}

void AttitudeEstimator::reset() {
  state_ = State{};
}

FrameStatus AttitudeEstimator::step(const RangeImage& frame, AttitudeEstimate& estimate) {
  const FrameStatus status = make_depth_image(frame, model_.projection, scratch_, image_);
  if (status == FrameStatus::kOk) step(image_, estimate);
  return status;
}

void AttitudeEstimator::step(const DepthImage& image, AttitudeEstimate& estimate) {
  OutputVector output;
  network_.infer_frame(image, output);
  const Hypotheses hypotheses = hypotheses_of(output, image.r_lrf_view);
  const Prediction prediction = predict(state_.track, laws_, hypotheses);

  layers::Recurrent::Input input;
  layers::Head2::Output head;
  fill_lstm_input(network_.features(), hypotheses, prediction.r_lrf_trf(), input);
  network_.infer_sequence(input, state_.lstm, head);
  const TrackedAttitude tracked = advance(hypotheses, prediction, head, state_.track);

  const Eigen::Matrix3f single_frame = mean_attitude(
      hypotheses.r_lrf_trf.data(), hypotheses.probability.data(), shape::kHypotheses, hypotheses.likeliest);
  estimate.q_lrf_trf = quaternion_from_rotation(tracked.r_lrf_trf);
  estimate.predicted_error_rad = error_of(tracked.r_lrf_trf, tracked.predicted_error_rad);
  estimate.q_lrf_trf_single_frame = quaternion_from_rotation(single_frame);
  estimate.predicted_error_single_frame_rad = error_of(single_frame, hypotheses.predicted_error_rad);
  estimate.frames_since_reset = state_.track.frames;
}

std::uint32_t AttitudeEstimator::state_crc32() const {
  Crc32 crc;
  crc.add_f32(state_.lstm.h.data(), state_.lstm.h.size());
  crc.add_f32(state_.lstm.c.data(), state_.lstm.c.size());
  for (const Motion& motion : state_.track.motion) {
    crc.add_f32(motion.r_lrf_trf.data(), 9);
    crc.add_f32(motion.rate_lrf.data(), 3);
  }
  crc.add_f32(state_.track.log_likelihood.data(), state_.track.log_likelihood.size());
  crc.add_u32(state_.track.frames);
  return crc.value();
}

}  // namespace tumblesight::gnc
