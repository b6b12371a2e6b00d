// TargetSymmetry: the turns after which the surface of a target is the same. No frame can tell attitudes
// apart that differ by such a turn, so the error of an estimate is that of the nearest of them.
//
// Assumption: the axes run through the origin of the target frame (TRF). Turns about them then leave the
// position as it is.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace tumblesight::sim {

inline constexpr int kAnyTurn = 0;  // as a fold: a body of revolution

struct TurnAxis {
  Eigen::Vector3d axis_trf = Eigen::Vector3d::UnitZ();  // unit
  int fold = 1;                                         // n: 1/n of a turn changes nothing
};

class TargetSymmetry {
 public:
  // No two attitudes look the same.
  TargetSymmetry() = default;
  // The group of turns that these axes generate. Throws std::invalid_argument if it has more than kMostTurns
  // elements, or if all attitudes would be the same: a body of revolution about two axes is a sphere.
  explicit TargetSymmetry(std::vector<TurnAxis> axes);

  bool is_none() const { return axes_.empty(); }
  const std::vector<TurnAxis>& axes() const { return axes_; }  // as given
  // The identity first. For a body of revolution without the turns about its axis.
  const std::vector<Eigen::Quaterniond>& turns_trf() const { return turns_; }
  const std::optional<Eigen::Vector3d>& axis_of_revolution_trf() const { return revolution_; }

 private:
  std::vector<TurnAxis> axes_;
  std::vector<Eigen::Quaterniond> turns_{Eigen::Quaterniond::Identity()};
  std::optional<Eigen::Vector3d> revolution_;
};

inline constexpr std::size_t kMostTurns = 60;  // of an icosahedron, the largest that is no prism

// Of the attitudes (TRF to any frame) that look like `estimate` the one nearest to `truth`. Without a
// symmetry the same bits as `estimate`.
Eigen::Quaterniond nearest_equivalent(const Eigen::Quaterniond& estimate, const Eigen::Quaterniond& truth,
                                      const TargetSymmetry& symmetry);

// "1/4 turn about z, any turn about (0.60, 0.80, 0.00)"; empty without a symmetry.
std::string to_string(const TargetSymmetry& symmetry);

// From texts as "z:4", "z:any" or "0.5,0.5,0.7:2", an axis each. Throws std::invalid_argument that names the
// text and what is wrong with it, and as the constructor does.
TargetSymmetry target_symmetry_from(const std::vector<std::string>& texts);

}  // namespace tumblesight::sim
