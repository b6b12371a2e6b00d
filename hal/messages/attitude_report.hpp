// AttitudeReport: the result of one cycle.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::hal {

// Whether the attitudes of a report can be used. For every value except kValid and kDoubtful the attitudes
// are the identity with an expected error of pi, and exposure time, sequence number and frames_since_reset
// are 0.
enum class Validity : std::uint8_t {
  kValid = 0,
  kStandby = 1,       // the mode is not RUN
  kNoFrame = 2,       // no frame arrived in this cycle
  kFrameRefused = 3,  // a frame arrived and was refused; the event gives the reason
  kDoubtful =
      4,  // the expected error is too large, the attitude has jumped, or the frame shows something else
  kPassedOver = 5,  // a frame arrived in a cycle with a long task, for example a repair
};

// Bits of AttitudeReport::doubts.
inline constexpr std::uint8_t kDoubtErrorLarge = 1;     // kDoubtful: expected error above its limit
inline constexpr std::uint8_t kDoubtAttitudeJump = 2;   // kDoubtful: in this frame or the one before
inline constexpr std::uint8_t kDoubtRateAmbiguous = 8;  // the target turns too far between two frames
inline constexpr std::uint8_t kDoubtChaserUnknown =
    16;  // in the whole track, in which it is taken not to turn
inline constexpr std::uint8_t kDoubtChaserNowUnknown = 32;  // q_lrf_trf_now is in the LRF of the exposure
inline constexpr std::uint8_t kDoubtUnexplained =
    64;  // kDoubtful: the target at this attitude does not explain the frame

// Bits of AttitudeReport::pose_doubts: why the pose is not verified. 0: it is.

// There is none: the model image has no surface of the target, the target is nearer than two of its radii or
// 1 m, or this frame could not be registered and the track has no pose before it.
inline constexpr std::uint8_t kPoseDoubtUnknown = 1;
// It is predicted from the poses before, since this frame could not be registered.
inline constexpr std::uint8_t kPoseDoubtCoasts = 2;
// The ranges do not lie on the target's surface, or none could be compared with it.
inline constexpr std::uint8_t kPoseDoubtRanges = 4;
// More than 3 % of the returns are beside the target, more than 69 % of its rays have no return or meet a
// dark surface, or more than an eighth of the rays next to its silhouette are not as drawn.
inline constexpr std::uint8_t kPoseDoubtOutline = 8;
// The proven advantage over other attitudes is less than 8 nats: one explains the frames about as well, none
// could be compared fairly, or the track is too new. Or another attitude explains this frame better by more
// than 6 nats, or budget or deadline did not allow for the registration or its comparison.
inline constexpr std::uint8_t kPoseDoubtAmbiguous = 16;
// There are fewer than three poses, they or the newest of them do not follow one motion, or no two
// consecutive ones are within 7.5 s, so that the rate may be one turn more or less.
inline constexpr std::uint8_t kPoseDoubtMotion = 32;
// A standard deviation of the attitude is above a degree.
inline constexpr std::uint8_t kPoseDoubtUncertain = 64;
// The network's attitude, q_lrf_trf, is more than 20 degrees away.
inline constexpr std::uint8_t kPoseDoubtNetwork = 128;

// Quaternions: Hamilton, scalar first (w, x, y, z), target frame (TRF) to LiDAR frame (LRF), unit norm, Q30.
// Expected errors: 0 ... pi.
struct AttitudeReport {
  std::int64_t time_ns = 0;           // cycle time
  std::int64_t exposure_time_ns = 0;  // of the frame that gave the attitude
  std::uint32_t sequence_number = 0;  // of that frame
  Validity validity = Validity::kValid;
  std::uint32_t frames_since_reset = 0;
  std::array<std::int32_t, 4> q_lrf_trf{1 << 30, 0, 0, 0};  // from all frames since the reset
  std::uint32_t predicted_error_urad = 0;
  std::array<std::int32_t, 4> q_lrf_trf_single_frame{1 << 30, 0, 0, 0};  // from the last frame alone
  std::uint32_t predicted_error_single_frame_urad = 0;
  std::uint8_t doubts = 0;  // why the attitude is doubtful, or what is missing from it
  std::uint8_t law = 0;     // of motion, in use: gnc/attitude/motion.hpp
  // Angular rate of the target relative to the inertial frame, and the covariances of attitude and rate at
  // the exposure: estimates from the expected error (gnc/estimation/covariance.hpp).
  std::array<std::int32_t, 3> rate_lrf_urad_s{};
  std::array<std::int32_t, 6> attitude_covariance_e8{};  // xx, xy, xz, yy, yz, zz [1e-8 rad^2]
  std::array<std::int32_t, 6> rate_covariance_e8{};      // [1e-8 rad^2/s^2]
  // Attitude and rate propagated to time_ns, in the LRF of that time. Without the chaser's attitude at both
  // times: in the LRF of the exposure, which kDoubtChaserNowUnknown says.
  std::array<std::int32_t, 4> q_lrf_trf_now{1 << 30, 0, 0, 0};
  std::array<std::int32_t, 3> rate_lrf_now_urad_s{};
  // The likeliest other attitude that the frame alone allows, and its odds against the reported one; 0: none.
  std::array<std::int32_t, 4> q_lrf_trf_second{1 << 30, 0, 0, 0};
  std::uint32_t second_odds_ppm = 0;
  std::array<std::int32_t, 3> centroid_lrf_mm{};  // of the returns
  // The registered pose at the exposure, in the LRF of the exposure, from the last ten frames: attitude,
  // position of the TRF's origin, angular rate of the target relative to the inertial frame, and velocity of
  // the origin relative to the sensor in axes that do not turn.
  std::uint8_t pose_doubts = kPoseDoubtUnknown;  // 0: verified
  std::uint8_t pose_frames = 0;                  // that the pose was fitted to
  std::array<std::int32_t, 4> pose_q_lrf_trf{1 << 30, 0, 0, 0};
  std::array<std::int32_t, 3> pose_origin_lrf_um{};
  std::array<std::int32_t, 3> pose_rate_lrf_urad_s{};
  std::array<std::int32_t, 3> pose_velocity_lrf_um_s{};
  // Covariance of turn about the axes of the LRF, rate, position and velocity, three each: standard
  // deviations [urad, urad/s, um, um/s], and correlations below the diagonal, row by row, Q15.
  std::array<std::uint32_t, 12> pose_sigma{};
  std::array<std::int16_t, 66> pose_correlation_q15{};
  // The pose at time_ns, in the LRF of that time as q_lrf_trf_now is.
  std::array<std::int32_t, 4> pose_q_lrf_trf_now{1 << 30, 0, 0, 0};
  std::array<std::int32_t, 3> pose_origin_lrf_now_um{};
  std::array<std::int32_t, 3> pose_rate_lrf_now_urad_s{};
  std::array<std::int32_t, 3> pose_velocity_lrf_now_um_s{};
  // What verifies it. The mean squared difference of the ranges over their variance, Q8.
  std::uint32_t pose_mean_square_q8 = 0;
  // The share of the returns beside the target.
  std::uint32_t pose_unexplained_ppm = 0;
  // The share of the target's rays that have no return or meet a dark surface.
  std::uint32_t pose_missing_ppm = 0;
  // Proven advantage over other attitudes [nats], Q8: -32 to 32 nats, 8 or more in a verified pose.
  std::int32_t pose_advantage_q8 = 0;
};

}  // namespace tumblesight::hal
