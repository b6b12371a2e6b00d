// The attitude track once more, in double precision and from its definition: what the flight code must make
// of the network's numbers.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tumblesight::gnc {

class ReferenceTrack {
 public:
  using Numbers = std::vector<double>;
  static constexpr int kLaws = 5;
  explicit ReferenceTrack(const Eigen::Matrix3d& inertia_trf);

  // A frame: the CNN's output (57 numbers) and the view that it is stated in.
  void see(const Numbers& output, const Eigen::Matrix3d& r_lrf_view);
  // Of the frame seen.
  Eigen::Matrix3d single_frame();
  double single_frame_error_rad() const { return single_frame_error_rad_; }
  Numbers lstm_input(const Numbers& dense2) const;

  // By the head's output (20 numbers).
  void advance(const Numbers& head);

  struct Motion {
    Eigen::Matrix3d attitude;
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  };
  // By constant spin, by free tumbling, and with the moment about x, y or z halved.
  std::array<Motion, kLaws> motion;
  std::array<double, kLaws> log_likelihood{};
  int law() const;        // the likeliest, at a handicap
  double margin() const;  // of its log-likelihood over the next one's
  double error_rad = 0.0;
  int frames = 0;
  int merged = 0;  // answers that were the mean of several candidates
  int turned = 0;  // answers that changed a rate
  // How near any two attitudes so far came to 20 degrees apart, where rounding decides whether they are one.
  double nearest_call_deg = 180.0;

 private:
  void predict();
  std::array<double, kLaws> handicapped() const;
  bool same(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);
  double miss(int law);  // squared angle between prediction and answer, at most that of a lost target
  void correct(int law, int anchor, const std::array<double, 9>& weights, double rate_word);
  // Of the frame's hypotheses and, last, one law's prediction.
  Eigen::Matrix3d mean_around(int anchor, int law, const std::array<double, 9>& weights);
  const Eigen::Matrix3d& candidate(int i, int law) const {
    return i < 8 ? hypotheses_[i] : predicted_[law].attitude;
  }

  std::array<Eigen::Matrix3d, kLaws> inertia_;
  std::array<Eigen::Matrix3d, 8> hypotheses_;
  std::array<Motion, kLaws> predicted_;
  std::array<double, 8> logit_, probability_;
  int likeliest_ = 0;
  double single_frame_error_rad_ = 0.0;
};

// The filter's gains at the frame that `frames` others came before: attitude's (of the frame against the
// prediction) and rate's over attitude's.
double attitude_gain_after(int frames);
double rate_gain_after(int frames);
// What goes with the attitude's gain: the weight of the predicted attitude.
double predicted_weight_after(int frames);

}  // namespace tumblesight::gnc
