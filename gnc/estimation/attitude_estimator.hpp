// AttitudeEstimator: the RCNN with its explicit state, from LiDAR frames to attitudes. N: Float32 or
// FixedPoint.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/estimation/expected_error.hpp"
#include "gnc/estimation/working_memory.hpp"
#include "gnc/lidar/depth_image.hpp"
#include "gnc/rcnn/attitude_track.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "gnc/rcnn/network.hpp"
#include "gnc/registration/inlier_ratios.hpp"
#include "gnc/registration/pose_tracker.hpp"

namespace tumblesight::gnc {

inline constexpr std::uint32_t kPi_urad = 3'141'593;

// The attitude at one frame, in integers for both numerics. Quaternions are unit, Hamilton, scalar first with
// w >= 0, in Q1.30, and take the target frame (TRF) to the LiDAR frame (LRF): v_lrf = q_lrf_trf * v_trf.
struct AttitudeEstimate {
  QuaternionQ30 q_lrf_trf = kIdentityQ30;  // from all frames since reset (RCNN)
  // Expected angular error of q_lrf_trf, 0..pi: expected_error_rad() where the surface is known, else the
  // network's.
  std::uint32_t predicted_error_urad = kPi_urad;
  QuaternionQ30 q_lrf_trf_single_frame = kIdentityQ30;  // from this frame alone (CNN)
  std::uint32_t predicted_error_single_frame_urad = kPi_urad;
  std::uint32_t frames_since_reset = 0;  // 1 for the first frame of a track
  // The attitude that the track predicted for this frame, before it was seen; the identity and false for the
  // first frame of a track.
  QuaternionQ30 q_lrf_trf_predicted = kIdentityQ30;
  bool has_prediction = false;
  std::array<std::int32_t, 3> rate_lrf_urad_s{};  // angular rate of the target relative to the inertial frame
  // The target has turned by more than kLargestTurn_rad since the last frame, so that the rate may be another
  // one that leads to the same attitude.
  bool rate_is_ambiguous = false;
  int motion_model = kSpinModel;  // that gives the attitude and the rate
  // The likeliest hypothesis of this frame that is another attitude than q_lrf_trf, and its probability over
  // that of the hypotheses that are the same attitude. Odds of 0: there is none.
  QuaternionQ30 q_lrf_trf_second = kIdentityQ30;
  std::uint32_t second_odds_ppm = 0;
  std::array<std::int32_t, 3> centroid_lrf_mm{};  // of the returns
  ErrorEvidence evidence;                         // behind the expected error
  InlierRatios explained;  // of this frame, by the target at q_lrf_trf; not known in float32
  PoseEstimate pose;       // registered; not known in float32
};

// The motion of the target in the LRF, in integers.
struct PropagatedMotion {
  QuaternionQ30 q_lrf_trf = kIdentityQ30;
  std::array<std::int32_t, 3> rate_lrf_urad_s{};
};

// Owns the activations, the state and float32 weights. Fixed-point weights are read in place from the model
// image, which must stay valid and unchanged at its address. No allocation. Up to 144 KiB: place it in static
// storage.
template <class N>
class AttitudeEstimator {
 public:
  using Real = typename N::Real;

  // Everything that is carried from one frame to the next.
  struct State {
    LstmState<N> lstm;
    AttitudeTrack<Real> track;
    PoseTrackerState pose;
  };

  // Validates the whole image, then uses it and resets the state. On any error the model loaded before, if
  // any, stays in use. `expected_target`: NUL-terminated target name, or nullptr to accept any.
  [[nodiscard]] ModelStatus load(const std::uint8_t* image, std::size_t size_bytes,
                                 const char* expected_target);
  // The status that load() would return; changes nothing.
  [[nodiscard]] ModelStatus check(const std::uint8_t* image, std::size_t size_bytes,
                                  const char* expected_target) const;
  // Repairs damaged memory: derives everything again from the loaded image, now at `image`, and keeps the
  // state. The image must be the loaded one, unchanged; it is not validated again.
  void reload(const std::uint8_t* image);
  bool has_model() const { return has_model_; }
  const ModelHeader& model() const { return model_; }
  // The target's surface in the loaded image; without triangles in float32.
  const SurfaceMesh& mesh() const { return mesh_; }

  // Forgets all frames seen so far.
  void reset();
  std::uint32_t frames() const { return state_.track.frames; }  // since reset
  // Processes one frame, `interval` after the last one. On any status except kOk the frame is refused;
  // `estimate` and the state are unchanged. Requires has_model(). `deadline`: of the registration, or
  // nullptr.
  [[nodiscard]] FrameStatus step(const RangeImage& frame, const FrameInterval& interval,
                                 AttitudeEstimate& estimate, Deadline* deadline = nullptr);
  // The same from a depth image (tests, training, evaluation); without a pose.
  void step(const DepthImage& image, const FrameInterval& interval, AttitudeEstimate& estimate);
  // One nominal period after the last frame, without a turn of the chaser.
  [[nodiscard]] FrameStatus step(const RangeImage& frame, AttitudeEstimate& estimate) {
    return step(frame, {}, estimate);
  }
  void step(const DepthImage& image, AttitudeEstimate& estimate) { step(image, {}, estimate); }

  // The motion of the track `interval` after the last frame; changes nothing. Requires frames() > 0.
  PropagatedMotion propagated(const FrameInterval& interval) const;
  // The registered pose at the same time; without a meaning as long as there is none.
  PoseState propagated_pose(const FrameInterval& interval) const;

  void save(State& state) const { state = state_; }
  void restore(const State& state) { state_ = state; }
  std::uint32_t state_crc32() const { return crc32_of(state_); }
  static std::uint32_t crc32_of(const State& state);
  // CRC of everything that load() sets and no step changes, except float32 weights. Computed over the memory
  // of this processor: the value differs between processors.
  std::uint32_t constants_crc32() const;
  Network<N>& network() { return network_; }
  WorkingMemory<N>& working_memory() { return memory_; }  // rewritten in every frame

 private:
  // The parts of a step. Network and track:
  TrackedAttitude<Real> follow(const DepthImage& image, const FrameInterval& interval);
  // What they say of the frame.
  void describe(const DepthImage& image, const TrackedAttitude<Real>& tracked,
                AttitudeEstimate& estimate) const;
  // How well the target at the attitude explains the frame, and by how much the attitude may be wrong.
  void judge(const DepthImage& image, const TrackedAttitude<Real>& tracked, AttitudeEstimate& estimate);
  // Registers the frame of `estimate`, whose depth image and mask are in use, and lets the pose judge its
  // attitude.
  void register_pose(const RangeImage& frame, const FrameInterval& interval, Deadline* deadline,
                     AttitudeEstimate& estimate);

  // Results of the stages of a frame; members, to keep the stack small.
  struct Intermediates {
    OutputVector<Real> output;
    Hypotheses<Real> hypotheses;
    Prediction<Real> prediction;
    LstmInput<N> input;
    HeadOutput<Real> head;
  };

  // Registration begins when the depth image has been used.
  DepthImage& depth_image() { return in_place<DepthImage>(frame_memory_); }
  ScreenVertices& screen_vertices() { return in_place<ScreenVertices>(frame_memory_); }

  Network<N> network_;
  WorkingMemory<N> memory_;
  State state_;
  Intermediates intermediates_;
  ModelHeader model_;
  MotionModels<Real> motion_models_;
  SurfaceModel surface_;  // in the model image, as is mesh_
  SurfaceMesh mesh_;
  RayMask mask_;  // of the frame
  alignas(64) std::array<std::byte, std::max(sizeof(DepthImage), sizeof(ScreenVertices))> frame_memory_;
  bool has_model_ = false;
};

}  // namespace tumblesight::gnc
