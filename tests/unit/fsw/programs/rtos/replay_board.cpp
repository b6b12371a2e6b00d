#include "tests/unit/fsw/programs/rtos/replay_board.hpp"

namespace tumblesight::fsw::rtos {

std::unique_ptr<ReplayBoard>& replay_board() {
  static std::unique_ptr<ReplayBoard> the_board;
  return the_board;
}

Board board() {
  ReplayBoard& replayed = *replay_board();
  Board board;
  board.platform.models = &replayed.models;
  board.platform.command_keys = replayed.keys;
  board.platform.reset_cause = hal::ResetCause::kPowerOn;
  board.watchdog = &replayed.watchdog;
  board.navigation = &replayed.replay.navigation;
  board.log = [](const char* text) { replay_board()->log += text; };
  return board;
}

}  // namespace tumblesight::fsw::rtos
