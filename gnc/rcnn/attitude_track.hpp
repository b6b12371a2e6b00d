// AttitudeTrack: the motion carried from frame to frame. Each frame, the attitude where the motion seen so
// far leads is one more candidate beside the frame's hypotheses; the recurrent network says which of them to
// believe and how much, by correcting the gains of a filter for smooth rotation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "gnc/attitude/motion.hpp"
#include "gnc/rcnn/hypotheses.hpp"

namespace tumblesight::gnc {

// Several laws of motion are followed side by side; the one that has predicted best so far speaks. With less
// evidence than this, a target is taken to spin, and to have the inertia that is known of it: where laws say
// the same, rounding must not decide.
inline constexpr std::array<float, kLaws> kEvidenceAsked{0.0F, 0.5F, 2.0F, 2.0F, 2.0F};

struct AttitudeTrack {
  std::array<Motion, kLaws> motion;           // at the last frame, by each law
  std::array<float, kLaws> log_likelihood{};  // of each law; 0 the likeliest one's, the others' below
  std::uint32_t frames = 0;                   // since the reset

  int law() const;  // the one that speaks
};

struct Prediction {
  std::array<Motion, kLaws> motion;
  int law = kSpinLaw;
  const Eigen::Matrix3f& r_lrf_trf() const { return motion[law].r_lrf_trf; }
};

struct TrackedAttitude {
  Eigen::Matrix3f r_lrf_trf;
  float predicted_error_rad;  // 0..pi
};

// For the frame that the hypotheses are of. Without a track (before the first frame, or when it is not
// finite) the likeliest hypothesis, at rest.
Prediction predict(const AttitudeTrack& track, const MotionLaws& laws, const Hypotheses& hypotheses);

// What the LSTM gets: dense2's output; for every hypothesis the first two columns of its turn relative to the
// predicted attitude, in the TRF, where the alternatives of a symmetric target stand still; the
// probabilities; the predicted attitude's first two columns.
void fill_lstm_input(const layers::Dense2::Output& features, const Hypotheses& hypotheses,
                     const Eigen::Matrix3f& predicted_r_lrf_trf, layers::Recurrent::Input& input);

// Fuses hypotheses and prediction by the recurrent head's word and moves the track on.
TrackedAttitude advance(const Hypotheses& hypotheses, const Prediction& prediction,
                        const layers::Head2::Output& head, AttitudeTrack& track);

}  // namespace tumblesight::gnc
