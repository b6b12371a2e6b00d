#include "sim/operations/scene_faults.hpp"

#include <algorithm>
#include <array>

#include "sim/world/dynamics/motion.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/scenario/draws.hpp"
#include "sim/world/sensor/effects.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kOcclude = "occlude";
constexpr const char* kTurn = "turn";

Occluder drawn_occluder(double hidden_share, Random& random) {
  constexpr std::array<OccluderShape, 3> kShapes{OccluderShape::kArm, OccluderShape::kMast,
                                                 OccluderShape::kPanelEdge};
  Occluder occluder;
  occluder.shape = kShapes[random.next() % kShapes.size()];
  occluder.hidden_share = hidden_share;
  occluder.distance_m = random.uniform(1.5, 8.0);
  occluder.side_rad = random.uniform(0.0, 2.0 * kPi);
  occluder.across = random.uniform(0.15, 0.85);
  return occluder;
}

}  // namespace

void SceneFaults::begin(const InjectedFault& fault, std::uint32_t first, std::uint32_t sequence_begin,
                        std::uint64_t seed) {
  // A turn that has ended still shows until its sequence ends.
  active_.erase(std::remove_if(active_.begin(), active_.end(),
                               [&](const Active& one) { return one.end <= sequence_begin; }),
                active_.end());
  for (Active& one : active_)
    if (one.fault.name == fault.name) one.end = std::min(one.end, first);
  Active active{fault, first, first + fault.steps, {}, 0.0, 0.0, Eigen::Vector3d::Zero()};
  Random random(mix(seed, first));
  if (fault.name == kOcclude) {
    active.occluder = drawn_occluder(fault.strength, random);
    const double last_across = random.uniform(0.15, 0.85);
    active.across_per_step = (last_across - active.occluder.across) / fault.steps;
    active.side_rad_per_step = random.uniform(-0.15, 0.15);
  } else if (fault.name == kTurn) {
    active.rate_lrf_rad_s =
        kRadPerDeg * fault.strength * (uniform_attitude(random) * Eigen::Vector3d::UnitX());
  }
  active_.push_back(active);
}

void SceneFaults::apply(std::uint32_t sequence_begin, std::uint32_t frame, Sequence& sequence) const {
  const std::uint32_t step = sequence_begin + frame;
  for (const Active& one : active_) {
    if (!one.is_in(step)) continue;
    if (one.fault.name == kOcclude) {
      Occluder occluder = one.occluder;
      occluder.across += one.across_per_step * (step - one.first);
      occluder.side_rad += one.side_rad_per_step * (step - one.first);
      sequence.frames[frame].occluder = occluder;
    } else if (one.fault.name != kTurn) {
      sequence.effects.*effect_named(one.fault.name).strength = one.fault.strength;
    }
  }
  turn_chaser(sequence_begin, frame, sequence);
}

const SceneFaults::Active* SceneFaults::turn_in(std::uint32_t step) const {
  const auto found = std::find_if(active_.begin(), active_.end(), [&](const Active& one) {
    return one.fault.name == kTurn && one.is_in(step);
  });
  return found == active_.end() ? nullptr : &*found;
}

void SceneFaults::turn_chaser(std::uint32_t sequence_begin, std::uint32_t frame, Sequence& sequence) const {
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
  for (std::uint32_t i = 0; i < frame; ++i) {
    const Active* const turn = turn_in(sequence_begin + i);
    if (turn == nullptr) continue;
    const double interval_s =
        1e-9 * static_cast<double>(sequence.frames[i + 1].time_ns - sequence.frames[i].time_ns);
    turned = turned * spin(Eigen::Quaterniond::Identity(), turn->rate_lrf_rad_s, interval_s);
  }
  FrameTruth& truth = sequence.frames[frame];
  const Active* const turn = turn_in(sequence_begin + frame);
  if (turn == nullptr && turned.w() == 1.0) return;  // to the bit as without it
  truth.q_inertial_lrf = truth.q_inertial_lrf * turned;
  truth.q_lrf_trf = (turned.conjugate() * truth.q_lrf_trf).normalized();
  truth.rate_lrf_rad_s = turned.conjugate() * truth.rate_lrf_rad_s;
  if (turn == nullptr) return;
  const Eigen::Vector3d origin_lrf_m(swath_m_ * truth.offset_swaths.x(), truth.range_m,
                                     swath_m_ * truth.offset_swaths.y());
  truth.velocity_lrf_m_s += turn->rate_lrf_rad_s.cross(origin_lrf_m);
}

}  // namespace tumblesight::sim
