#include "tests/campaigns/fault/trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "sim/world/math/angles.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/support/make_packet.hpp"

namespace tumblesight::fault {
namespace {

using fsw::AppMemory;
using fsw::Region;

// A complete check of the model takes 27 cycles.
constexpr std::size_t cycles_per_trial(Place place) {
  const bool is_in_image = place == Place::kWeights || place == Place::kSurface || place == Place::kTwo;
  return is_in_image ? 30 : 15;
}
constexpr std::int64_t kStart_ns = 1'000'000'000'000;
constexpr const char* kNoTarget = nullptr;

// A pause between two sequences that is longer than any coasting, so that the estimator resets itself.
std::int64_t time_of(std::size_t cycle) {
  const auto pauses = static_cast<std::int64_t>(cycle / sim::kFramesPerSequence);
  return kStart_ns + static_cast<std::int64_t>(cycle) * sim::kFramePeriod_ns +
         pauses * 1'000'000LL * fsw::config::rule_of(fsw::Parameter::kLongestCoast_ms).initial;
}

std::uint64_t mixed(std::uint64_t x) {  // splitmix64
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

// Flips a bit of the activations within a step, before the n-th product of the network.
struct {
  const gnc::Kernels<gnc::FixedPoint>* real = nullptr;
  Region region;
  std::size_t bit = 0;
  int countdown = -1;
} hook;

void strike() {
  if (hook.countdown >= 0 && hook.countdown-- == 0) hook.region.flip(hook.bit);
}
void convolve(const gnc::ProductShape& shape, const std::uint8_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  strike();
  hook.real->convolve(shape, in, start, weights, out);
}
void multiply(const gnc::ProductShape& shape, const std::int16_t* in, const std::int32_t* start,
              const std::int8_t* weights, std::int32_t* out) {
  strike();
  hook.real->multiply(shape, in, start, weights, out);
}
constexpr int kProductsInAStep = 50;

const gnc::Kernels<gnc::FixedPoint>& hooked_kernels() {
  hook.real = &gnc::fastest_kernels<gnc::FixedPoint>();
  static const gnc::Kernels<gnc::FixedPoint> kernels{
      hook.real->set, hook.real->pixels, convolve, multiply, hook.real->max_pool, hook.real->average_pool};
  return kernels;
}

// A verified pose that is far outside of its covariance.
constexpr double kWrongPose_deg = 5.0, kWrongPose_m = 0.5;

// Vertices, triangles and edges of the target's surface, where the model image has them.
Region surface_of(std::vector<std::uint8_t>& image) {
  const gnc::SurfaceMesh mesh = gnc::surface_mesh_of<gnc::FixedPoint>(image.data());
  const auto count = [](int number) { return static_cast<std::size_t>(number); };
  const std::size_t bytes =
      6 * count(mesh.vertices()) + 6 * count(mesh.triangles()) + 8 * count(mesh.edges());
  std::uint8_t* const section =
      image.data() + (gnc::kModelImageSize<gnc::FixedPoint> - gnc::kMeshBytes<gnc::FixedPoint>);
  return {section + gnc::SurfaceMesh::kHeaderBytes, bytes};
}

double angle_deg(const gnc::QuaternionQ30& q, const Eigen::Quaterniond& truth) {
  const Eigen::Quaterniond attitude = gnc::to_double(q);
  const double dot = std::abs(attitude.dot(truth)) / std::max(1e-9, attitude.norm());
  return 2.0 * std::acos(std::min(1.0, dot)) * 180.0 / sim::kPi;
}

}  // namespace

TrialRunner::TrialRunner(const Flight& flight, bool with_protections, bool hooked)
    : flight_(flight), protected_(with_protections) {
  store_.fill(flight.model);
  if (hooked) AppMemory::estimator(*app_).network().use(hooked_kernels());
  app_->init({&stopwatch_, &store_, &fsw::kTestKeys, nullptr, hal::ResetCause::kPowerOn}, kNoTarget);
  if (!protected_) AppMemory::widen_attitude_limits(*app_);
  fly_undisturbed();
}

void TrialRunner::fly_undisturbed() {
  for (std::size_t cycle = 0; cycle < flight_.frames.size(); ++cycle) {
    before_.push_back(std::make_unique<App>(*app_));
    prepare(cycle);
    clean_.push_back(fly(cycle));
    resets_.push_back(outputs_->telemetry.estimator_resets);
  }
}

// A frame and a NOOP command, which is only counted.
void TrialRunner::prepare(std::size_t cycle) {
  inputs_->commands[0] =
      fsw::signed_with(fsw::kTestKey, static_cast<std::uint32_t>(cycle + 1),
                       fsw::packet_of(static_cast<std::uint8_t>(fsw::FunctionCode::kNoop)));
  inputs_->command_count = 1;
  static gnc::RangeImage frame;
  frame = flight_.frames[cycle];
  frame.sequence_number = static_cast<std::uint32_t>(cycle + 1);
  frame.exposure_time_ns = time_of(cycle);
  inputs_->frame = &frame;
}

void TrialRunner::step(std::size_t cycle) {
  if (protected_) {
    app_->step(time_of(cycle), *inputs_, *outputs_);
  } else {
    AppMemory::step_unprotected(*app_, time_of(cycle), *inputs_, *outputs_);
  }
}

CycleResult TrialRunner::fly(std::size_t cycle) {
  step(cycle);
  CycleResult result;
  result.q_lrf_trf = outputs_->attitude.q_lrf_trf;
  result.validity = outputs_->attitude.validity;
  const bool has_attitude =
      result.validity == hal::Validity::kValid || result.validity == hal::Validity::kDoubtful;
  if (!has_attitude) return result;
  const sim::FrameTruth& truth = flight_.truth[cycle];
  result.error_deg = angle_deg(result.q_lrf_trf, truth.q_lrf_trf);
  result.pose_q_lrf_trf = outputs_->attitude.pose_q_lrf_trf;
  // The targets of the campaign are on the boresight.
  const std::array<std::int32_t, 3>& origin_um = outputs_->attitude.pose_origin_lrf_um;
  const Eigen::Vector3d apart_m(1e-6 * origin_um[0], 1e-6 * origin_um[1] - truth.range_m,
                                1e-6 * origin_um[2]);
  result.has_wrong_pose =
      outputs_->attitude.pose_doubts == 0 &&
      (angle_deg(result.pose_q_lrf_trf, truth.q_lrf_trf) > kWrongPose_deg || apart_m.norm() > kWrongPose_m);
  return result;
}

void TrialRunner::flip_one(Place place, std::mt19937& engine) {
  const auto flip_any = [&engine](Region region) { region.flip(engine() % (8 * region.size)); };
  switch (place) {
    case Place::kWeights:
      flip_any({store_.banks[0].memory.data(), store_.banks[0].memory.size()});
      break;
    case Place::kActivations:
      hook.region = AppMemory::activations(*app_);
      hook.bit = engine() % (8 * hook.region.size);
      hook.countdown = static_cast<int>(engine() % kProductsInAStep);
      break;
    case Place::kSurface:
      flip_any(surface_of(store_.banks[0].memory));
      break;
    case Place::kEstimatorState:
      AppMemory::flip_state_bit(*app_, engine() % AppMemory::kStateBits);
      break;
    case Place::kApplicationState: {
      const Region regions[] = {AppMemory::redundant_state(*app_), AppMemory::scrubber(*app_)};
      std::size_t bit = engine() % (8 * (regions[0].size + regions[1].size));
      for (const Region& region : regions) {
        if (bit < 8 * region.size) {
          region.flip(bit);
          break;
        }
        bit -= 8 * region.size;
      }
      break;
    }
    case Place::kModelDescriptor: {
      fsw::ModelBanksState& banks = AppMemory::state(*app_).banks;
      const Region descriptor = AppMemory::region_of(banks), constants = AppMemory::constants(*app_);
      const std::size_t bit = engine() % (8 * (descriptor.size + constants.size));
      bit < 8 * descriptor.size ? descriptor.flip(bit) : constants.flip(bit - 8 * descriptor.size);
      break;
    }
    case Place::kCommand: {
      hal::CommandPacket& packet = inputs_->commands[0];
      const std::size_t bit = engine() % (8 * (sizeof packet.size + packet.size));
      if (bit < 16) {
        AppMemory::region_of(packet.size).flip(bit);
      } else {
        Region{packet.bytes.data(), packet.bytes.size()}.flip(bit - 16);
      }
      break;
    }
    case Place::kFrame: {
      auto& frame = const_cast<gnc::RangeImage&>(*inputs_->frame);
      flip_any(AppMemory::region_of(frame));
      break;
    }
    case Place::kTwo:
      flip_two(engine);
      break;
  }
}

void TrialRunner::flip_two(std::mt19937& engine) {
  constexpr std::array kMemory{Place::kWeights, Place::kEstimatorState, Place::kApplicationState,
                               Place::kModelDescriptor};
  const Place one = kMemory[engine() % kMemory.size()];
  const Place other = kMemory[engine() % kMemory.size()];
  for (const Place place : {one, other}) {
    if (place == Place::kWeights) {
      std::vector<std::uint8_t>& memory = store_.banks[engine() % store_.banks.size()].memory;
      Region{memory.data(), memory.size()}.flip(engine() % (8 * memory.size()));
    } else {
      flip_one(place, engine);
    }
  }
}

bool TrialRunner::corrects_further_flips(std::mt19937& engine) {
  constexpr std::size_t kBitOfLstm = 5;
  const hal::Telemetry before = outputs_->telemetry;
  const Region redundant = AppMemory::redundant_state(*app_);
  redundant.flip(engine() % (8 * redundant.size));
  AppMemory::flip_state_bit(*app_, kBitOfLstm);
  prepare(cycles_flown_);
  step(cycles_flown_);
  const hal::Telemetry& after = outputs_->telemetry;
  return after.memory_corrections == before.memory_corrections + 1 &&
         after.states_restored == before.states_restored + 1;
}

Trial TrialRunner::run(Place place, std::uint64_t seed, std::uint32_t number) {
  std::mt19937 engine(
      static_cast<std::uint32_t>(mixed(seed * 1000003 + static_cast<std::uint64_t>(place)) + mixed(number)));
  const std::size_t first = engine() % (flight_.frames.size() - cycles_per_trial(place) - 1);
  // Written in place, because the application has pointers into the banks.
  for (auto& bank : store_.banks) std::copy(flight_.model.begin(), flight_.model.end(), bank.memory.begin());
  hook.countdown = -1;
  *app_ = *before_[first];
  prepare(first);
  flip_one(place, engine);
  std::vector<CycleResult> results;
  for (std::size_t cycle = first; cycle < first + cycles_per_trial(place); ++cycle) {
    if (cycle > first) prepare(cycle);
    results.push_back(fly(cycle));
  }
  cycles_flown_ = first + cycles_per_trial(place);
  Trial trial = judged(first, results);
  const bool ended_well = trial.outcome != Outcome::kSilentWrong && trial.outcome != Outcome::kWrongPose &&
                          trial.outcome != Outcome::kLostCount;
  if (protected_ && !corrects_further_flips(engine) && ended_well) trial.outcome = Outcome::kUnprotected;
  return trial;
}

bool TrialRunner::noticed() const {
  const hal::Telemetry& h = outputs_->telemetry;
  return h.memory_corrections + h.states_restored + h.states_lost + h.constants_reloaded +
                 h.model_blocks_repaired + h.model_blocks_lost + h.model_tables_rebuilt + h.bank_switches +
                 h.commands_refused + h.frames_refused + h.sequence_gaps >
             0 ||
         h.estimator_resets != resets_[cycles_flown_ - 1] || h.mode != fsw::Mode::kRun;
}

bool TrialRunner::counts_every_command(std::size_t cycles) const {
  const hal::Telemetry& h = outputs_->telemetry;
  return std::size_t{h.commands_accepted} + h.commands_refused == cycles;
}

Trial TrialRunner::judged(std::size_t first, const std::vector<CycleResult>& results) const {
  Trial trial;
  bool silent_wrong = false, wrong_pose = false;
  bool affected_at_the_end = false;
  std::size_t since = 0;  // consecutive affected cycles
  for (std::size_t i = 0; i < results.size(); ++i) {
    const CycleResult& clean = clean_[first + i];
    const CycleResult& hit = results[i];
    trial.changed =
        trial.changed || hit.q_lrf_trf != clean.q_lrf_trf || hit.pose_q_lrf_trf != clean.pose_q_lrf_trf;
    wrong_pose = wrong_pose || (hit.has_wrong_pose && !clean.has_wrong_pose);
    const bool affected = clean.right() && !hit.right();
    silent_wrong = silent_wrong || (affected && hit.validity == hal::Validity::kValid);
    since = affected ? since + 1 : 0;
    if (since > trial.cycles_to_recover) trial.cycles_to_recover = static_cast<std::uint8_t>(since);
    affected_at_the_end = affected;
  }
  if (silent_wrong) {
    trial.outcome = Outcome::kSilentWrong;
  } else if (wrong_pose) {
    trial.outcome = Outcome::kWrongPose;
  } else if (!counts_every_command(cycles_flown_)) {
    trial.outcome = Outcome::kLostCount;
  } else if (outputs_->telemetry.mode == hal::Mode::kSafe) {
    trial.outcome = Outcome::kSafe;
  } else if (affected_at_the_end) {
    trial.outcome = Outcome::kFlaggedWrong;
  } else {
    trial.outcome = noticed() || trial.cycles_to_recover > 0 ? Outcome::kRecovered : Outcome::kMasked;
  }
  return trial;
}

}  // namespace tumblesight::fault
