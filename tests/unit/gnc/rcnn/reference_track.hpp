// The attitude track in double precision, written from its definition: the reference for the flight code.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tumblesight::gnc {

class ReferenceTrack {
 public:
  using Values = std::vector<double>;
  static constexpr int kMotionModels = 5;
  explicit ReferenceTrack(const Eigen::Matrix3d& inertia_trf);

  // A frame: the output of the CNN (57 values) and the view frame in which it states the attitudes.
  void observe(const Values& output, const Eigen::Matrix3d& r_lrf_view);
  // Results for the observed frame.
  Eigen::Matrix3d single_frame();
  double single_frame_error_rad() const { return single_frame_error_rad_; }
  Values lstm_input(const Values& dense2) const;

  // Combines hypotheses and prediction with the output of the recurrent head (20 values).
  void advance(const Values& head);

  struct Motion {
    Eigen::Matrix3d attitude;
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  };
  // For each motion model: constant spin, torque-free rotation, and with the moment about x, y or z halved.
  std::array<Motion, kMotionModels> motion;
  std::array<double, kMotionModels> log_likelihood{};
  int motion_model() const;  // with the highest score
  double margin() const;     // between its score and the next highest
  double error_rad = 0.0;
  int frames = 0;
  int means_taken = 0;      // results that were the mean of several candidates
  int rates_corrected = 0;  // results that changed a rate
  // Smallest difference so far between 20 degrees and the angle of two attitudes. Near 0 rounding decides
  // whether they are the same.
  double smallest_margin_deg = 180.0;

 private:
  void predict();
  std::array<double, kMotionModels> scores() const;
  bool same(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);
  double squared_innovation(
      int motion_model);  // squared angle between prediction and result, at most that of a lost target
  void correct(int motion_model, int anchor, const std::array<double, 9>& weights, double rate_correction);
  // Weighted mean of the candidates near the anchor: the hypotheses of the frame and, last, the prediction of
  // the motion model.
  Eigen::Matrix3d mean_around(int anchor, int motion_model, const std::array<double, 9>& weights);
  const Eigen::Matrix3d& candidate(int i, int motion_model) const {
    return i < 8 ? hypotheses_[i] : predicted_[motion_model].attitude;
  }

  std::array<Eigen::Matrix3d, kMotionModels> inertia_;
  std::array<Eigen::Matrix3d, 8> hypotheses_;
  std::array<Motion, kMotionModels> predicted_;
  std::array<double, 8> logit_, probability_;
  int likeliest_ = 0;
  double single_frame_error_rad_ = 0.0;
};

// Gains of the filter at a frame with `frames` frames before it: of the attitude (measurement against
// prediction), and the ratio of the rate gain to it.
double attitude_gain_after(int frames);
double rate_gain_after(int frames);
// The weight of the predicted attitude that corresponds to the attitude gain.
double predicted_weight_after(int frames);

}  // namespace tumblesight::gnc
