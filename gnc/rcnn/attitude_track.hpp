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

// Two laws of motion are followed side by side: a spin constant in the LRF (the paper's sequences) and
// torque-free rotation (its tumbling test). The one that has predicted better so far speaks.
enum class Law : std::uint8_t { kSpin = 0, kTumble = 1 };
inline constexpr int kLaws = 2;
// With less evidence a target is taken to spin: where both laws say the same, rounding must not decide.
inline constexpr float kEvidenceToTumble = 0.5F;

struct AttitudeTrack {
  std::array<Motion, kLaws> motion;  // at the last frame, by each law
  float tumble_evidence = 0.0F;      // log-likelihood ratio of kTumble over kSpin
  std::uint32_t frames = 0;          // since the reset

  Law law() const { return tumble_evidence > kEvidenceToTumble ? Law::kTumble : Law::kSpin; }
};

struct Prediction {
  std::array<Motion, kLaws> motion;
  Law law = Law::kSpin;
  const Eigen::Matrix3f& r_lrf_trf() const { return motion[static_cast<int>(law)].r_lrf_trf; }
};

struct TrackedAttitude {
  Eigen::Matrix3f r_lrf_trf;
  float predicted_error_rad;  // 0..pi
};

// For the frame that the hypotheses are of. Without a track (before the first frame, or when it is not
// finite) the likeliest hypothesis, at rest.
Prediction predict(const AttitudeTrack& track, const Inertia& inertia, const Hypotheses& hypotheses);

// What the LSTM gets: dense2's output; for every hypothesis the first two columns of its turn relative to the
// predicted attitude, in the TRF, where the alternatives of a symmetric target stand still; the
// probabilities; the predicted attitude's first two columns.
void fill_lstm_input(const layers::Dense2::Output& features, const Hypotheses& hypotheses,
                     const Eigen::Matrix3f& predicted_r_lrf_trf, layers::Recurrent::Input& input);

// Fuses hypotheses and prediction by the recurrent head's word and moves the track on.
TrackedAttitude advance(const Hypotheses& hypotheses, const Prediction& prediction,
                        const layers::Head2::Output& head, AttitudeTrack& track);

}  // namespace tumblesight::gnc
