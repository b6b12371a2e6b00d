#include "sim/cli/record_command.hpp"

#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "hal/replay/recording.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/terminal/progress.hpp"
#include "sim/world/scenario/random.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {
namespace {

struct RecordArguments {
  ScenarioArguments scenario;
  std::string out;
};

// Between two sequences, so that the application takes the second for a new one.
constexpr std::int64_t kPause_frames = 2;

class Recorder {
 public:
  Recorder(std::uint16_t rays, std::uint32_t frames) : bytes_(hal::replay::kRecordingHeaderSize) {
    hal::replay::write_recording_header(rays, frames, bytes_.data());
  }
  void add(const gnc::RangeImage& frame) {
    const std::size_t size = bytes_.size();
    bytes_.resize(size + hal::replay::kRecordedFrameSize);
    bytes_.resize(size + hal::replay::write_recorded_frame(frame, bytes_.data() + size));
  }
  const std::vector<std::uint8_t>& finish() {
    const std::size_t size = bytes_.size();
    bytes_.resize(size + hal::replay::kRecordingCrcSize);
    hal::replay::write_recording_crc(bytes_.data(), size, bytes_.data() + size);
    return bytes_;
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error("--out " + path + ": cannot be written");
}

void record(const RecordArguments& arguments) {
  const ScenarioArguments& wanted = arguments.scenario;
  require_writable("--out", arguments.out);
  const TargetSetup target = set_up_target(wanted);
  ScenarioSettings settings;
  settings.condition = condition_from(wanted.condition);
  settings.frames = static_cast<int>(wanted.frames);
  if (target.inertia_kg_m2) settings.inertia_kg_m2 = *target.inertia_kg_m2;
  const SensorSettings sensor = sensor_settings(settings.condition);
  const FlashLidar lidar(target.mesh);

  const std::uint32_t total = wanted.sequences * wanted.frames;
  Recorder recorder(static_cast<std::uint16_t>(sensor.rays), total);
  const auto frame = std::make_unique<gnc::RangeImage>();
  ProgressBar bar("recording", "frames", total);
  for (std::uint32_t i = 0; i < wanted.sequences; ++i) {
    const Sequence sequence = make_sequence(settings, wanted.seed, i);
    for (std::uint32_t k = 0; k < wanted.frames; ++k) {
      lidar.expose(sequence.frames[k], sensor, target.projection.swath_mm / 1000.0,
                   mix(sequence.noise_seed, k), *frame);
      frame->sequence_number = i * wanted.frames + k;
      frame->exposure_time_ns = kFramePeriod_ns * (frame->sequence_number + kPause_frames * i);
      recorder.add(*frame);
      bar.update(frame->sequence_number + 1);
    }
  }
  bar.finish();
  const std::vector<std::uint8_t>& bytes = recorder.finish();
  write_file(arguments.out, bytes);
  fmt::print("\n  {} {} frames of {}, {} bytes: {}\n\n", total, wanted.condition, wanted.target, bytes.size(),
             full_path(arguments.out));
}

}  // namespace

void add_record_command(CLI::App& app) {
  auto arguments = std::make_shared<RecordArguments>();
  arguments->scenario.sequences = 2;
  CLI::App* command = app.add_subcommand("record", "Render frames into a file, for flight_replay on a board");
  command->footer(
      "\nThe frames of the LiDAR, one per 2.7 s. The file format is described in "
      "hal/replay/recording.hpp.\n\n"
      "Example: a recording like the one that the audit of the processors uses\n"
      "  tumblesight record --target near_shoemaker --condition degraded --out frames.tslr\n");
  add_target_options(*command, arguments->scenario);
  add_condition_option(*command, arguments->scenario.condition);
  add_sequence_options(*command, arguments->scenario);
  command->add_option("--out", arguments->out, "recording to write")->required()->type_name("FILE");
  command->callback([arguments] { record(*arguments); });
}

}  // namespace tumblesight::sim
