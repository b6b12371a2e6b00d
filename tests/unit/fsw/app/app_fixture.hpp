// The application with a random network and a clock that the test sets.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <memory>
#include <vector>

#include "fsw/app/attitude_init_app.hpp"
#include "hal/fake/fake_model_store.hpp"
#include "hal/fake/fake_platform.hpp"
#include "tests/support/make_packet.hpp"

namespace tumblesight::fsw {

inline constexpr std::int64_t kStart_ns = 1'000'000'000'000;

inline constexpr std::int64_t initial(Parameter parameter) {
  return config::rule_of(parameter).initial;
}
inline constexpr std::int64_t kMaxFrameAge_ns = initial(Parameter::kMaxFrameAge_ms) * 1'000'000;
inline constexpr std::int64_t kFutureTolerance_ns = initial(Parameter::kFutureTolerance_us) * 1'000;
inline constexpr std::int64_t kLongestCoast_ns = initial(Parameter::kLongestCoast_ms) * 1'000'000;
inline constexpr std::int64_t kChaserTimeTolerance_ns = initial(Parameter::kChaserTimeTolerance_us) * 1'000;

// A valid image with random weights.
const std::vector<std::uint8_t>& test_model_image();
// The same with a box as surface, about as large as what good_frame() shows.
std::vector<std::uint8_t> image_with_surface();
inline constexpr const char* kTestTarget = "test_craft";

// A frame that the estimator accepts; `scene` varies its content.
gnc::RangeImage good_frame(std::uint32_t sequence_number, std::int64_t exposure_time_ns, unsigned scene = 0);

class AppFixture : public ::testing::Test {
 protected:
  AppFixture() : app(std::make_unique<AttitudeInitApp>()), out(std::make_unique<StepOutputs>()) {}

  // Boots with the test's model in both banks.
  void init_with_model();
  void init(hal::ModelStore& models, const char* expected_target = kTestTarget);

  // `which` with the limits that the fixture asks for.
  void boot(AttitudeInitApp& which, const hal::Platform& platform, const char* expected_target = kTestTarget);

  // A signed packet with the next counter.
  hal::CommandPacket command(FunctionCode function, const std::vector<std::uint8_t>& arguments = {});
  hal::CommandPacket set_mode(Mode mode) {
    return command(FunctionCode::kSetMode, {static_cast<std::uint8_t>(mode)});
  }

  // Runs one cycle, one period after the previous one: with these inputs, without a frame, with this frame,
  // or with the next good frame.
  const StepOutputs& step(const StepInputs& inputs);
  const StepOutputs& step_commands(std::initializer_list<hal::CommandPacket> commands);
  const StepOutputs& step_frame(const gnc::RangeImage& frame);
  const StepOutputs& step_good();
  gnc::RangeImage next_frame() const;  // as the sensor would deliver it for the coming cycle
  std::int64_t next_time_ns() const { return now_ns + config::kFramePeriod_ns; }

  Validity validity() const { return out->attitude.validity; }
  int events(EventId id) const;
  const hal::Event* event(EventId id) const;                   // nullptr: not raised in this cycle
  std::int32_t argument(EventId id, std::size_t index) const;  // of an event that must have been raised
  std::uint32_t estimator_crc() const { return app->estimator().state_crc32(); }

  std::unique_ptr<AttitudeInitApp> app;
  std::unique_ptr<StepOutputs> out;
  hal::fake::FakeStopwatch stopwatch;
  hal::fake::FakeModelStore store;
  std::uint32_t command_counter = 0;  // of the last command
  Signature signature;                // of all commands
  hal::PersistentStore* persistent = nullptr;
  hal::ResetCause reset_cause = hal::ResetCause::kPowerOn;
  // init() widens the limits of the attitude checks otherwise, because the attitudes of a random network
  // jump.
  bool checks_attitudes = false;
  std::int64_t now_ns = kStart_ns;
  std::uint32_t sequence_number = 100;  // of the last good frame
};

}  // namespace tumblesight::fsw
