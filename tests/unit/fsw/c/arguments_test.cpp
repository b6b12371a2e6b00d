// What a caller can pass wrong: every argument of every function of the C interface, null, misaligned, too
// small, overlapping, in a wrong order and twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "fsw/c/tumblesight_c.h"
#include "hal/messages/command_refusal.hpp"
#include "hal/messages/function_code.hpp"
#include "hal/messages/mode.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

// A pointer at the next odd address. Nothing is read or written there.
template <class T>
T* misaligned(T& thing) {
  return reinterpret_cast<T*>(reinterpret_cast<std::uintptr_t>(&thing) + 1);
}

class CArguments : public ::testing::Test {
 protected:
  CArguments() {
    settings.bank[0] = {bank(0), test_model_image().size(), nullptr, 0};
    std::copy(test_model_image().begin(), test_model_image().end(), bank(0));
    tumblesight_initial_parameters(&parameters);
    inputs.now_ns = kStart_ns;
  }
  // Memory for a model image, one bank behind the other.
  std::uint8_t* bank(std::size_t index) {
    const std::size_t beyond = reinterpret_cast<std::uintptr_t>(images.data()) % 64;
    return images.data() + (64 - beyond) % 64 + index * kBankBytes;
  }
  tumblesight_status init() {
    return tumblesight_init(memory.data(), TUMBLESIGHT_MEMORY_BYTES, &settings, &app);
  }
  // One cycle later.
  const tumblesight_outputs& step() {
    inputs.now_ns += TUMBLESIGHT_PERIOD_NS;
    EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_OK);
    return *outputs;
  }

  static constexpr std::size_t kBankBytes = 2U << 20;
  std::vector<std::uint8_t> images = std::vector<std::uint8_t>(2 * kBankBytes + 64);
  std::vector<std::uint64_t> memory = std::vector<std::uint64_t>(TUMBLESIGHT_MEMORY_BYTES / 8);
  tumblesight_settings settings{};
  tumblesight_inputs inputs{};
  tumblesight_parameters parameters{};
  tumblesight_wrong_parameter wrong{};
  tumblesight_app* app = nullptr;
  const tumblesight_outputs* outputs = nullptr;
  std::array<std::uint8_t, TUMBLESIGHT_MAX_PACKET_BYTES> packet{};
};

struct Call {
  const char* name;
  tumblesight_status expected;
  std::function<tumblesight_status()> call;
};

void expect_all(const std::vector<Call>& calls) {
  for (const Call& one : calls) EXPECT_EQ(one.call(), one.expected) << one.name;
}

TEST_F(CArguments, NullAndMisalignedPointersAreRefused) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  tumblesight_app* const good = app;
  tumblesight_app* other = nullptr;
  tumblesight_app** const misaligned_app = misaligned(other);
  auto* const odd_app = reinterpret_cast<tumblesight_app*>(reinterpret_cast<std::uintptr_t>(good) + 1);
  const std::uint8_t byte = 0;
  constexpr tumblesight_status kNull = TUMBLESIGHT_NULL_ARGUMENT, kOdd = TUMBLESIGHT_MISALIGNED_ARGUMENT;
  const std::uint32_t before = tumblesight_state_crc32(good);
  void* const room = memory.data();
  const std::size_t size = memory.size() * 8;
  expect_all({
      {"init: memory", kNull, [&] { return tumblesight_init(nullptr, size, &settings, &other); }},
      {"init: settings", kNull, [&] { return tumblesight_init(room, size, nullptr, &other); }},
      {"init: settings", kOdd, [&] { return tumblesight_init(room, size, misaligned(settings), &other); }},
      {"init: app", kNull, [&] { return tumblesight_init(room, size, &settings, nullptr); }},
      {"init: app", kOdd, [&] { return tumblesight_init(room, size, &settings, misaligned_app); }},
      {"check_parameters", kNull, [&] { return tumblesight_check_parameters(nullptr, &wrong); }},
      {"check_parameters", kOdd,
       [&] { return tumblesight_check_parameters(misaligned(parameters), &wrong); }},
      {"check_parameters", kOdd,
       [&] { return tumblesight_check_parameters(&parameters, misaligned(wrong)); }},
      {"check_parameters: wrong", TUMBLESIGHT_OK,
       [&] { return tumblesight_check_parameters(&parameters, nullptr); }},
      {"put_command: app", kNull, [&] { return tumblesight_put_command(nullptr, &byte, 1); }},
      {"put_command: app", kOdd, [&] { return tumblesight_put_command(odd_app, &byte, 1); }},
      {"put_command: bytes", kNull, [&] { return tumblesight_put_command(good, nullptr, 1); }},
      {"put_command: bytes", kNull, [&] { return tumblesight_put_command(good, nullptr, 0); }},
      {"step: app", kNull, [&] { return tumblesight_step(nullptr, &inputs, &outputs); }},
      {"step: app", kOdd, [&] { return tumblesight_step(odd_app, &inputs, &outputs); }},
      {"step: inputs", kNull, [&] { return tumblesight_step(good, nullptr, &outputs); }},
      {"step: inputs", kOdd, [&] { return tumblesight_step(good, misaligned(inputs), &outputs); }},
      {"step: outputs", kOdd, [&] { return tumblesight_step(good, &inputs, misaligned(outputs)); }},
      {"set_parameters: app", kNull, [&] { return tumblesight_set_parameters(nullptr, &parameters); }},
      {"set_parameters: app", kOdd, [&] { return tumblesight_set_parameters(odd_app, &parameters); }},
      {"set_parameters", kNull, [&] { return tumblesight_set_parameters(good, nullptr); }},
      {"set_parameters", kOdd, [&] { return tumblesight_set_parameters(good, misaligned(parameters)); }},
  });
  tumblesight_initial_parameters(nullptr);
  tumblesight_initial_parameters(misaligned(parameters));
  EXPECT_EQ(tumblesight_state_crc32(nullptr), 0U);
  EXPECT_EQ(tumblesight_state_crc32(odd_app), 0U);
  EXPECT_EQ(tumblesight_state_crc32(good), before) << "nothing was done";
  EXPECT_GT(tumblesight_memory_bytes(nullptr), 0U);
  EXPECT_EQ(tumblesight_step(good, &inputs, nullptr), TUMBLESIGHT_OK) << "the outputs may be left out";
  EXPECT_EQ(tumblesight_take_packet(nullptr, packet.data(), packet.size()), 0U);
  EXPECT_EQ(tumblesight_take_packet(odd_app, packet.data(), packet.size()), 0U);
  EXPECT_EQ(tumblesight_take_packet(good, nullptr, packet.size()), 0U);
  EXPECT_EQ(tumblesight_take_packet(good, packet.data(), packet.size() - 1), 0U);
  EXPECT_GT(tumblesight_take_packet(good, packet.data(), packet.size()), 0U) << "the first one still waits";
}

TEST_F(CArguments, PointersWithinTheArgumentsAreChecked) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  std::array<tumblesight_frame, 2> frames{};
  std::array<tumblesight_command, 2> commands{};
  std::array<std::uint16_t, 5> ranges{};
  inputs.frames = misaligned(frames[0]);
  EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_MISALIGNED_ARGUMENT);
  inputs.frames = nullptr;
  inputs.commands = misaligned(commands[0]);
  EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_MISALIGNED_ARGUMENT);
  EXPECT_EQ(outputs, nullptr);
  inputs.frames = frames.data();
  inputs.frame_count = frames.size();
  inputs.commands = commands.data();
  inputs.command_count = commands.size();
  commands[0] = {nullptr, 100};
  frames[0].rays = frames[1].rays = 2;
  frames[1].ranges = misaligned(ranges[0]);
  step();
  EXPECT_EQ(outputs->telemetry.frames_bad, 2U);
  EXPECT_EQ(outputs->telemetry.commands_refused, 2U);
  tumblesight_command_keys keys{};
  settings.command_keys = misaligned(keys);
  EXPECT_EQ(init(), TUMBLESIGHT_MISALIGNED_ARGUMENT);
}

// In each case the object, or the image in use, would be overwritten.
TEST_F(CArguments, MemoryThatOverlapsIsRefused) {
  const std::size_t object_bytes = tumblesight_memory_bytes(memory.data());
  auto* const bytes = reinterpret_cast<std::uint8_t*>(memory.data());
  std::uint8_t* const in_object = bytes + (64 - reinterpret_cast<std::uintptr_t>(bytes) % 64);
  const tumblesight_settings good = settings;
  struct Case {
    const char* name;
    std::function<void()> change;
    tumblesight_status expected;
  };
  constexpr tumblesight_status kOverlap = TUMBLESIGHT_OVERLAP, kOk = TUMBLESIGHT_OK;
  const auto banks = [this](std::uint8_t* second, std::size_t image_bytes, std::size_t capacity_bytes) {
    settings.bank[0] = {bank(0), test_model_image().size(), bank(0), kBankBytes};
    settings.bank[1] = {second, image_bytes, capacity_bytes > 0 ? second : nullptr, capacity_bytes};
  };
  const std::size_t image_bytes = test_model_image().size();
  const std::vector<Case> cases{
      {"one bank twice, writable", [&] { banks(bank(0), 0, kBankBytes); }, kOverlap},
      {"one bank twice, read-only", [&] { banks(bank(0), image_bytes, 0); }, kOverlap},
      {"the second bank begins in the first", [&] { banks(bank(1) - 64, 0, kBankBytes); }, kOverlap},
      {"the first bank begins in the second",
       [&] {
         banks(bank(0), 0, kBankBytes);
         std::swap(settings.bank[0], settings.bank[1]);
       },
       kOverlap},
      {"banks side by side", [&] { banks(bank(1), 0, kBankBytes); }, kOk},
      {"a bank without bytes", [&] { banks(bank(0), 0, 0); }, kOk},
      {"a bank to the end of the address space", [&] { banks(bank(0) + 64, 0, SIZE_MAX); }, kOverlap},
      {"a writable bank in the object",
       [&] {
         settings.bank[1] = {in_object, 0, in_object, 4096};
       },
       kOverlap},
      {"an image in the object", [&] { settings.bank[0].image = in_object; }, kOverlap},
      {"an image that ends in the object",
       [&] {
         settings.bank[0] = {in_object - 128, 4096, nullptr, 0};
       },
       kOverlap},
      {"keys in the object",
       [&] { settings.command_keys = reinterpret_cast<tumblesight_command_keys*>(in_object); }, kOverlap},
      {"the target's name in the object",
       [&] { settings.expected_target = reinterpret_cast<const char*>(in_object); }, kOverlap},
  };
  for (const Case& one : cases) {
    settings = good;
    one.change();
    EXPECT_EQ(init(), one.expected) << one.name;
  }
  settings = good;
  auto* const inner_settings = new (in_object) tumblesight_settings(settings);
  EXPECT_EQ(tumblesight_init(bytes, object_bytes, inner_settings, &app), kOverlap);
  auto** const inner_app = reinterpret_cast<tumblesight_app**>(in_object);
  EXPECT_EQ(tumblesight_init(bytes, object_bytes, &settings, inner_app), kOverlap);
  ASSERT_EQ(init(), kOk);
  const std::uint32_t before = tumblesight_state_crc32(app);
  auto** const inner_outputs = reinterpret_cast<const tumblesight_outputs**>(in_object + 64);
  EXPECT_EQ(tumblesight_step(app, &inputs, inner_outputs), kOverlap);
  EXPECT_EQ(tumblesight_state_crc32(app), before);
  step();
  EXPECT_EQ(tumblesight_take_packet(app, in_object + 64, 4096), 0U);
}

// The bank that is loaded is not the one in use.
TEST_F(CArguments, ALoadLeavesTheImageInUseAsItIs) {
  settings.bank[0] = {bank(0), test_model_image().size(), bank(0), kBankBytes};
  settings.bank[1] = {bank(1), 0, bank(1), kBankBytes};
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  for (const auto& packet_bytes : {packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kModelBegin), {0}),
                                   packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kModelLoad),
                                             std::vector<std::uint8_t>(4 + 1024))})
    EXPECT_EQ(tumblesight_put_command(app, packet_bytes.data(), packet_bytes.size()), TUMBLESIGHT_OK);
  EXPECT_EQ(step().telemetry.commands_accepted, 2U);
  EXPECT_TRUE(std::equal(test_model_image().begin(), test_model_image().end(), bank(0)));
}

TEST_F(CArguments, SizesThatDoNotFitAreRefused) {
  const std::size_t needed = tumblesight_memory_bytes(memory.data());
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, needed - 1})
    EXPECT_EQ(tumblesight_init(memory.data(), bytes, &settings, &app), TUMBLESIGHT_TOO_LITTLE_MEMORY);
  settings.bank[0] = {bank(0), test_model_image().size(), bank(0), test_model_image().size() - 1};
  EXPECT_EQ(init(), TUMBLESIGHT_IMAGE_TOO_LARGE);
  settings.bank[0].capacity_bytes += 1;
  EXPECT_EQ(init(), TUMBLESIGHT_OK);
  settings.bank[0] = {nullptr, 1000, nullptr, 0};
  EXPECT_EQ(init(), TUMBLESIGHT_NO_MODEL) << "a bank that does not exist";
  EXPECT_EQ(step().telemetry.mode, static_cast<int>(hal::Mode::kSafe));
  settings.bank[0] = {nullptr, 0, bank(0), kBankBytes};
  EXPECT_EQ(init(), TUMBLESIGHT_OTHER_ADDRESS);
}

TEST_F(CArguments, NothingWorksBeforeInitOrAfterOneThatFailed) {
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{100}}) {
    EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_NULL_ARGUMENT);
    EXPECT_EQ(tumblesight_put_command(app, packet.data(), 8), TUMBLESIGHT_NULL_ARGUMENT);
    EXPECT_EQ(tumblesight_set_parameters(app, &parameters), TUMBLESIGHT_NULL_ARGUMENT);
    EXPECT_EQ(tumblesight_take_packet(app, packet.data(), packet.size()), 0U);
    EXPECT_EQ(tumblesight_state_crc32(app), 0U);
    EXPECT_EQ(tumblesight_init(memory.data(), bytes, &settings, &app), TUMBLESIGHT_TOO_LITTLE_MEMORY);
  }
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  tumblesight_app* const first = app;
  step();
  const std::uint32_t before = tumblesight_state_crc32(first);
  settings.apids.command = 0x7FF;
  EXPECT_EQ(init(), TUMBLESIGHT_BAD_APIDS);
  EXPECT_EQ(app, nullptr);
  EXPECT_EQ(tumblesight_state_crc32(first), before) << "the object of before is as it was";
}

TEST_F(CArguments, ASecondInitStartsAnew) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  const std::uint32_t fresh = tumblesight_state_crc32(app);
  const std::vector<std::uint8_t> noop = packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kNoop));
  step();
  EXPECT_EQ(tumblesight_put_command(app, noop.data(), noop.size()), TUMBLESIGHT_OK);
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_EQ(tumblesight_state_crc32(app), fresh);
  EXPECT_EQ(tumblesight_take_packet(app, packet.data(), packet.size()), 0U) << "no step yet";
  EXPECT_EQ(step().telemetry.commands_accepted, 0U) << "no command waits";
}

}  // namespace
}  // namespace tumblesight::fsw
