// flight_worst_step: the longest steps of the flight application, each with a name, for the audit's count of
// instructions. The memory is damaged as bit flips would damage it, and the commands are the most expensive
// ones. The program prints one line per step, "step NAME"; steps that only prepare the next one are "quiet".
#include <array>
#include <cstring>

#include "fsw/app/attitude_init_app.hpp"
#include "fsw/app/telecommand.hpp"
#include "gnc/numerics/hmac_sha256.hpp"
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

constexpr hal::CommandKeys kKeys{{hal::CommandKey{1, 2, 3, 4, 5, 6, 7, 8}}, 0x2A5C};
constexpr std::size_t kImageBytes = gnc::kModelImageSize<Numerics>;

class BoardStopwatch final : public hal::Stopwatch {
 public:
  std::uint64_t now_ns() override { return board::now_ns(); }
};

// Two banks with the same image. Both can be written unless `read_only` is set.
class TwoBanks final : public hal::ModelStore {
 public:
  hal::ModelBank bank(int index) override {
    const auto writing = read_only ? hal::BankWriting::kReadOnly : hal::BankWriting::kAtOnce;
    return {banks[static_cast<std::size_t>(index)].data(), writing, kImageBytes, kImageBytes};
  }
  hal::WriteStatus write(int index, std::uint32_t offset, const std::uint8_t* bytes,
                         std::uint32_t count) override {
    std::uint8_t* const memory = read_only ? nullptr : banks[static_cast<std::size_t>(index)].data();
    return hal::write_at_once(memory, kImageBytes, offset, bytes, count);
  }
  void fill() {
    for (auto& bytes : banks) std::memcpy(bytes.data(), tumblesight_model_image, kImageBytes);
  }
  void damage(std::size_t bank, std::size_t block) { banks[bank][block * config::kModelBlockBytes + 9] ^= 1; }

  bool read_only = false;
  // Their addresses are aligned as the application requires it.
  static constexpr std::size_t kBankBytes = (kImageBytes + 63) / 64 * 64;
  alignas(64) std::array<std::array<std::uint8_t, kBankBytes>, hal::kModelBanks> banks;
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

// Adds a command for the next step, with its security trailer (hal/messages/command_packet.hpp).
void command(FunctionCode function, const std::uint8_t* arguments, int argument_bytes) {
  hal::CommandPacket& packet = inputs.commands[static_cast<std::size_t>(inputs.command_count++)];
  std::uint8_t* const bytes = packet.bytes.data();
  const int size = hal::kCommandHeaderBytes + argument_bytes + hal::kCommandTrailerBytes;
  const int length = size - hal::kCommandPrimaryHeaderBytes - 1;
  const std::array<std::uint8_t, hal::kCommandHeaderBytes> header{
      0x18 | hal::kCommandApid >> 8,          hal::kCommandApid & 0xFF,          0xC0, 0,
      static_cast<std::uint8_t>(length >> 8), static_cast<std::uint8_t>(length), 0,    0};
  std::memcpy(bytes, header.data(), header.size());
  bytes[hal::kCommandFunctionOffset] = static_cast<std::uint8_t>(function);
  std::memcpy(bytes + hal::kCommandHeaderBytes, arguments, static_cast<std::size_t>(argument_bytes));
  std::uint8_t* const trailer = bytes + hal::kCommandHeaderBytes + argument_bytes;
  trailer[0] = kKeys.spacecraft_id >> 8;
  trailer[1] = kKeys.spacecraft_id & 0xFF;
  trailer[2] = trailer[3] = 0;  // key slot, reserved
  add_u32(trailer + 4, ++counter);
  const auto covered = static_cast<std::size_t>(size - hal::kCommandMacBytes);
  const gnc::Sha256Digest code = gnc::hmac_sha256(kKeys.slots[0], bytes, covered);
  std::memcpy(bytes + covered, code.data(), hal::kCommandMacBytes);
  bytes[hal::kCommandChecksumOffset] = hal::command_checksum(bytes, static_cast<std::size_t>(size));
  packet.size = static_cast<std::uint16_t>(size);
}

void set_mode(Mode mode) {
  const auto argument = static_cast<std::uint8_t>(mode);
  command(FunctionCode::kSetMode, &argument, 1);
}

void set_parameter(Parameter parameter, std::uint32_t value) {
  std::array<std::uint8_t, 5> arguments{static_cast<std::uint8_t>(parameter)};
  add_u32(arguments.data() + 1, value);
  command(FunctionCode::kSetParameter, arguments.data(), static_cast<int>(arguments.size()));
}

// As many commands as a step takes: an upload begins, the image in use is copied meanwhile, and all others
// are as large as a command can be.
void load_commands() {
  static std::array<std::uint8_t, hal::kMaxCommandArgumentBytes> arguments{};
  const auto base = static_cast<std::uint8_t>(UploadBase::kBankInUse);
  command(FunctionCode::kModelBegin, &base, 1);
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

// After a command load has begun a new image in the other bank: the second copy again.
void load_as_second_copy() {
  store.fill();
  ModelBanksState& banks = AppMemory::state(app).banks;
  banks.void_upload();
  banks.descriptor[banks.other()] = banks.descriptor[banks.in_use];
  AppMemory::commit(app);
}

// The frame alone; with it a full command load, and the largest scrubbing of which every block needs a
// repair.
void steps_with_a_frame() {
  step("frame");
  load_commands();
  step("frame and full command load");
  load_as_second_copy();
  const config::ParameterRule& scrub = config::rule_of(Parameter::kScrubBlocks);
  set_parameter(Parameter::kScrubBlocks, scrub.highest);
  step("quiet");
  for (std::size_t block = 0; block < ModelBanks::kBlocks; ++block) store.damage(1, block);
  AppMemory::flip_state_bit(app, 5);
  step("frame, largest scrub with repairs, state restored");
  expect(outputs.telemetry.model_blocks_repaired >= scrub.highest, "no block was repaired");
  expect(outputs.telemetry.states_restored == 1, "the state was not restored");
  store.fill();
  set_parameter(Parameter::kScrubBlocks, scrub.initial);
  step("quiet");
}

// Damage that needs a long recovery, each kind alone and then all at once, with a full command load.
void flip_a_constant() {
  const std::uint32_t before = app.estimator().constants_crc32();
  const Region region = AppMemory::constants(app);
  for (std::size_t bit = 8 * 300; app.estimator().constants_crc32() == before; ++bit) region.flip(bit);
}
void damage_tables() {
  AppMemory::guard(app).flip(8 * 40);
  AppMemory::guard(app).flip(8 * (40 + 4 * ModelBanks::kBlocks));
}

void recoveries() {
  flip_a_constant();
  step("constants reloaded");
  step("constants reloaded");
  expect(outputs.telemetry.constants_reloaded == 1, "the constants were not reloaded");
  damage_tables();
  step("tables rebuilt");
  step("tables rebuilt");
  step("tables rebuilt");
  expect(outputs.telemetry.model_tables_rebuilt == 2, "the tables were not rebuilt");
  flip_a_constant();
  damage_tables();
  load_commands();
  for (int i = 0; i < 4; ++i) step("constants and tables, full command load");
  expect(outputs.telemetry.constants_reloaded == 2, "the constants were not reloaded again");
}

// In STANDBY: a model is loaded, validated and activated.
void model_commands() {
  set_mode(Mode::kStandby);
  step("quiet");
  load_commands();  // which make the bank a new one
  step("quiet");
  std::memcpy(store.banks[1].data(), tumblesight_model_image, kImageBytes);
  AppMemory::state(app).banks.missing = {};
  AppMemory::state(app).banks.segments_missing = 0;
  AppMemory::commit(app);
  std::array<std::uint8_t, 8> arguments{};
  add_u32(arguments.data(), static_cast<std::uint32_t>(kImageBytes));
  add_u32(arguments.data() + 4, gnc::model_image_crc32(tumblesight_model_image));
  for (int i = 0; i < config::kMaxCommandsPerStep; ++i)
    command(FunctionCode::kModelValidate, arguments.data(), 8);
  step("model validated");
  for (int i = 0; i < 1; ++i) command(FunctionCode::kModelActivate, arguments.data() + 4, 4);
  step("model activated");
  expect(outputs.telemetry.bank_in_use == 1, "the model was not activated");
  set_mode(Mode::kRun);
  step("quiet");
}

// The model in use is lost and cannot be repaired: the other bank takes over.
void bank_switch() {
  const std::size_t used = outputs.telemetry.bank_in_use;
  store.read_only = true;
  for (std::size_t block = 0; block < ModelBanks::kBlocks; ++block) store.damage(used, block);
  damage_tables();
  load_commands();
  step("bank switched");
  step("bank switched");
  step("bank switched");
  expect(outputs.telemetry.bank_switches == 1, "the bank was not switched");
  expect(outputs.telemetry.bank_in_use == 1 - used, "the other bank is not in use");
}

int run() {
  store.fill();
  hal::replay::Recording recording;
  const auto bytes = static_cast<std::size_t>(tumblesight_recording_end - tumblesight_recording);
  if (recording.open(tumblesight_recording, bytes) != hal::replay::RecordingStatus::kOk) return 1;
  recording.read_next(frame);
  hal::Platform platform;
  platform.stopwatch = &stopwatch;
  platform.models = &store;
  platform.command_keys = &kKeys;
  app.init(platform, nullptr);
  step("quiet");
  step("quiet");
  expect(app.mode() == Mode::kRun, "the model was refused");
  steps_with_a_frame();
  recoveries();
  model_commands();
  bank_switch();
  board::write(
      hal::replay::TextLine().text(failure == nullptr ? "all steps done" : failure).text("\n").c_str());
  return failure == nullptr ? 0 : 1;
}

}  // namespace
}  // namespace tumblesight::fsw

int main() {
  tumblesight::hal::board::end(tumblesight::fsw::run());
}
