// TrialRunner: runs trials. A trial flips one or two bits and runs the following cycles. One more cycle shows
// whether the protections still work.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "fsw/app/attitude_init_app.hpp"
#include "hal/fake/fake_model_store.hpp"
#include "hal/fake/fake_platform.hpp"
#include "tests/campaigns/fault/campaign.hpp"

namespace tumblesight::fault {

// The result of a cycle, as far as the outcome of a trial depends on it.
struct CycleResult {
  gnc::QuaternionQ30 q_lrf_trf{};
  hal::Validity validity = hal::Validity::kValid;
  double error_deg = 180.0;
  gnc::QuaternionQ30 pose_q_lrf_trf{};
  bool has_wrong_pose = false;  // verified

  bool right() const { return validity == hal::Validity::kValid && error_deg <= 20.0; }
};

class TrialRunner {
 public:
  // `hooked`: with kernels that can flip a bit within a step.
  TrialRunner(const Flight& flight, bool with_protections, bool hooked);
  Trial run(Place place, std::uint64_t seed, std::uint32_t number);

 private:
  using App = fsw::AttitudeInitApp;

  // Keeps the application before each cycle of an undisturbed run, and the cycle's result.
  void fly_undisturbed();
  void prepare(std::size_t cycle);
  void step(std::size_t cycle);
  CycleResult fly(std::size_t cycle);
  void flip_one(Place place, std::mt19937& engine);
  void flip_two(std::mt19937& engine);
  // Whether flips in the triple-redundant state and in the estimator's state are corrected in the next cycle.
  bool corrects_further_flips(std::mt19937& engine);
  Trial judged(std::size_t first, const std::vector<CycleResult>& results) const;  // without the last cycle
  bool noticed() const;
  bool counts_every_command(std::size_t cycles) const;

  const Flight& flight_;
  bool protected_;
  hal::fake::FakeStopwatch stopwatch_;
  hal::fake::FakeModelStore store_;
  std::unique_ptr<App> app_ = std::make_unique<App>();
  std::unique_ptr<fsw::StepInputs> inputs_ = std::make_unique<fsw::StepInputs>();
  std::unique_ptr<fsw::StepOutputs> outputs_ = std::make_unique<fsw::StepOutputs>();
  std::vector<std::unique_ptr<App>> before_;  // each cycle of the undisturbed run
  std::vector<CycleResult> clean_;
  std::vector<std::uint32_t> resets_;  // in the undisturbed run, after each cycle
  std::size_t cycles_flown_ = 0;
};

}  // namespace tumblesight::fault
