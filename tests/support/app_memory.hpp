// AppMemory: the memory regions of a running application in which tests flip bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "fsw/app/attitude_init_app.hpp"

namespace tumblesight::fsw {

struct Region {
  std::uint8_t* data = nullptr;
  std::size_t size = 0;

  void flip(std::size_t bit) const { data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8); }
};

struct AppMemory {
  using App = AttitudeInitApp;

  template <class Thing>
  static Region region_of(Thing& thing) {
    return {reinterpret_cast<std::uint8_t*>(&thing), sizeof thing};
  }

  static AppState& state(App& app) { return *app.state_; }
  // All three copies of the state.
  static Region redundant_state(App& app) { return region_of(app.state_); }
  // The tables of block checksums and the copy of the estimator's state.
  static Region scrubber(App& app) { return region_of(app.scrubber_); }
  // The copy of the estimator's state alone, which is the last member of the scrubber.
  static Region kept_state(App& app) {
    const Region whole = scrubber(app);
    return {whole.data + whole.size - sizeof(Estimator::State), sizeof(Estimator::State)};
  }
  static Region workspace(App& app) { return region_of(app.frame_workspace_); }
  static Estimator& estimator(App& app) { return app.estimator_; }
  // The estimate of the last frame, before it is reported.
  static gnc::AttitudeEstimate& estimate(App& app) { return app.frame_workspace_.outcome.estimate; }
  // Biases, shifts and pointers to the weights.
  static Region constants(App& app) { return region_of(app.estimator_.network().weights()); }
  // Memory that every frame rewrites.
  static Region activations(App& app) {
    const Region weights = region_of(app.estimator_.network().weights());
    const Region working_memory = region_of(app.estimator_.working_memory());
    std::uint8_t* const begin = weights.data + weights.size;  // of the network's features
    return {begin, static_cast<std::size_t>(working_memory.data + working_memory.size - begin)};
  }
  // By a copy, because the estimator returns its state by value only.
  static void flip_state_bit(App& app, std::size_t bit) {
    Estimator::State state;
    app.estimator_.save(state);
    region_of(state).flip(bit);
    app.estimator_.restore(state);
  }
  // Also in the copy of the estimator's state and in its checksum, so that no check sees a difference.
  static void set_pose_advantage(App& app, std::int32_t llr_q8) {
    static Estimator::State state;
    app.estimator_.save(state);
    state.pose.llr_q8 = state.pose.conservative_llr_q8 = llr_q8;
    app.estimator_.restore(state);
    std::memcpy(kept_state(app).data, &state, sizeof state);
    app.state_->estimator_crc32 = Estimator::crc32_of(state);
    app.state_.commit();
  }
  // A cycle without the vote and the scrubber.
  static void step_unprotected(App& app, std::int64_t now_ns, const StepInputs& inputs,
                               StepOutputs& outputs) {
    app.step_with(now_ns, inputs, outputs, App::Protections::kOff);
  }
  // Every attitude with a sound quaternion passes: no expected error and no jump is beyond its limit.
  static void widen_attitude_limits(App& app) {
    for (const Parameter limit : {Parameter::kPredictedError_urad, Parameter::kAttitudeJump_urad})
      app.state_->table[limit] = gnc::kPi_urad;
    app.state_.commit();
  }
  static void commit(App& app) { app.state_.commit(); }
  static constexpr std::size_t kStateBits = 8 * sizeof(Estimator::State);
};

}  // namespace tumblesight::fsw
