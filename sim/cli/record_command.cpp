#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "gnc/numerics/crc.hpp"
#include "hal/replay/recording.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/disturbance_arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/recording/frames_file.hpp"
#include "sim/recording/make_recording.hpp"
#include "sim/recording/recorded_steps.hpp"
#include "sim/recording/recording_file.hpp"
#include "sim/recording/truth_file.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kNoTruth = "none";

struct RecordArguments {
  ScenarioArguments scenario;
  std::string out;
  std::string truth;  // empty: beside the recording
  std::string mcap;   // empty: none
};

// Empty: none is written. A device has nothing beside it.
std::string truth_path(const RecordArguments& arguments) {
  if (arguments.truth == kNoTruth) return {};
  if (!arguments.truth.empty()) return arguments.truth;
  std::error_code error;
  const std::filesystem::path out(arguments.out);
  const bool device = std::filesystem::is_other(out, error) || out.parent_path() == "/dev";
  return device ? std::string() : truth_path_of(arguments.out);
}

// The recording again, as a run without a flight program.
void write_mcap(const RecordArguments& arguments, const std::vector<std::uint8_t>& bytes,
                const std::vector<RecordedTruth>& rows, double swath_m) {
  const RecordingFile recording = recording_of(bytes, arguments.out);
  const std::vector<std::optional<RecordedTruth>> truth(rows.begin(), rows.end());
  RecordedSteps steps(recording, truth, swath_m);
  const std::uint32_t crc32 = gnc::crc32(recording.bytes.data(), recording.bytes.size());
  write_frames_file(arguments.mcap, steps, arguments.scenario.target, std::max<std::uint32_t>(1, crc32),
                    swath_m);
}

void record(const RecordArguments& arguments) {
  const ScenarioArguments& wanted = arguments.scenario;
  require_supported_length(wanted);
  require_possible_disturbances(wanted.disturbances, wanted.frames);
  const std::string truth = truth_path(arguments);
  // tumblesight replay would score these frames with the truth of others.
  const std::string beside = truth_path_of(arguments.out);
  const bool is_another = beside != truth || !std::filesystem::exists(arguments.out);
  if (is_another && std::filesystem::is_regular_file(beside)) {
    throw std::runtime_error(fmt::format(
        "'{}' is the truth of an earlier recording of this name; remove it, or give another --out", beside));
  }
  require_usable_files(files_read(wanted),
                       {{"--out", arguments.out}, {"--truth", truth}, {"--mcap", arguments.mcap}});
  const TargetSetup target = set_up_target_without_model(wanted);
  for (const std::string& warning : target.warnings) print_note(warning);
  RecordingSettings settings;
  settings.scenario = scenario_settings(wanted, target);
  settings.seed = wanted.seed;
  settings.sequences = wanted.sequences;
  const FlashLidar lidar(observed_bodies(wanted.effects, wanted.target, target.mesh));
  const FrameRenderer renderer(lidar, 1e-3 * target.projection.swath_mm);

  const std::uint32_t total = wanted.sequences * wanted.frames;
  ProgressBar bar("recording", "frames", total);
  auto [bytes, rows] = make_recording(renderer, settings, [&](std::uint32_t done) { bar.update(done); });
  bar.finish();
  const SensorDescription& sensor = wanted.sensor.sensor;
  for (RecordedTruth& row : rows) {
    if (show_the_target(wanted.effects)) row.target = wanted.target;
    row.sensor = {sensor.name, crc32_of(sensor)};
  }
  write_file(arguments.out, bytes);
  if (!truth.empty()) write_file(truth, truth_csv(rows));
  hal::replay::Recording recording;
  if (recording.open(bytes.data(), bytes.size()) != hal::replay::RecordingStatus::kOk)
    throw std::logic_error("the recording that was made is not valid");
  if (!arguments.mcap.empty()) write_mcap(arguments, bytes, rows, renderer.swath_m());
  fmt::print("\n  {}, {}: {}, {} bytes: {}\n", wanted.target, wanted.condition,
             counted(recording.frames(), "frame"), bytes.size(), full_path(arguments.out));
  fmt::print("  sensor {}, {}\n", to_string(sensor), to_string(target.ranges));
  fmt::print("  truth: {}\n", truth.empty() ? kNoTruth : full_path(truth));
  if (!arguments.mcap.empty()) fmt::print("  MCAP: {}\n", full_path(arguments.mcap));
  fmt::print("\n");
}

}  // namespace

void add_record_command(Command& app, const std::string&) {
  auto arguments = std::make_shared<RecordArguments>();
  arguments->scenario.sequences = 2;
  Command command = add_verb(app, "record");
  command.footer(
      "\nThe recording holds the frames of the LiDAR, one every 2.7 s unless --period\n"
      "says otherwise, the chaser's attitude at each, and a pause between two\n"
      "sequences. The truth is a text file with the true attitude, rate and position\n"
      "of each frame. docs/icd.md describes both formats. `tumblesight replay` runs\n"
      "the flight program over a recording; flight_replay on a board has one inside.\n\n"
      "Conditions\n" +
      condition_explanations() +
      "\nExample: a recording as the audit replays it on every processor\n"
      "  tumblesight record --target near_shoemaker --condition degraded \\\n"
      "      --out frames.tslr\n");
  add_target_options(command, arguments->scenario);
  add_condition_option(command, arguments->scenario.condition);
  add_sequence_options(command, arguments->scenario);
  add_sensor_options(command, arguments->scenario.sensor);
  add_effect_option(command, arguments->scenario.effects);
  add_disturbance_options(command, arguments->scenario.disturbances);
  command
      .add_option("--model", arguments->scenario.model,
                  "model image that is to see the frames: its swath, its sensor [the one that ships for the "
                  "target; without one the mesh]")
      ->check(existing_model_image())
      ->type_name("FILE");
  command.add_option("--out", arguments->out, "recording to write")
      ->required()
      ->check(file_path())
      ->type_name("FILE");
  command
      .add_option("--truth", arguments->truth,
                  "truth to write [beside the recording: FRAMES.truth.csv]; none: no truth")
      ->check(file_path())
      ->type_name("FILE");
  command
      .add_option(
          "--mcap", arguments->mcap,
          "also write frames and truth as an MCAP file, for tumblesight console and replay, Foxglove, "
          "Lichtblick or PlotJuggler")
      ->check(file_path())
      ->type_name("FILE");
  command.callback([arguments, command] {
    take_period_of_sensor(command, arguments->scenario);
    require_a_name(command, {arguments->scenario.mesh});
    record(*arguments);
  });
}

}  // namespace tumblesight::sim
