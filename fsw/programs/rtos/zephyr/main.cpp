// The main thread of Zephyr is the flight task.
#include "fsw/programs/rtos/zephyr/flight.hpp"

namespace {

using namespace tumblesight::fsw::rtos;

ZephyrFlight flight;

const char* fly(const Board& board) {
  if (!flight.start(board)) return "Zephyr refused a message queue";
  start_drivers(flight);
  flight.run(board);
  return "Zephyr stopped the timer";
}

}  // namespace

// After the thread has ended, the watchdog resets the processor.
int main() {
  const Board the_board = board();
  the_board.log(fly(the_board));
  return 0;
}
