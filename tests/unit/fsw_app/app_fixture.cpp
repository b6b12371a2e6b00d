#include "tests/unit/fsw_app/app_fixture.hpp"

#include <cmath>
#include <cstdlib>
#include <random>

#include "gnc/rcnn/model_image.hpp"

namespace tumblesight::fsw {
namespace {

bool is_unit(const std::array<float, 4>& q) {
  return std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0F) < 1e-4F;
}

std::vector<std::uint8_t> make_image() {
  auto weights = std::make_unique<gnc::NetworkWeights>();
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> uniform(-0.05F, 0.05F);
  gnc::for_each_tensor(*weights, [&](const char*, float* data, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) data[i] = uniform(engine);
  });
  gnc::ModelHeader header;
  header.projection.swath_m = 7.5F;
  header.projection.target_radius_m = 3.25F;
  std::vector<std::uint8_t> image(gnc::kModelImageSize);
  if (!gnc::set_target(header, kTestTarget) ||
      gnc::write_model_image(header, *weights, image.data(), image.size()) != image.size()) {
    std::abort();
  }
  return image;
}

}  // namespace

const std::vector<std::uint8_t>& test_model_image() {
  static const std::vector<std::uint8_t> image = make_image();
  return image;
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

hal::Command command(Opcode opcode) {
  hal::Command result;
  result.opcode = static_cast<std::uint16_t>(opcode);
  return result;
}

void AppFixture::init_with_model() {
  hal::fake::FakeModelStore store(test_model_image());
  const hal::ModelBytes image = store.active_image();
  app->init(image.data, image.size, kTestTarget, stopwatch);
}

const StepOutputs& AppFixture::step(const StepInputs& inputs) {
  now_ns = next_time_ns();
  app->step(now_ns, inputs, *out);
  // What every report keeps, whatever came in.
  EXPECT_EQ(out->attitude.time_ns, now_ns);
  EXPECT_TRUE(is_unit(out->attitude.q_lrf_trf));
  EXPECT_TRUE(is_unit(out->attitude.q_lrf_trf_single_frame));
  if (validity() != Validity::kValid) {
    EXPECT_EQ(out->attitude.frames_since_reset, 0U);
    EXPECT_FLOAT_EQ(out->attitude.predicted_error_rad, 3.14159265F);
    EXPECT_FLOAT_EQ(out->attitude.q_lrf_trf[0], 1.0F);
  }
  for (int i = 0; i < out->event_count; ++i)
    EXPECT_EQ(out->events[static_cast<std::size_t>(i)].time_ns, now_ns);
  return *out;
}

const StepOutputs& AppFixture::step_commands(std::initializer_list<hal::Command> commands) {
  StepInputs inputs;
  for (const hal::Command& one : commands)
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
    count += out->events[static_cast<std::size_t>(i)].id == static_cast<std::uint16_t>(id) ? 1 : 0;
  }
  return count;
}

const hal::Event* AppFixture::event(EventId id) const {
  for (int i = 0; i < out->event_count; ++i) {
    const hal::Event& candidate = out->events[static_cast<std::size_t>(i)];
    if (candidate.id == static_cast<std::uint16_t>(id)) return &candidate;
  }
  return nullptr;
}

std::int32_t AppFixture::argument(EventId id, std::size_t index) const {
  const hal::Event* raised = event(id);
  EXPECT_NE(raised, nullptr) << "event " << static_cast<int>(id);
  return raised != nullptr ? raised->arguments[index] : INT32_MIN;
}

}  // namespace tumblesight::fsw
