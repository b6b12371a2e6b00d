// SceneFaults: faults injected into the simulated world during a run: an occluder, effects of the sensor, a
// chaser that turns. Frames are rendered with them.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/operations/fault_table.hpp"
#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

class SceneFaults {
 public:
  // `swath_m`: of the renderer.
  explicit SceneFaults(double swath_m) : swath_m_(swath_m) {}

  // The fault acts from step `first` on. It replaces one of the same name. `sequence_begin`: the step of the
  // first frame of the sequence that is running. `seed`: random numbers of the fault depend on it and on
  // `first`. `fault` must be possible (require_possible()) and of the scene.
  void begin(const InjectedFault& fault, std::uint32_t first, std::uint32_t sequence_begin,
             std::uint64_t seed);
  bool empty() const { return active_.empty(); }
  // Changes what frame `frame` (index) of a sequence shows, which is that of step `sequence_begin` + frame.
  //
  // A chaser that turns at w, constant in the LRF and in inertial space, from frame i on, has turned by
  // T = exp(w (t - t_i)) at t. With the place of the target in the LRF unchanged:
  //   q_inertial_lrf' = q_inertial_lrf T,  q_lrf_trf' = conj(T) q_lrf_trf,  v' = v + w x origin
  void apply(std::uint32_t sequence_begin, std::uint32_t frame, Sequence& sequence) const;

 private:
  struct Active {
    InjectedFault fault;
    std::uint32_t first, end;  // steps; end is the first without it
    Occluder occluder;
    double across_per_step = 0.0, side_rad_per_step = 0.0;
    Eigen::Vector3d rate_lrf_rad_s;  // of the chaser
    bool is_in(std::uint32_t step) const { return step >= first && step < end; }
  };
  const Active* turn_in(std::uint32_t step) const;
  void turn_chaser(std::uint32_t sequence_begin, std::uint32_t frame, Sequence& sequence) const;

  double swath_m_;
  std::vector<Active> active_;  // in the order in which they began
};

}  // namespace tumblesight::sim
