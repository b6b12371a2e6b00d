// AttitudeTrack: the motion of the target, carried from frame to frame. The attitude predicted from the
// motion so far is one more candidate besides the hypotheses of a frame. A filter for smooth rotation
// combines them; the recurrent network corrects the choice of the candidate, the weights and the gain of the
// filter. Real: float or Fixed (Q7.24).
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/motion.hpp"
#include "gnc/rcnn/hypotheses.hpp"

namespace tumblesight::gnc {

// All motion models (motion.hpp) are followed in parallel, and the one that has predicted best so far gives
// the result. A motion model needs this much more log-likelihood than the others: with less evidence the
// target is assumed to spin, then to have its nominal inertia. Otherwise rounding would decide between motion
// models that predict the same.
inline constexpr std::array<double, kMotionModels> kRequiredEvidence{0.0, 0.5, 2.0, 2.0, 2.0};

// From one frame to the next. Default: one nominal period of a chaser that does not turn.
struct FrameInterval {
  std::int64_t elapsed_ns = kNominalPeriod_ns;  // between the exposures
  QuaternionQ30 q_now_last = kIdentityQ30;      // turn of the chaser: v_lrf now = q_now_last v_lrf last
  bool gives_up_track = false;                  // the frame starts a new track
  bool rate_is_unknown = false;  // no frame of the track came within kLongestToFindRate_ns of the one before
};
// The track takes times outside these two for the nearer one. Between frames that are closer in time the
// noise of the attitudes says more than their difference.
inline constexpr std::int64_t kShortestInterval_ns = 100'000'000;
inline constexpr std::int64_t kLongestInterval_ns = kLongestPropagation_ns;

// The track follows the target while it turns by less than 150 degrees from frame to frame.
inline constexpr double kLargestTurn_rad = 2.6179938779914944;
// In this time the fastest target of the training data (20 degrees/s) turns by kLargestTurn_rad. Two
// attitudes that are farther apart in time do not tell its rate: it may have turned the other way or once
// more.
inline constexpr std::int64_t kLongestToFindRate_ns = 7'500'000'000;
inline bool finds_no_rate(const FrameInterval& interval) {
  return interval.rate_is_unknown & (interval.elapsed_ns > kLongestToFindRate_ns);
}

template <class Real>
struct AttitudeTrack {
  std::array<Motion<Real>, kMotionModels>
      motion;  // at the last frame, for each motion model; in the LRF of that frame
  std::array<Real, kMotionModels>
      log_likelihood{};      // of each motion model: 0 for the likeliest, negative for the others
  std::uint32_t frames = 0;  // since reset

  int motion_model() const;  // index of the motion model that gives the result
  // If `forgets`, begins again at the last attitude, as after the first frame.
  void forget_rate(bool forgets);
};

// The motion of each motion model, propagated to the current frame, in the LRF of that frame.
template <class Real>
struct Prediction {
  std::array<Motion<Real>, kMotionModels> motion;
  int motion_model = kSpinModel;
  Fixed elapsed_periods = constant<Fixed>(1.0);  // since the last frame
  bool has_track = false;                        // false: the prediction says nothing about this frame
  const Matrix3<Real>& r_lrf_trf() const { return motion[motion_model].r_lrf_trf; }
};

template <class Real>
struct TrackedAttitude {
  Matrix3<Real> r_lrf_trf;
  Real predicted_error_rad;  // 0..pi
};

// Predicts the motion at the frame that `hypotheses` belong to, `interval` after the last one. Without a
// valid track (before the first frame, or if the state is damaged: not finite, or not a rotation) the
// prediction is the likeliest hypothesis, at rest.
template <class Real>
Prediction<Real> predict(const AttitudeTrack<Real>& track, const MotionModels<Real>& motion_models,
                         const Hypotheses<Real>& hypotheses, const FrameInterval& interval = {});

// For a frame that finds_no_rate(). If the hypotheses do not confirm the prediction, the track starts anew:
// the frame is its first one, with the slowest rate that leads from the last attitude to this frame's
// likeliest. So a prediction with a wrong rate cannot spoil the attitude, and a slow target is followed.
// False: the track was started anew, and the state of the LSTM must be reset.
template <class Real>
bool keep_confirmed(const Hypotheses<Real>& hypotheses, const FrameInterval& interval,
                    Prediction<Real>& prediction, AttitudeTrack<Real>& track);

// Fills the input of the LSTM: the output of dense2; for each hypothesis the first two columns of its
// rotation relative to the predicted attitude, expressed in the TRF, where the alternatives of a symmetric
// target are constant; the probabilities; the first two columns of the predicted attitude.
template <class N>
void fill_lstm_input(const Features<N>& features, const Hypotheses<typename N::Real>& hypotheses,
                     const Matrix3<typename N::Real>& predicted_r_lrf_trf, LstmInput<N>& input);

// Combines the hypotheses and the prediction of a frame into the attitude, and advances `track` to that
// frame.
//
// head   corrections from the recurrent network, layout in network_shape.hpp (kHeadOutput)
// track  a damaged track is reset first
template <class Real>
TrackedAttitude<Real> advance(const Hypotheses<Real>& hypotheses, const Prediction<Real>& prediction,
                              const HeadOutput<Real>& head, AttitudeTrack<Real>& track);

}  // namespace tumblesight::gnc
