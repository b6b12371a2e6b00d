// AttitudeTrack: the motion carried from frame to frame. Each frame, the attitude where the motion seen so
// far leads is one more candidate beside the frame's hypotheses; the recurrent network says which of them to
// believe and how much, by correcting the gains of a filter for smooth rotation. Real: float or Fixed.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/motion.hpp"
#include "gnc/rcnn/hypotheses.hpp"

namespace tumblesight::gnc {

// Several laws of motion are followed side by side; the one that has predicted best so far speaks. With less
// evidence than this, a target is taken to spin, and to have the inertia that is known of it: where laws say
// the same, rounding must not decide.
inline constexpr std::array<double, kLaws> kEvidenceAsked{0.0, 0.5, 2.0, 2.0, 2.0};

template <class Real>
struct AttitudeTrack {
  std::array<Motion<Real>, kLaws> motion;    // at the last frame, by each law
  std::array<Real, kLaws> log_likelihood{};  // of each law; 0 the likeliest one's, the others' below
  std::uint32_t frames = 0;                  // since the reset

  int law() const;  // the one that speaks
};

template <class Real>
struct Prediction {
  std::array<Motion<Real>, kLaws> motion;
  int law = kSpinLaw;
  const Matrix3<Real>& r_lrf_trf() const { return motion[law].r_lrf_trf; }
};

template <class Real>
struct TrackedAttitude {
  Matrix3<Real> r_lrf_trf;
  Real predicted_error_rad;  // 0..pi
};

// For the frame that the hypotheses are of. Without a track (before the first frame, or when it is not
// finite) the likeliest hypothesis, at rest.
template <class Real>
Prediction<Real> predict(const AttitudeTrack<Real>& track, const MotionLaws<Real>& laws,
                         const Hypotheses<Real>& hypotheses);

// What the LSTM gets: dense2's output; for every hypothesis the first two columns of its turn relative to the
// predicted attitude, in the TRF, where the alternatives of a symmetric target stand still; the
// probabilities; the predicted attitude's first two columns.
template <class N>
void fill_lstm_input(const Features<N>& features, const Hypotheses<typename N::Real>& hypotheses,
                     const Matrix3<typename N::Real>& predicted_r_lrf_trf, LstmInput<N>& input);

// Fuses hypotheses and prediction by the recurrent head's word and moves the track on.
template <class Real>
TrackedAttitude<Real> advance(const Hypotheses<Real>& hypotheses, const Prediction<Real>& prediction,
                              const HeadOutput<Real>& head, AttitudeTrack<Real>& track);

}  // namespace tumblesight::gnc
