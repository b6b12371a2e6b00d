#include "tests/unit/fsw/app/app_fixture.hpp"

#include <array>
#include <cmath>
#include <random>

#include "gnc/rcnn/model_image.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::fsw {
namespace {

bool has_unit_norm(const std::array<std::int32_t, 4>& q) {
  return std::abs(gnc::to_double(q).norm() - 1.0) < 1e-6;
}

}  // namespace

const std::vector<std::uint8_t>& test_model_image() {
  return gnc::lasting_model_image<gnc::FixedPoint>(7);
}

gnc::RangeImage good_frame(std::uint32_t sequence_number, std::int64_t exposure_time_ns, unsigned scene) {
  gnc::RangeImage frame;
  frame.exposure_time_ns = exposure_time_ns;
  frame.sequence_number = sequence_number;
  frame.fov_urad = 150'000;
  frame.rays = 32;
  std::mt19937 engine(scene);
  for (std::size_t row = 8; row < 24; ++row) {
    for (std::size_t column = 8; column < 24; ++column) {
      frame.ranges[row * 32 + column] = static_cast<std::uint16_t>(50 * 128 - 200 + engine() % 400);
    }
  }
  return frame;
}

std::vector<std::uint8_t> image_with_surface() {
  constexpr int kHalf = 16'000;  // of 32767: 1.6 m
  constexpr std::array<std::array<int, 4>, 6> kSides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::vector<int> numbers{8, 24, 0, 0};  // corners, triangles, edges, error
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) numbers.push_back((corner >> axis & 1) != 0 ? kHalf : -kHalf);
  for (const auto& [a, b, c, d] : kSides)
    for (const int corner : {a, b, c, a, c, b, a, c, d, a, d, c}) numbers.push_back(corner);
  std::vector<std::uint8_t> image = test_model_image();
  std::uint8_t* at =
      image.data() + (gnc::kModelImageSize<gnc::FixedPoint> - gnc::kMeshBytes<gnc::FixedPoint>);
  for (const int number : numbers) {
    *at++ = static_cast<std::uint8_t>(number & 0xFF);
    *at++ = static_cast<std::uint8_t>((number >> 8) & 0xFF);
  }
  return gnc::with_changed_weights(image, {});  // with correct CRCs
}

void AppFixture::init_with_model() {
  store.fill(test_model_image());
  init(store);
}

void AppFixture::init(hal::ModelStore& models, const char* expected_target) {
  boot(*app, {&stopwatch, &models, &kTestKeys, persistent, reset_cause}, expected_target);
}

void AppFixture::boot(AttitudeInitApp& which, const hal::Platform& platform, const char* expected_target) {
  which.init(platform, expected_target);
  if (!checks_attitudes) AppMemory::widen_attitude_limits(which);
}

hal::CommandPacket AppFixture::command(FunctionCode function, const std::vector<std::uint8_t>& arguments) {
  return signed_as(signature, ++command_counter, packet_of(static_cast<std::uint8_t>(function), arguments));
}

const StepOutputs& AppFixture::step(const StepInputs& inputs) {
  now_ns = next_time_ns();
  app->step(now_ns, inputs, *out);
  // Properties of every report, for any input.
  EXPECT_EQ(out->attitude.time_ns, now_ns);
  EXPECT_TRUE(has_unit_norm(out->attitude.q_lrf_trf));
  EXPECT_TRUE(has_unit_norm(out->attitude.q_lrf_trf_single_frame));
  if (validity() != Validity::kValid && validity() != Validity::kDoubtful) {
    EXPECT_EQ(out->attitude.frames_since_reset, 0U);
    EXPECT_EQ(out->attitude.predicted_error_urad, gnc::kPi_urad);
    EXPECT_EQ(out->attitude.q_lrf_trf, gnc::kIdentityQ30);
  }
  for (int i = 0; i < out->event_count; ++i)
    EXPECT_EQ(out->events[static_cast<std::size_t>(i)].time_ns, now_ns);
  return *out;
}

const StepOutputs& AppFixture::step_commands(std::initializer_list<hal::CommandPacket> commands) {
  StepInputs inputs;
  for (const hal::CommandPacket& one : commands)
    inputs.commands[static_cast<std::size_t>(inputs.command_count++)] = one;
  return step(inputs);
}

const StepOutputs& AppFixture::step_frame(const gnc::RangeImage& frame) {
  StepInputs inputs;
  inputs.frame = &frame;
  return step(inputs);
}

const StepOutputs& AppFixture::step_good() {
  const gnc::RangeImage frame = next_frame();
  sequence_number = frame.sequence_number;
  return step_frame(frame);
}

gnc::RangeImage AppFixture::next_frame() const {
  return good_frame(sequence_number + 1, next_time_ns(), sequence_number);
}

int AppFixture::events(EventId id) const {
  int count = 0;
  for (int i = 0; i < out->event_count; ++i) {
    count += out->events[static_cast<std::size_t>(i)].id == id ? 1 : 0;
  }
  return count;
}

const hal::Event* AppFixture::event(EventId id) const {
  for (int i = 0; i < out->event_count; ++i) {
    const hal::Event& candidate = out->events[static_cast<std::size_t>(i)];
    if (candidate.id == id) return &candidate;
  }
  return nullptr;
}

std::int32_t AppFixture::argument(EventId id, std::size_t index) const {
  const hal::Event* raised = event(id);
  EXPECT_NE(raised, nullptr) << "event " << static_cast<int>(id);
  return raised != nullptr ? raised->arguments[index] : INT32_MIN;
}

}  // namespace tumblesight::fsw
