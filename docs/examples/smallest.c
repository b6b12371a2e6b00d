/* The smallest flight program in C: frames in, attitudes out. board.h stands for your drivers. */
#include "board.h"

static uint64_t memory[TUMBLESIGHT_MEMORY_BYTES / sizeof(uint64_t)];

int main(void) {
  struct tumblesight_settings settings = {0};
  settings.bank[0].image = board_model_image(&settings.bank[0].image_bytes);
  settings.reset_cause = TUMBLESIGHT_RESET_POWER_ON;

  struct tumblesight_app* app = NULL;
  const enum tumblesight_status status = tumblesight_init(memory, sizeof memory, &settings, &app);
  if (status != TUMBLESIGHT_OK) board_log(tumblesight_status_text(status));
  if (app == NULL) return 1;

  struct tumblesight_inputs inputs = {0};
  while (board_wait(&inputs.now_ns)) {
    const struct tumblesight_outputs* outputs;
    inputs.frames = board_frames(&inputs.frame_count);
    inputs.chaser = board_chaser(inputs.now_ns);
    if (tumblesight_step(app, &inputs, &outputs) != TUMBLESIGHT_OK) continue;
    board_send(app, outputs);
    if (outputs->duties_done) board_kick_watchdog();
  }
  return 0;
}
