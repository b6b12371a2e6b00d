// flight_worst_step: the longest steps of the flight application, each with a name, for the audit's count of
// instructions. A step is counted with the receipt of as many frames as a cycle can receive. The memory is
// damaged as bit flips would damage it, the commands are the most expensive ones, and the scrubbing is the
// largest that SET_PARAMETER allows. The program prints one line per step, "step NAME"; steps that only
// prepare the next one are "quiet".
#include <array>
#include <cstring>
#include <new>

#include "fsw/app/cycle.hpp"
#include "fsw/app/telecommand.hpp"
#include "gnc/numerics/hmac_sha256.hpp"
#include "gnc/rcnn/model_format.hpp"
#include "hal/board.hpp"
#include "hal/replay/recording.hpp"
#include "hal/replay/text_line.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/support/expensive_mesh.hpp"

extern "C" {
extern const std::uint8_t tumblesight_model_image[], tumblesight_model_image_end[];
extern const std::uint8_t tumblesight_recording[], tumblesight_recording_end[];

// The audit counts the instructions between these two calls.
[[gnu::noinline, gnu::used]] void tumblesight_step_begins() {
  asm volatile("");
}
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
    for (auto& bytes : banks) {
      std::memcpy(bytes.data(), tumblesight_model_image, kImageBytes);
      if (is_expensive) make_expensive(bytes.data());
    }
  }
  void damage(std::size_t bank, std::size_t block) { banks[bank][block * config::kModelBlockBytes + 9] ^= 1; }

  bool read_only = false;
  bool is_expensive = false;  // the surface has the format's limits
  // Their addresses are aligned as the application requires it.
  static constexpr std::size_t kBankBytes = (kImageBytes + 63) / 64 * 64;
  alignas(64) std::array<std::array<std::uint8_t, kBankBytes>, hal::kModelBanks> banks;

 private:
  static void make_expensive(std::uint8_t* image) {
    using gnc::model_format::put_u32;
    constexpr std::size_t kSections = gnc::kModelSections<Numerics>;
    std::uint8_t* const mesh = image + kImageBytes - gnc::SurfaceMesh::kMaxBytes;
    gnc::make_expensive_mesh({}, mesh);
    std::uint8_t* const entry = image + gnc::kModelHeaderSize + (kSections - 1) * gnc::kModelSectionEntrySize;
    put_u32(entry + 12, gnc::crc32(mesh, gnc::SurfaceMesh::kMaxBytes));
    put_u32(image + gnc::model_format::kOffsetHeaderCrc, gnc::model_format::header_crc(image, kSections));
  }
};

// Every command of a step is stored before it is carried out.
class KeptState final : public hal::PersistentStore {
 public:
  hal::StoreStatus read(int copy, hal::StoredBytes& bytes) override {
    bytes = copies_[static_cast<std::size_t>(copy)];
    return written_ ? hal::StoreStatus::kOk : hal::StoreStatus::kBlank;
  }
  hal::StoreStatus write(int copy, const hal::StoredBytes& bytes) override {
    copies_[static_cast<std::size_t>(copy)] = bytes;
    written_ = true;
    return hal::StoreStatus::kOk;
  }

 private:
  std::array<hal::StoredBytes, hal::kStoredCopies> copies_{};
  bool written_ = false;
};

constexpr std::uint32_t kHalfMissing_ppm = 300'000;  // of half of a target, which is not cut in the middle
constexpr std::int32_t kWithoutAlternative_q8 = 4 * 256;  // advantage by a frame without another attitude
constexpr std::int32_t kTurned = 759'250'125;  // sqrt(1/2), Q30: the chaser's attitude is no identity

// As many deliveries as a cycle receives, each later than the one before. From the oldest to the newest:
//  - frames whose only returns are in the last rays, where they are found last;
//  - frames of `scene` with stuck first rows, which have to be compared in full;
//  - one frame of `scene`, which is used. A sensor never repeats its noise: it differs in every range from
//    those of the ten steps before;
//  - frames with bad content, which takes the longest to see.
class FastLidar final : public hal::Lidar {
 public:
  void prepare(std::int64_t now_ns) {
    noise_ = (noise_ + 1) % kNoises;
    scene.exposure_time_ns = now_ns;
    scene.sequence_number += config::kMaxDeliveriesPerCycle;
    copy_with_noise(noise_, used_);
    for (std::uint32_t i = 0; i < 2; ++i) {
      copy_with_noise(kNoises + 1 + i, stuck_[i]);
      few_[i] = stuck_[i];
      for (std::size_t ray = 0; ray < scene.ranges.size(); ++ray) {
        const std::size_t row = ray / scene.rays, column = ray % scene.rays;
        if (row < kStuckRows) stuck_[i].ranges[ray] = kStuckRange;
        const bool is_last = row + kFewSide >= scene.rays && column + kFewSide >= scene.rays;
        few_[i].ranges[ray] = is_last ? static_cast<std::uint16_t>(kStuckRange + 3 * ray + i) : 0;
      }
    }
    waiting_ = config::kMaxDeliveriesPerCycle;
  }
  hal::LidarStatus receive(gnc::RangeImage& frame) override {
    if (waiting_ == 0) return hal::LidarStatus::kNoFrame;
    const int later = --waiting_;
    const int used = config::kMaxBadContentsPerCycle;  // the newer ones have no range within the gate
    const int first_stuck = used + 1 + config::kMaxFullComparisonsPerCycle - config::kFramesComparedInFull;
    const auto either = static_cast<std::size_t>(later % 2);
    frame = later <= used ? used_ : later <= first_stuck ? stuck_[either] : few_[either];
    if (later < used) frame.ranges.fill(kBeforeTheGate);
    frame.exposure_time_ns -= later * std::int64_t{50'000'000};
    frame.sequence_number -= static_cast<std::uint32_t>(later);
    return hal::LidarStatus::kFrame;
  }

  gnc::RangeImage scene;

 private:
  static constexpr std::uint32_t kNoises = 10;
  static constexpr std::uint16_t kBeforeTheGate = 640;  // counts: 5 m
  static constexpr std::uint16_t kStuckRange = 6400;
  static constexpr std::size_t kStuckRows = 4;
  static constexpr std::size_t kFewSide = 9;

  void copy_with_noise(std::uint32_t noise, gnc::RangeImage& frame) const {
    frame = scene;
    for (std::uint16_t& range : frame.ranges)
      if (range != 0) range = static_cast<std::uint16_t>(range ^ noise);
  }

  gnc::RangeImage used_;
  std::array<gnc::RangeImage, 2> few_, stuck_;
  std::uint32_t noise_ = 0;
  int waiting_ = 0;
};

// Delivers the commands of a step.
class CommandLink final : public hal::Link {
 public:
  bool receive(hal::CommandPacket& command) override {
    if (delivered_ == count) return false;
    command = commands[static_cast<std::size_t>(delivered_++)];
    return true;
  }
  void publish(const hal::AttitudeReport&) override {}
  void publish(const hal::Telemetry&) override {}
  void publish(const hal::Event&) override {}
  void publish(const hal::MemoryDump&) override {}
  void clear() { count = delivered_ = 0; }

  std::array<hal::CommandPacket, config::kMaxCommandsPerStep> commands;
  int count = 0;

 private:
  int delivered_ = 0;
};

class TurnedChaser final : public hal::Navigation {
 public:
  gnc::ChaserAttitude attitude_at(std::int64_t time_ns) override {
    return {time_ns, {kTurned, 0, 0, -kTurned}, true};
  }
};

class NoWatchdog final : public hal::Watchdog {
 public:
  void kick() override {}
};

AttitudeInitApp app;
KeptState kept_state;
TwoBanks store;
BoardStopwatch stopwatch;
FastLidar lidar;
CommandLink command_link;
TurnedChaser navigation;
NoWatchdog watchdog;
CycleWorkspace workspace;
const StepOutputs& outputs = workspace.outputs;
gnc::RangeImage& frame = lidar.scene;
std::uint32_t counter = 0;
std::int64_t now_ns = 1'000'000'000'000;
const char* failure = nullptr;

void add_u32(std::uint8_t* at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

// Adds a command for the next step, with its security trailer (hal/messages/command_packet.hpp).
void command(FunctionCode function, const std::uint8_t* arguments, int argument_bytes) {
  hal::CommandPacket& packet = command_link.commands[static_cast<std::size_t>(command_link.count++)];
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

void reset_sequence() {
  const std::uint8_t none = 0;
  command(FunctionCode::kResetSequence, &none, 0);
}

void set_parameter(Parameter parameter, std::uint32_t value) {
  std::array<std::uint8_t, 5> arguments{static_cast<std::uint8_t>(parameter)};
  add_u32(arguments.data() + 1, value);
  command(FunctionCode::kSetParameter, arguments.data(), static_cast<int>(arguments.size()));
}

// As many commands as a step takes: an upload begins, the image in use is copied meanwhile, and all others
// are as large as a command can be. Without the beginning they are refused, and the bank keeps its image.
enum class Upload { kBegins, kRefused };
void load_commands(Upload upload = Upload::kBegins) {
  static std::array<std::uint8_t, hal::kMaxCommandArgumentBytes> arguments{};
  const auto base = static_cast<std::uint8_t>(UploadBase::kBankInUse);
  if (upload == Upload::kBegins) command(FunctionCode::kModelBegin, &base, 1);
  std::uint32_t offset = 0;
  while (command_link.count < config::kMaxCommandsPerStep) {
    add_u32(arguments.data(), offset);
    std::memcpy(arguments.data() + 4, tumblesight_model_image + offset, hal::kMaxModelSegmentBytes);
    command(FunctionCode::kModelLoad, arguments.data(), hal::kMaxCommandArgumentBytes);
    offset += hal::kMaxModelSegmentBytes;
  }
}

const char* of_image = "";  // behind the names of steps
void begin(const char* name) {
  board::write("step ");
  board::write(name);
  board::write(std::strcmp(name, "quiet") == 0 ? "" : of_image);
  board::write("\n");
}

// `periods`: since the step before.
void step(const char* name, int periods = 1) {
  begin(name);
  now_ns += periods * config::kFramePeriod_ns;
  lidar.prepare(now_ns);
  tumblesight_step_begins();
  run_cycle(app, {lidar, command_link, watchdog, stopwatch, &navigation, false}, now_ns, 0, workspace);
  tumblesight_step_ended();
  command_link.clear();
}

void expect(bool condition, const char* what) {
  if (!condition && failure == nullptr) failure = what;
}

ModelBanksState& banks() {
  return AppMemory::state(app).banks;
}

// After a command load has begun a new image in the other bank: the second copy again.
void load_as_second_copy() {
  store.fill();
  banks().void_upload();
  banks().descriptor[banks().other()] = banks().descriptor[banks().in_use];
  AppMemory::commit(app);
}

constexpr std::uint32_t kMostScrubbed = config::rule_of(Parameter::kScrubBlocks).highest;

// What any of the following steps can have to do as well: repairs of the next `blocks` blocks of the second
// copy, and of the estimator's state.
void damage_more(std::uint32_t blocks = kMostScrubbed) {
  for (std::uint32_t i = 0; i < blocks; ++i)
    store.damage(banks().other(), (banks().next_block + i) % ModelBanks::kBlocks);
  AppMemory::flip_state_bit(app, 5);
}
void flip_a_constant() {
  const std::uint32_t before = app.estimator().constants_crc32();
  const Region region = AppMemory::constants(app);
  for (std::size_t bit = 8 * 300; app.estimator().constants_crc32() == before; ++bit) region.flip(bit);
}
void damage_tables() {
  AppMemory::scrubber(app).flip(8 * 40);
  AppMemory::scrubber(app).flip(8 * (40 + 4 * ModelBanks::kBlocks));
}

void steps_with_a_frame() {
  step("frame");
  load_commands();
  step("frame and full command load");
  load_as_second_copy();
  set_parameter(Parameter::kScrubBlocks, kMostScrubbed);
  step("quiet");
  damage_more();
  load_commands();
  step("frame, full command load, largest scrub with repairs, state restored");
  expect(outputs.telemetry.model_blocks_repaired == kMostScrubbed, "the blocks were not repaired");
  expect(outputs.telemetry.states_restored == 1, "the state was not restored");
  expect(outputs.attitude.validity == hal::Validity::kValid ||
             outputs.attitude.validity == hal::Validity::kDoubtful,
         "the frame was not used");
  load_as_second_copy();
}

// The most rays, after the longest coast, which the track propagates in steps. A track of a single frame
// knows no rate, and has its prediction confirmed or starts anew.
enum class Rate { kKnown, kUnknown };
// A target in half of a field of view of twice the size is resampled.
enum class Scene { kFillsTheView, kSmallInTheLastCorner };
bool is_resampled() {
  static gnc::DepthImageScratch scratch;
  static gnc::DepthImage image;
  const auto status = gnc::make_depth_image(frame, app.estimator().model().projection, scratch, image);
  return status == gnc::FrameStatus::kOk && scratch.window.is_resampled;
}

void step_after_the_longest_coast(Rate rate, Scene scene) {
  static gnc::RangeImage recorded;
  recorded = frame;
  frame.rays = gnc::RangeImage::kMaxRays;
  const std::size_t side = scene == Scene::kFillsTheView ? frame.rays : frame.rays / 2;
  const std::size_t first = frame.rays - side;
  for (std::size_t i = 0; i < frame.ranges.size(); ++i) {
    const std::size_t row = i / frame.rays, column = i % frame.rays;
    const std::size_t recorded_ray =
        (row - first) * recorded.rays / side * recorded.rays + (column - first) * recorded.rays / side;
    frame.ranges[i] = row < first || column < first ? 0 : recorded.ranges[recorded_ray];
  }
  if (scene == Scene::kSmallInTheLastCorner) frame.fov_urad *= 2;
  expect(is_resampled() == (scene == Scene::kSmallInTheLastCorner), "the wrong scene is resampled");
  constexpr config::ParameterRule kCoast = config::rule_of(Parameter::kLongestCoast_ms);
  set_parameter(Parameter::kLongestCoast_ms, kCoast.highest);
  if (rate == Rate::kUnknown) reset_sequence();
  step("quiet");
  damage_more();
  load_commands();
  step("frame of the most rays after the longest coast, full command load, largest scrub with repairs",
       static_cast<int>(std::int64_t{kCoast.highest} * 1'000'000 / config::kFramePeriod_ns));
  const bool is_ambiguous = (outputs.attitude.doubts & hal::kDoubtRateAmbiguous) != 0;
  if (rate == Rate::kUnknown) expect(is_ambiguous, "the rate was known");
  if (rate == Rate::kKnown) expect(outputs.attitude.frames_since_reset > 2, "the track was given up");
  expect(outputs.telemetry.frames_repeated == 0, "a frame counts as repeated");
  recorded.sequence_number = frame.sequence_number;
  frame = recorded;
  load_as_second_copy();
  set_parameter(Parameter::kLongestCoast_ms, kCoast.initial);
  step("quiet");
}

// The right half of the target sends nothing back, so that registration looks for dark surfaces and searches.
void lose_right_half() {
  std::size_t returns = 0, columns = 0;
  for (std::size_t i = 0; i < frame.ranges.size(); ++i) {
    if (frame.ranges[i] == 0) continue;
    ++returns;
    columns += i % frame.rays;
  }
  for (std::size_t i = 0; i < frame.ranges.size(); ++i)
    if ((i % frame.rays) * returns > columns) frame.ranges[i] = 0;
}
void steps_with_dark_surfaces() {
  static gnc::RangeImage recorded;
  recorded = frame;
  const auto restore = [] {
    recorded.sequence_number = frame.sequence_number;
    frame = recorded;
  };
  const auto expect_dark = [] {
    if (store.is_expensive) return;
    expect(outputs.attitude.pose_missing_ppm > kHalfMissing_ppm, "no surface is missing");
  };
  lose_right_half();
  reset_sequence();
  damage_more();
  load_commands();
  step("first frame with dark surfaces, full command load, largest scrub with repairs");
  expect_dark();
  load_as_second_copy();
  restore();
  for (int i = 0; i < 4; ++i) step("quiet");
  lose_right_half();
  // The network's second attitude is compared with a track that has no advantage yet.
  AppMemory::set_pose_advantage(app, 0);
  damage_more();
  load_commands();
  step("frame with dark surfaces, full command load, largest scrub with repairs");
  expect_dark();
  expect(store.is_expensive || outputs.attitude.pose_advantage_q8 != kWithoutAlternative_q8,
         "no other attitude was compared");
  expect(outputs.attitude.frames_since_reset > 4, "the track was given up");
  load_as_second_copy();
  restore();
  step("quiet");
}

// Both tables and the constants at once are repaired in consecutive steps. The image gives one table, and
// that one the other.
void repairs() {
  flip_a_constant();
  damage_tables();
  damage_more();
  load_commands(Upload::kRefused);
  step("table rebuilt");
  expect(outputs.telemetry.model_tables_rebuilt == 2, "the tables were not rebuilt");
  expect(outputs.telemetry.constants_reloaded == 0, "two long tasks in a step");
  damage_more(ModelBanks::kBlocks);
  load_commands();
  step("constants reloaded");
  expect(outputs.telemetry.constants_reloaded == 1, "the constants were not reloaded");
  expect(outputs.telemetry.frames_passed_over == 2, "a frame was used during the repair");
  load_as_second_copy();
}

// In STANDBY: a loaded model is validated and activated.
void model_commands() {
  std::array<std::uint8_t, 8> arguments{};
  add_u32(arguments.data(), static_cast<std::uint32_t>(kImageBytes));
  add_u32(arguments.data() + 4, gnc::model_image_crc32(tumblesight_model_image));
  set_mode(Mode::kStandby);
  step("quiet");
  banks().descriptor[1].set(BankStatus::kLoading);
  banks().missing = {};
  banks().segments_missing = 0;
  AppMemory::commit(app);
  damage_more(0);
  command(FunctionCode::kModelValidate, arguments.data(), 8);
  load_commands(Upload::kRefused);
  step("model validated");
  expect(outputs.telemetry.bank_status[1] == BankStatus::kGood, "the model was not validated");
  damage_more();
  command(FunctionCode::kModelActivate, arguments.data() + 4, 4);
  load_commands();
  step("model activated");
  expect(outputs.telemetry.bank_in_use == 1, "the model was not activated");
  load_as_second_copy();
  set_mode(Mode::kRun);
  step("quiet");
}

// The model in use is lost and cannot be repaired: the other bank takes over.
void bank_switches() {
  // The constants are not those that were activated.
  flip_a_constant();
  AppMemory::state(app).constants_crc32 ^= 1;
  AppMemory::commit(app);
  damage_more(ModelBanks::kBlocks);
  load_commands(Upload::kRefused);
  step("constants not reloaded, bank switched");
  expect(outputs.telemetry.bank_switches == 1, "the bank was not switched");
  load_as_second_copy();
  step("quiet");

  store.read_only = true;
  store.damage(outputs.telemetry.bank_in_use, ModelBanks::kBlocks - 1);
  damage_tables();
  damage_more(0);
  load_commands(Upload::kRefused);
  step("table not rebuilt, bank switched");
  expect(outputs.telemetry.bank_switches == 2, "the bank was not switched again");
}

// Registration ends before its budget does (gnc/registration/work_budget.hpp).
void steps_with_the_most_expensive_image() {
  hal::Platform platform;
  platform.stopwatch = &stopwatch;
  platform.models = &store;
  platform.command_keys = &kKeys;
  platform.reset_cause = hal::ResetCause::kPowerOn;
  app.~AttitudeInitApp();
  new (&app) AttitudeInitApp;
  store.read_only = false;
  store.is_expensive = true;
  store.fill();
  app.init(platform, nullptr);
  of_image = "; the most expensive image";
  for (int i = 0; i < 4; ++i) step("quiet");
  expect(app.mode() == Mode::kRun, "the most expensive image was refused");
  set_parameter(Parameter::kScrubBlocks, kMostScrubbed);
  step("quiet");
  for (const Rate rate : {Rate::kKnown, Rate::kUnknown})
    step_after_the_longest_coast(rate, Scene::kFillsTheView);
  steps_with_dark_surfaces();
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
  platform.persistent = &kept_state;
  platform.reset_cause = hal::ResetCause::kPowerOn;
  begin("boot");
  tumblesight_step_begins();
  app.init(platform, nullptr);
  tumblesight_step_ended();
  step("quiet");
  step("quiet");
  expect(app.mode() == Mode::kRun, "the model was refused");
  steps_with_a_frame();
  for (const Scene scene : {Scene::kFillsTheView, Scene::kSmallInTheLastCorner})
    for (const Rate rate : {Rate::kKnown, Rate::kUnknown}) step_after_the_longest_coast(rate, scene);
  steps_with_dark_surfaces();
  repairs();
  model_commands();
  bank_switches();
  steps_with_the_most_expensive_image();
  board::write(
      hal::replay::TextLine().text(failure == nullptr ? "all steps done" : failure).text("\n").c_str());
  return failure == nullptr ? 0 : 1;
}

}  // namespace
}  // namespace tumblesight::fsw

int main() {
  tumblesight::hal::board::end(tumblesight::fsw::run());
}
