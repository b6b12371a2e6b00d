// GoldenReplay: the model and the frames of flight_replay for another flight program, and the digest of the
// telemetry packets that it sends. It has to be the golden one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/replay/console_link.hpp"
#include "hal/replay/replay_inputs.hpp"

namespace tumblesight::test {

class GoldenReplay {
 public:
  GoldenReplay();

  hal::replay::Recording recording;
  hal::replay::ReplayNavigation navigation{recording};

  const std::uint8_t* model() const { return model_lines_[0].bytes; }
  std::size_t model_bytes() const { return model_bytes_; }

  // A telemetry packet of the program. Packets of telemetry are not part of the digest.
  void take(const std::uint8_t* packet, std::size_t size);
  const hal::Telemetry& telemetry() const { return telemetry_; }  // the newest
  // After the packets of a cycle.
  void end_cycle(std::uint32_t state_crc32) { link_.digest(state_crc32); }

  std::string digest() const;
  static std::string golden_digest();

 private:
  struct alignas(64) Line {
    std::uint8_t bytes[64];
  };

  std::vector<std::uint8_t> recorded_;
  std::vector<Line> model_lines_;
  std::size_t model_bytes_ = 0;
  hal::replay::ConsoleLink link_;
  hal::Telemetry telemetry_;
};

}  // namespace tumblesight::test
