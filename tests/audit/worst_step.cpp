// flight_worst_step: the longest steps of the flight application, each with a name, for the audit's count of
// instructions. The memory is damaged as bit flips would damage it, and the commands are the most expensive
// ones. The program prints one line per step, "step NAME"; steps that only prepare the next one are "quiet".
#include <array>
#include <cstring>

#include "fsw/app/attitude_init_app.hpp"
#include "fsw/app/hmac_sha256.hpp"
#include "gnc/numerics/crc16.hpp"
#include "hal/board.hpp"
#include "hal/replay/recording.hpp"
#include "hal/replay/text_line.hpp"
#include "tests/support/app_memory.hpp"

extern "C" {
extern const std::uint8_t tumblesight_model_image[], tumblesight_model_image_end[];
extern const std::uint8_t tumblesight_recording[], tumblesight_recording_end[];

// The audit counts the instructions of a step from the call of AttitudeInitApp::step() to the call of this
// function.
[[gnu::noinline, gnu::used]] void tumblesight_step_ended() {
  asm volatile("");
}
}

namespace tumblesight::fsw {
namespace {

namespace board = hal::board;

constexpr hal::CommandKey kKey{1, 2, 3, 4, 5, 6, 7, 8};
constexpr std::size_t kImageBytes = gnc::kModelImageSize<Numerics>;

class BoardStopwatch final : public hal::Stopwatch {
 public:
  std::uint64_t now_ns() override { return board::now_ns(); }
};

// Two writable banks with the same image.
class TwoBanks final : public hal::ModelStore {
 public:
  hal::ModelBank bank(int index) override {
    std::uint8_t* const bytes = banks[static_cast<std::size_t>(index)].data();
    return {bytes, bytes, kImageBytes, kImageBytes};
  }
  void fill() {
    for (auto& bytes : banks) std::memcpy(bytes.data(), tumblesight_model_image, kImageBytes);
  }
  void damage(std::size_t bank, std::size_t block) {
    banks[bank][block * config::kModelBlockBytes + 9] ^= 1;
  }

  alignas(64) std::array<std::array<std::uint8_t, kImageBytes>, hal::kModelBanks> banks;
};

AttitudeInitApp app;
TwoBanks store;
BoardStopwatch stopwatch;
StepInputs inputs;
StepOutputs outputs;
gnc::RangeImage frame;
std::uint32_t counter = 0;
std::int64_t now_ns = 1'000'000'000'000;
const char* failure = nullptr;

void add_u32(std::uint8_t* at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

// Adds a command for the next step, with its security trailer.
void command(FunctionCode function, const std::uint8_t* arguments, int argument_bytes) {
  hal::CommandPacket& packet = inputs.commands[static_cast<std::size_t>(inputs.command_count++)];
  std::uint8_t* const bytes = packet.bytes.data();
  const int size = hal::kCommandHeaderBytes + argument_bytes, length = size - 7;
  const std::array<std::uint8_t, hal::kCommandHeaderBytes> header{
      0x18 | hal::kCommandApid >> 8,           hal::kCommandApid & 0xFF, 0xC0, 0,
      static_cast<std::uint8_t>(length >> 8),  static_cast<std::uint8_t>(length),
      static_cast<std::uint8_t>(function),     0,
      0,                                       0};
  std::memcpy(bytes, header.data(), header.size());
  std::memcpy(bytes + hal::kCommandHeaderBytes, arguments, static_cast<std::size_t>(argument_bytes));
  const std::uint16_t crc = gnc::crc16(bytes, static_cast<std::size_t>(size));
  bytes[8] = static_cast<std::uint8_t>(crc >> 8);
  bytes[9] = static_cast<std::uint8_t>(crc);
  add_u32(bytes + size, ++counter);
  const Sha256Digest code = hmac_sha256(kKey, bytes, static_cast<std::size_t>(size) + 4);
  std::memcpy(bytes + size + 4, code.data(), hal::kCommandMacBytes);
  packet.size = static_cast<std::uint16_t>(size + hal::kCommandTrailerBytes);
}

void set_mode(Mode mode) {
  const auto argument = static_cast<std::uint8_t>(mode);
  command(FunctionCode::kSetMode, &argument, 1);
}

// The largest commands, as many as a step takes.
void load_commands() {
  static std::array<std::uint8_t, hal::kMaxCommandArgumentBytes> arguments{};
  std::uint32_t offset = 0;
  while (inputs.command_count < config::kMaxCommandsPerStep) {
    add_u32(arguments.data(), offset);
    std::memcpy(arguments.data() + 4, tumblesight_model_image + offset, hal::kMaxModelSegmentBytes);
    command(FunctionCode::kModelLoad, arguments.data(), hal::kMaxCommandArgumentBytes);
    offset += hal::kMaxModelSegmentBytes;
  }
}

void step(const char* name) {
  board::write(hal::replay::TextLine().text("step ").text(name).text("\n").c_str());
  now_ns += config::kFramePeriod_ns;
  frame.exposure_time_ns = now_ns;
  ++frame.sequence_number;
  frame.ranges[frame.sequence_number % frame.ranges.size()] ^= 1;  // a sensor never repeats its noise
  inputs.frame = &frame;
  app.step(now_ns, inputs, outputs);
  tumblesight_step_ended();
  inputs.command_count = 0;
}

void expect(bool condition, const char* what) {
  if (!condition && failure == nullptr) failure = what;
}
