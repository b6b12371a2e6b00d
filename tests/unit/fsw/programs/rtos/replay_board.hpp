// The board of a flight program on a real-time operating system, with the recorded frames of flight_replay.
// Each is exposed and delivered just before the release of a cycle.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "fsw/programs/rtos/board.hpp"
#include "hal/fake/fake_platform.hpp"
#include "hal/packets/telemetry_encoder.hpp"
#include "tests/support/golden_replay.hpp"

namespace tumblesight::fsw::rtos {

// The image of the replay in one bank.
class ReplayModelStore final : public hal::ModelStore {
 public:
  explicit ReplayModelStore(const test::GoldenReplay& replay) : replay_(replay) {}
  hal::ModelBank bank(int index) override {
    return index == 0 ? hal::ModelBank{replay_.model(), hal::BankWriting::kReadOnly, replay_.model_bytes(),
                                       replay_.model_bytes()}
                      : hal::ModelBank{};
  }

 private:
  const test::GoldenReplay& replay_;
};

struct ReplayBoard {
  test::GoldenReplay replay;
  ReplayModelStore models{replay};
  hal::fake::FakeWatchdog watchdog;
  const hal::CommandKeys* keys = nullptr;
  std::optional<hal::CommandPacket> command;  // for each cycle
  int drivers_started = 0;
  std::string log;

  // What the tasks of sensor and radio do between two cycles. `now_ns`: the exposure of the frame. False:
  // none is left.
  template <class Flight>
  bool exchange(Flight& flight, std::int64_t& now_ns) {
    hal::packets::TelemetryPacket packet;
    bool has_stepped = false;
    for (; flight.link().take(packet); has_stepped = true) replay.take(packet.bytes.data(), packet.size);
    if (has_stepped) replay.end_cycle(flight.app().state_crc32());
    if (!replay.recording.has_next()) return false;
    if (command) flight.link().put(*command);
    gnc::RangeImage* const frame = flight.lidar().begin_frame();
    if (frame == nullptr) return false;
    replay.recording.read_next(*frame);
    now_ns = frame->exposure_time_ns;
    flight.lidar().end_frame(frame);
    return true;
  }
};

// Renewed for each test: replay_board() = std::make_unique<ReplayBoard>().
std::unique_ptr<ReplayBoard>& replay_board();

}  // namespace tumblesight::fsw::rtos
