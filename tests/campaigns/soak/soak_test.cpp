// A hundred thousand cycles with good and bad frames, command bursts, clock jumps, slips, bit flips and
// restarts. All counters stay consistent, and nothing uses the heap.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <random>

#include "fsw/app/attitude_init_app.hpp"
#include "fsw/programs/desktop/heap_trap.hpp"
#include "hal/fake/fake_model_store.hpp"
#include "hal/posix/monotonic_stopwatch.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint32_t kCycles = 100'000;
constexpr std::int64_t kStart_ns = 1'000'000'000'000;

gnc::RangeImage picture(std::mt19937& engine) {
  gnc::RangeImage frame;
  frame.fov_urad = 150'000;
  frame.rays = 32;
  for (std::size_t row = 8; row < 24; ++row) {
    for (std::size_t column = 8; column < 24; ++column) {
      frame.ranges[row * 32 + column] = static_cast<std::uint16_t>(50 * 128 - 200 + engine() % 400);
    }
  }
  return frame;
}

class Soak : public ::testing::Test {
 protected:
  Soak() {
    for (int i = 0; i < 16; ++i) pictures_.push_back(picture(engine_));
    restart();
  }

  bool one_in(unsigned n) { return engine_() % n == 0; }

  // A power cycle: the memory is cleared and the banks hold their original images.
  void restart() {
    store_.fill(gnc::lasting_model_image<gnc::FixedPoint>(7));
    app_->init({&stopwatch_, &store_, &kTestKeys, nullptr, hal::ResetCause::kPowerOn}, nullptr);
    counter_ = 0;
    last_ = {};
  }

  void add_frames() {
    inputs_->frame_wrong_size = one_in(50) ? 1 : 0;
    inputs_->dropped_count = one_in(20) ? 1 : 0;
    inputs_->dropped[0] = {static_cast<gnc::FrameVerdict>(engine_() % 9), number_, now_ns_};
    inputs_->frame = nullptr;
    if (one_in(20)) return;
    gnc::RangeImage& frame = image_;
    frame = pictures_[engine_() % pictures_.size()];
    frame.sequence_number = one_in(30) ? number_ : ++number_;
    frame.exposure_time_ns = now_ns_ - (one_in(30) ? std::int64_t{4'000'000'000} : 0);
    if (one_in(40)) frame.ranges.fill(0);
    if (one_in(100)) frame.rays = static_cast<std::uint16_t>(engine_());
    if (one_in(100)) frame.fov_urad = static_cast<std::uint32_t>(engine_());
    inputs_->frame = &frame;
  }

  hal::CommandPacket any_command() {
    constexpr FunctionCode kFunctions[] = {FunctionCode::kNoop,           FunctionCode::kSetMode,
                                           FunctionCode::kResetSequence,  FunctionCode::kMemoryDump,
                                           FunctionCode::kSetParameter,   FunctionCode::kResetSequence,
                                           FunctionCode::kModelValidate,  FunctionCode::kDisableResponse,
                                           FunctionCode::kEnableResponse, FunctionCode::kModelActivate};
    std::vector<std::uint8_t> arguments(engine_() % 10);
    for (std::uint8_t& byte : arguments) byte = static_cast<std::uint8_t>(one_in(2) ? 0 : engine_() % 4);
    std::vector<std::uint8_t> packet =
        packet_of(static_cast<std::uint8_t>(kFunctions[engine_() % 10]), arguments);
    if (one_in(10)) packet[engine_() % packet.size()] ^= static_cast<std::uint8_t>(1U << engine_() % 8);
    hal::CommandPacket result = signed_with(kTestKey, one_in(10) ? counter_ : ++counter_, packet);
    if (one_in(10)) result.bytes[engine_() % result.size] ^= 1;
    if (one_in(50)) result.size = static_cast<std::uint16_t>(engine_());
    return result;
  }

  void add_commands() {
    inputs_->command_count = one_in(10) ? config::kMaxCommandsPerStep : one_in(5) ? 1 : 0;
    for (int i = 0; i < inputs_->command_count; ++i)
      inputs_->commands[static_cast<std::size_t>(i)] = any_command();
    // Returns to RUN, so that most cycles give attitudes.
    if (app_->mode() != Mode::kRun && one_in(10)) {
      inputs_->command_count = 2;
      inputs_->commands[0] =
          signed_with(kTestKey, ++counter_, packet_of(3, {static_cast<std::uint8_t>(Mode::kStandby)}));
      inputs_->commands[1] =
          signed_with(kTestKey, ++counter_, packet_of(3, {static_cast<std::uint8_t>(Mode::kRun)}));
    }
    if (one_in(20'000)) {  // begins an upload, which removes the second copy
      inputs_->command_count = 1;
      inputs_->commands[0] = signed_with(kTestKey, ++counter_, packet_of(13, {1}));
    }
    if (!one_in(2000)) return;
    inputs_->command_count = 1;
    inputs_->commands[0] = signed_with(kTestKey, ++counter_, packet_of(2));
    resets_counters_ = true;
  }

  void advance_clock() {
    now_ns_ += config::kFramePeriod_ns;
    if (one_in(200)) now_ns_ += static_cast<std::int64_t>(engine_()) * 1000;
    if (one_in(200)) now_ns_ -= static_cast<std::int64_t>(engine_()) * 1000;
    inputs_->cycle_slips = one_in(100) ? static_cast<std::uint32_t>(engine_() % 5) : 0U;
  }

  void flip_a_bit() {
    const Region regions[] = {AppMemory::redundant_state(*app_),
                              AppMemory::constants(*app_),
                              AppMemory::activations(*app_),
                              AppMemory::scrubber(*app_),
                              {store_.banks[0].memory.data(), store_.banks[0].memory.size()},
                              {store_.banks[1].memory.data(), store_.banks[1].memory.size()}};
    const std::size_t which = engine_() % 7;
    if ((which == 4 || which == 5) && last_.second_copy == 0) return;  // the flip could not be repaired
    if (which == 6) {
      AppMemory::flip_state_bit(*app_, engine_() % AppMemory::kStateBits);
    } else {
      regions[which].flip(engine_() % (8 * regions[which].size));
    }
  }

  void step() {
    const std::uint64_t begin_ns = stopwatch_.now_ns();
    fsw::desktop::arm_heap_trap();
    app_->step(now_ns_, *inputs_, *outputs_);
    fsw::desktop::disarm_heap_trap();
    longest_ns_ = std::max(longest_ns_, stopwatch_.now_ns() - begin_ns);
  }

  // Checks what this cycle has added to each counter.
  void expect_all_accounted_for() {
    const hal::Telemetry& h = outputs_->telemetry;
    std::uint32_t by_reason = 0;
    for (const std::uint32_t count : h.commands_refused_by) by_reason += count;
    ASSERT_EQ(h.commands_refused, by_reason);
    ASSERT_GE(h.frames_refused, h.frames_duplicate + h.frames_stale + h.frames_bad);
    const Validity validity = outputs_->attitude.validity;
    ASSERT_TRUE(h.long_task == 0 || (validity != Validity::kValid && validity != Validity::kDoubtful));
    ASSERT_EQ(h.events_lost, 0U) << "the ring and the suppression are sized for this load";
    if (!resets_counters_) {
      ASSERT_EQ(h.cycles, last_.cycles + 1);
      ASSERT_EQ(h.commands_accepted + h.commands_refused,
                last_.commands_accepted + last_.commands_refused +
                    static_cast<std::uint32_t>(inputs_->command_count));
      ASSERT_EQ(h.events + last_.events_waiting + last_.events_suppressed,
                last_.events + static_cast<std::uint32_t>(outputs_->event_count) + h.events_waiting +
                    h.events_suppressed);
    }
    resets_counters_ = false;
    last_ = h;
  }

  std::mt19937 engine_{20'260'101};
  hal::posix::MonotonicStopwatch stopwatch_;
  hal::fake::FakeModelStore store_;
  std::unique_ptr<AttitudeInitApp> app_ = std::make_unique<AttitudeInitApp>();
  std::unique_ptr<StepInputs> inputs_ = std::make_unique<StepInputs>();
  std::unique_ptr<StepOutputs> outputs_ = std::make_unique<StepOutputs>();
  std::vector<gnc::RangeImage> pictures_;
  gnc::RangeImage image_;
  hal::Telemetry last_;  // of the previous cycle
  std::int64_t now_ns_ = kStart_ns;
  std::uint64_t longest_ns_ = 0;
  std::uint32_t number_ = 0, counter_ = 0;
  bool resets_counters_ = false;
};

// Verifies TS-TLM-040, TS-MEM-020.
TEST_F(Soak, AHundredThousandCyclesOfEverythingAtOnce) {
  std::uint32_t in_run = 0, restarts = 0;
  for (std::uint32_t cycle = 0; cycle < kCycles; ++cycle) {
    if (one_in(5'000)) {
      restart();
      ++restarts;
    }
    advance_clock();
    add_frames();
    add_commands();
    if (one_in(20)) flip_a_bit();
    step();
    expect_all_accounted_for();
    if (HasFatalFailure()) FAIL() << "in cycle " << cycle;
    ASSERT_TRUE(outputs_->duties_done);
    in_run += app_->mode() == Mode::kRun ? 1U : 0U;
  }
  EXPECT_EQ(fsw::desktop::heap_allocations(), 0U);
  EXPECT_GT(restarts, 5U);
  EXPECT_GT(in_run, kCycles / 3);
  EXPECT_LT(longest_ns_, 1'350'000'000U);
  std::printf("  in RUN %.0f %% of the cycles, %u restarts, longest step %.1f ms\n", 100.0 * in_run / kCycles,
              restarts, 1e-6 * static_cast<double>(longest_ns_));
}

}  // namespace
}  // namespace tumblesight::fsw
