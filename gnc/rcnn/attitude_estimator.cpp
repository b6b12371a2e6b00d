#include "gnc/rcnn/attitude_estimator.hpp"

#include "gnc/rcnn/crc32.hpp"
#include "gnc/rcnn/output_decoder.hpp"

namespace tumblesight::gnc {

ModelStatus AttitudeEstimator::load(const std::uint8_t* image, std::size_t size_bytes,
                                    const char* expected_target) {
  const ModelStatus status = read_model_image(image, size_bytes, expected_target, model_, network_.weights());
  if (status == ModelStatus::kOk) {
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
  OutputVector single_frame_out;
  OutputVector rcnn_out;
  network_.infer(image, state_.lstm, single_frame_out, rcnn_out);
  ++state_.frames_since_reset;

  const DecodedAttitude from_sequence = decode_output(rcnn_out);
  const DecodedAttitude from_frame = decode_output(single_frame_out);
  estimate.q_lrf_trf = from_sequence.q_lrf_trf;
  estimate.predicted_error_rad = from_sequence.predicted_error_rad;
  estimate.q_lrf_trf_single_frame = from_frame.q_lrf_trf;
  estimate.predicted_error_single_frame_rad = from_frame.predicted_error_rad;
  estimate.frames_since_reset = state_.frames_since_reset;
}

std::uint32_t AttitudeEstimator::state_crc32() const {
  Crc32 crc;
  crc.add_f32(state_.lstm.h.data(), state_.lstm.h.size());
  crc.add_f32(state_.lstm.c.data(), state_.lstm.c.size());
  crc.add_u32(state_.frames_since_reset);
  return crc.value();
}

}  // namespace tumblesight::gnc
