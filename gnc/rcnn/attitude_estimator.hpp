// AttitudeEstimator: the RCNN with its explicit state, from LiDAR frames to attitudes, in the numerics N
// (Float32 or FixedPoint).
#pragma once

#include <cstddef>
#include <cstdint>

#include "gnc/lidar/depth_image.hpp"
#include "gnc/rcnn/attitude_track.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

inline constexpr std::uint32_t kPi_urad = 3'141'593;

// One attitude, of the frame just given, in integers whatever the numerics. Quaternions are Hamilton, unit,
// scalar first and not negative, with 30 bits behind the point, and take the target frame (TRF) to the LiDAR
// frame (LRF): v_lrf = q_lrf_trf * v_trf.
struct AttitudeEstimate {
  QuaternionQ30 q_lrf_trf = kIdentityQ30;               // from all frames since the reset (RCNN)
  std::uint32_t predicted_error_urad = kPi_urad;        // expected angular error of q_lrf_trf
  QuaternionQ30 q_lrf_trf_single_frame = kIdentityQ30;  // from this frame alone (CNN)
  std::uint32_t predicted_error_single_frame_urad = kPi_urad;
  std::uint32_t frames_since_reset = 0;  // 1 for the first frame of a track
};

// Owns activations and state, and float32 weights; weights in fixed point are read where the model image
// lies, which has to stay there. No allocation; place it in static storage.
template <class N>
class AttitudeEstimator {
 public:
  using Real = typename N::Real;

  // What one frame leaves behind for the next: all that save() and restore() have to carry.
  struct State {
    LstmState<N> lstm;
    AttitudeTrack<Real> track;
  };

  // Validates the whole image first; on any error the model loaded before, if any, stays in use.
  // `expected_target`: NUL-terminated target name, or nullptr to accept any. On success the state is reset.
  [[nodiscard]] ModelStatus load(const std::uint8_t* image, std::size_t size_bytes,
                                 const char* expected_target);
  // Whether load() would take the image; nothing is changed.
  [[nodiscard]] ModelStatus check(const std::uint8_t* image, std::size_t size_bytes,
                                  const char* expected_target) const;
  // Takes the loaded image over once more, wherever it lies now; the state goes on. For what memory has lost:
  // the image has to be the one that is loaded, unchanged, which is not looked at again.
  void reload(const std::uint8_t* image);
  bool has_model() const { return has_model_; }
  const ModelHeader& model() const { return model_; }

  void reset();
  // Not kOk: the frame is refused, estimate and state are untouched. Requires has_model().
  [[nodiscard]] FrameStatus step(const RangeImage& frame, AttitudeEstimate& estimate);
  // The same from a ready depth image (tests, training, evaluation).
  void step(const DepthImage& image, AttitudeEstimate& estimate);

  void save(State& state) const { state = state_; }
  void restore(const State& state) { state_ = state; }
  std::uint32_t state_crc32() const { return crc32_of(state_); }
  static std::uint32_t crc32_of(const State& state);
  // Over all that load() has set and no step changes, byte by byte as this processor holds it; float32's
  // weights are left out.
  std::uint32_t constants_crc32() const;
  const DepthImage& depth_image() const { return image_; }
  Network<N>& network() { return network_; }

 private:
  // What one frame's stages hand on: here, so that the stack stays small.
  struct Passed {
    OutputVector<Real> output;
    Hypotheses<Real> hypotheses;
    Prediction<Real> prediction;
    LstmInput<N> input;
    HeadOutput<Real> head;
  };

  Network<N> network_;
  State state_;
  Passed passed_;
  ModelHeader model_;
  MotionLaws<Real> laws_;
  DepthImage image_;
  bool has_model_ = false;
};

}  // namespace tumblesight::gnc
