// AttitudeEstimator: the RCNN with its explicit state, from LiDAR frames to attitudes.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/rcnn/attitude_track.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

// One attitude, of the frame just given. Quaternions are Hamilton, unit, with a non-negative scalar part, and
// take the target frame (TRF) to the LiDAR frame (LRF): v_lrf = q_lrf_trf * v_trf.
struct AttitudeEstimate {
  Eigen::Quaternionf q_lrf_trf{1.0F, 0.0F, 0.0F, 0.0F};  // from all frames since the reset (RCNN)
  float predicted_error_rad = 3.14159265F;               // expected angular error of q_lrf_trf
  Eigen::Quaternionf q_lrf_trf_single_frame{1.0F, 0.0F, 0.0F, 0.0F};  // from this frame alone (CNN)
  float predicted_error_single_frame_rad = 3.14159265F;
  std::uint32_t frames_since_reset = 0;  // 1 for the first frame of a track
};

// Owns weights, activations and LSTM state; no allocation. About 6 MB: place it in static storage.
class AttitudeEstimator {
 public:
  // What one frame leaves behind for the next: all that save() and restore() have to carry.
  struct State {
    LstmState lstm;
    AttitudeTrack track;
  };

  // Validates the whole image first; on any error the model loaded before, if any, stays in use.
  // `expected_target`: NUL-terminated target name, or nullptr to accept any. On success the state is reset.
  [[nodiscard]] ModelStatus load(const std::uint8_t* image, std::size_t size_bytes,
                                 const char* expected_target);
  bool has_model() const { return has_model_; }
  const ModelHeader& model() const { return model_; }

  void reset();
  // Not kOk: the frame is refused, estimate and state are untouched. Requires has_model().
  [[nodiscard]] FrameStatus step(const RangeImage& frame, AttitudeEstimate& estimate);
  // The same from a ready depth image (tests, training, evaluation).
  void step(const DepthImage& image, AttitudeEstimate& estimate);

  void save(State& state) const { state = state_; }
  void restore(const State& state) { state_ = state; }
  std::uint32_t state_crc32() const;
  const DepthImage& depth_image() const { return image_; }

 private:
  Network network_;
  State state_;
  ModelHeader model_;
  MotionLaws laws_;
  DepthImage image_;
  DepthImageScratch scratch_;
  bool has_model_ = false;
};

}  // namespace tumblesight::gnc
