#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "sim/adoption/adoption.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/mission_arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/host/place.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/text.hpp"
#include "sim/model/model_file.hpp"
#include "sim/training/mission_training.hpp"
#include "sim/world/scenario/condition.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWidth = 78;

std::atomic<bool> stop_requested{false};

struct AdoptArguments {
  std::string mission;
  double minutes = 0.0;  // 0: the mission's
  std::string out;       // empty: out/<name>
  std::string start_from;
  std::uint64_t seed = 1;
  std::uint32_t sequences = 0;  // 0: by the time
  int threads = 0;              // 0: one per core
};

// The float32 images of the targets that ship, as far as they are in fsw/models.
std::vector<std::string> shipped_starts() {
  std::vector<std::string> images;
  std::error_code error;
  for (const std::string& name : target_names()) {
    const std::string image = shipped_model_path(name + ".float32");
    if (fs::is_regular_file(image, error)) images.push_back(image);
  }
  return images;
}

// Now rather than after the training.
void require_programs(const std::string& program) {
  const std::string flight = (fs::path(program).parent_path() / "flight").string();
  if (!fs::exists(flight))
    throw std::runtime_error("the flight program '" + flight + "' is not there; build it too: ninja flight");
}

AdoptionSettings settings_of(const AdoptArguments& arguments, const std::string& command_line) {
  AdoptionSettings settings;
  try {
    settings.mission = mission_named(arguments.mission, condition_names());
    (void)training_conditions(settings.mission);
    (void)target_symmetry_from(settings.mission.symmetry);
  } catch (const std::invalid_argument& error) {
    throw ArgumentFault("MISSION", error.what());
  }
  use_mission(settings.mission);
  const SensorArguments sensor = sensor_arguments_of(settings.mission);
  settings.sensor = sensor.sensor;
  settings.ranges_of = [sensor](double swath_m) {
    std::vector<std::string> warnings;
    try {
      const RangeLimits ranges = ranges_of(sensor, swath_m, warnings);
      for (const std::string& warning : warnings) print_note(warning);
      return ranges;
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(std::string(error.what()) +
                                  "; in a mission: ranges_m = [NEAREST, FARTHEST]");
    }
  };
  settings.start_was_given = !arguments.start_from.empty();
  settings.folder = arguments.out.empty() ? "out/" + settings.mission.name : arguments.out;
  settings.minutes = arguments.minutes > 0.0 ? arguments.minutes : settings.mission.minutes;
  settings.seed = arguments.seed;
  settings.sequences = arguments.sequences;
  settings.start_from = arguments.start_from.empty() ? shipped_starts()
                        : arguments.start_from == "random"
                            ? std::vector<std::string>{}
                            : std::vector<std::string>{full_path(arguments.start_from)};
  settings.threads = arguments.threads > 0
                         ? arguments.threads
                         : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  settings.program = tool_path().string();
  settings.command = command_line;
  require_programs(settings.program);
  return settings;
}

void require_usable_folder(const AdoptionSettings& settings) {
  require_folder("--out", settings.folder);
  const std::string stem = settings.folder + "/" + settings.mission.name;
  OptionFiles read = mesh_files_read("the mission's mesh", settings.mission.mesh.file);
  read.push_back({"MISSION", settings.mission.file});
  for (const std::string& image : settings.start_from) read.push_back({"--start-from", image});
  OptionFiles written;
  for (const std::string& path : {stem + ".tsm", stem + ".float32.tsm", settings.folder + "/verdict.json",
                                  settings.folder + "/report.html", settings.folder + "/progress.html"})
    written.push_back({"--out", path});
  require_usable_files(read, written);
}

// Two runs would write the same checkpoints. The lock ends with the program.
void lock_folder(const std::string& folder) {
  fs::create_directories(folder + "/training");
  const std::string path = folder + "/training/lock";
  const int file = open_to_write(path, O_RDWR);
  if (flock(file, LOCK_EX | LOCK_NB) == 0) return;
  throw std::runtime_error("another adoption is at work in '" + folder +
                           "'; wait for it, or choose another --out");
}

void print_list(const char* heading, const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  fmt::print("\n  {}\n", heading);
  for (const std::string& line : lines) {
    std::string text = "  - ";
    for (const char c : wrapped(line, kWidth - 4)) {
      text += c;
      if (c == '\n') text += "    ";
    }
    fmt::print("{}\n", text);
  }
}

void print_outcome(const AdoptionSettings& settings, const AdoptionOutcome& outcome) {
  fmt::print("\n  {}, after {:.1f} of {:g} minutes: {}\n", settings.mission.title, outcome.minutes_taken,
             settings.minutes, outcome.go ? "GO" : "NO-GO");
  for (const GoalCheck& check : outcome.checks)
    fmt::print("    {:<6} {:<9} {}: {} ({})\n", check.met ? "met" : "MISSED", to_string(check.condition),
               check.figure, check.value, check.limit);
  print_list("Reasons for NO-GO", outcome.reasons);
  print_list("What more time would bring", outcome.outlook);
  if (!outcome.model_path.empty())
    fmt::print("\n  Model image that flies: {}, CRC-32 {:08x}\n", full_path(outcome.model_path),
               outcome.model_crc32);
  fmt::print("  Report: {}\n\n", full_path(settings.folder + "/report.html"));
}

int run(const AdoptArguments& arguments, const std::string& command_line) {
  const AdoptionSettings settings = settings_of(arguments, command_line);
  require_usable_folder(settings);
  lock_folder(settings.folder);
  std::signal(SIGINT, [](int) { stop_requested = true; });
  std::signal(SIGTERM, [](int) { stop_requested = true; });
  fmt::print("\n  Adoption of {} in {:g} minutes. The page {} renews itself.\n", settings.mission.title,
             settings.minutes, full_path(settings.folder + "/progress.html"));
  const AdoptionOutcome outcome = adopt(settings, stop_requested);
  if (outcome.stopped) {
    fmt::print(
        "\n  Stopped. The same command goes on from here. The network so far, if a validation has been\n"
        "  reached: {}/{}.tsm\n\n",
        settings.folder, settings.mission.name);
    return kStopped;
  }
  print_outcome(settings, outcome);
  return outcome.go ? 0 : kOfNoUse;
}

}  // namespace

void add_adopt_command(Command& app, const std::string& command_line) {
  auto arguments = std::make_shared<AdoptArguments>();
  Command command = add_verb(app, "adopt");
  command.footer(
      std::string("\nChecks the mesh, trains, makes the fixed-point image, evaluates every condition\n"
                  "against the goals of the mission, flies it over DDS, all within the time, and\n"
                  "says GO or NO-GO with the reasons. Exit status: 0 GO, 4 NO-GO, 3 stopped (the\n"
                  "same command goes on), 1 failed, 2 wrong arguments.\n\n"
                  "A first mission file, craft.toml:\n") +
      kFirstMission +
      "docs/own_spacecraft.md lists all keys.\n\n"
      "Example\n"
      "  tumblesight adopt craft.toml --minutes 60\n");
  command
      .add_option("MISSION", arguments->mission, "mission file (TOML), or the name of a target that ships")
      ->required()
      ->type_name("FILE|NAME");
  limit_number(command.add_option("--minutes", arguments->minutes,
                                  "wall-clock time for everything [that of the mission, else 60]"),
               0.5, 100'000.0)
      ->type_name("X");
  command.add_option("--out", arguments->out, "folder for model images, report and checkpoints [out/<name>]")
      ->check(file_path())
      ->type_name("DIR");
  add_seed_option(command, arguments->seed);
  limit_whole_number(command.add_option("--sequences", arguments->sequences,
                                        "sequences per condition of the evaluation [by the time, 20 to 900]"),
                     1, 100'000)
      ->type_name("N");
  command
      .add_option("--start-from", arguments->start_from,
                  "float32 model image whose CNN to start from, or random [the nearest of those in "
                  "fsw/models; in less than 20 minutes the first]")
      ->type_name("FILE|random");
  limit_whole_number(command.add_option("--threads", arguments->threads, "worker threads, 0: one per core"),
                     0, 256)
      ->type_name("N")
      ->capture_default_str();
  command.callback([arguments, command_line] {
    if (!arguments->start_from.empty() && arguments->start_from != "random") {
      const std::string fault = fault_of_model_path(arguments->start_from);
      if (!fault.empty()) throw ArgumentFault("--start-from", fault);
      (void)read_float32_model(arguments->start_from);  // throws now rather than after the mesh
    }
    throw Exit(run(*arguments, command_line));
  });
}

}  // namespace tumblesight::sim
