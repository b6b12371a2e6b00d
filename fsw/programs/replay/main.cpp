// flight_replay: the flight application in its periodic loop with recorded frames, on any board. The model
// image and the recording are part of the program (blobs.S). The recording gives the time, so the
// program never waits.
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "fsw/app/attitude_init_app.hpp"
#include "fsw/app/cycle.hpp"
#include "gnc/nn/kernels/kernels.hpp"
#include "hal/board.hpp"
#include "hal/replay/console_link.hpp"
#include "hal/replay/recording.hpp"
#include "hal/replay/replay_inputs.hpp"
#include "hal/replay/text_line.hpp"

extern "C" {
extern const std::uint8_t tumblesight_model_image[], tumblesight_model_image_end[];
extern const std::uint8_t tumblesight_recording[], tumblesight_recording_end[];
}

namespace tumblesight::fsw {
namespace {

using namespace hal::replay;
namespace board = hal::board;

class BoardStopwatch final : public hal::Stopwatch {
 public:
  std::uint64_t now_ns() override { return board::now_ns(); }
};

// One read-only bank: the image in the program.
class ProgramModelStore final : public hal::ModelStore {
 public:
  hal::ModelBank bank(int index) override {
    const auto size = static_cast<std::size_t>(tumblesight_model_image_end - tumblesight_model_image);
    return index == 0 ? hal::ModelBank{tumblesight_model_image, hal::BankWriting::kReadOnly, size, size}
                      : hal::ModelBank{};
  }
};

class NoWatchdog final : public hal::Watchdog {
 public:
  void kick() override {}
};

AttitudeInitApp app;
ProgramModelStore model_store;
NoWatchdog watchdog;
CycleWorkspace workspace;
BoardStopwatch stopwatch;
Recording recording;
ConsoleLink link;

int fail(const char* what, const char* why) {
  board::write(TextLine().text("flight_replay: ").text(what).text(": ").text(why).text("\n").c_str());
  return 1;
}

// A machine with an operating system passes arguments.
#ifdef __linux__
int answer(const char* argument) {
  if (std::strcmp(argument, "--help") == 0) {
    board::write(
        "flight_replay: the flight application with recorded frames. It takes no arguments:\n"
        "model image and recording are part of the program, selected by the CMake options\n"
        "TUMBLESIGHT_REPLAY_MODEL and TUMBLESIGHT_REPLAY_RECORDING. A line per frame gives\n"
        "the attitude; the digest at the end is the same on every processor.\n\n"
        "Exit status: 0 complete, 1 failed, 2 bad arguments.\n");
    return 0;
  }
  board::write("flight_replay: ");
  board::write(argument);
  board::write(": takes no arguments; model image and recording are part of the program\n");
  return 2;
}
#endif

int run() {
  app.init({&stopwatch, &model_store, nullptr, nullptr, hal::ResetCause::kPowerOn}, nullptr);
  if (app.mode() != Mode::kRun) return fail("model image", gnc::to_string(app.boot_status(0)));
  const auto recording_size = static_cast<std::size_t>(tumblesight_recording_end - tumblesight_recording);
  const RecordingStatus status = recording.open(tumblesight_recording, recording_size);
  if (status != RecordingStatus::kOk) return fail("recording", to_string(status));
  if (recording.frames() == 0) return fail("recording", "no frames");

  board::write(TextLine()
                   .text("tumblesight, ")
                   .text(app.estimator().model().target.data())
                   .text(", ")
                   .text(Numerics::kName)
                   .text(", ")
                   .text(gnc::to_string(gnc::fastest_kernels<Numerics>().set))
                   .text(", ")
                   .number(recording.frames())
                   .text(" frames\n")
                   .c_str());
  board::write(" frame  run          w          x          y          z    ± deg          ms\n");
  ReplayLidar lidar(recording);
  ReplayNavigation navigation(recording);
  while (recording.has_next()) {
    const std::int64_t now_ns = recording.next_exposure_time_ns();
    lidar.advance_to(now_ns);
    link.announce(recording.next_sequence_number());
    run_cycle(app, {lidar, link, watchdog, stopwatch, &navigation, false}, now_ns, 0, workspace);
    link.digest(app.state_crc32());
  }
  if (!recording.was_read()) return fail("recording", "a frame is damaged");
  board::write(TextLine().text("digest ").hexadecimal(link.digest()).text("\n").c_str());
  return 0;
}

}  // namespace
}  // namespace tumblesight::fsw

int main(int argc, char** argv) {
#ifdef __linux__
  if (argc > 1) tumblesight::hal::board::end(tumblesight::fsw::answer(argv[1]));
#else
  (void)argc;
  (void)argv;
#endif
  tumblesight::hal::board::end(tumblesight::fsw::run());
}
