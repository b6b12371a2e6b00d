/* Drivers that do nothing, so that smallest.c links everywhere: no frame arrives, and the program ends after
 * ten periods. */
#include "board.h"

#include <stdio.h>

extern const uint8_t model_image[], model_image_end[]; /* model_image.S */

const uint8_t* board_model_image(size_t* size_bytes) {
  *size_bytes = (size_t)(model_image_end - model_image);
  return model_image;
}

bool board_wait(int64_t* now_ns) {
  static int periods = 0;
  *now_ns = ++periods * TUMBLESIGHT_PERIOD_NS;
  return periods <= 10;
}

const struct tumblesight_frame* board_frames(size_t* count) {
  *count = 0;
  return NULL;
}

struct tumblesight_chaser board_chaser(int64_t now_ns) {
  const struct tumblesight_chaser unknown = {now_ns, {0, 0, 0, 0}, false};
  return unknown;
}

void board_send(const struct tumblesight_app* app, const struct tumblesight_outputs* outputs) {
  printf("cycle %u: mode %u, validity %u, state %08x\n", (unsigned)outputs->telemetry.cycles,
         (unsigned)outputs->telemetry.mode, (unsigned)outputs->attitude.validity,
         (unsigned)tumblesight_state_crc32(app));
}

void board_kick_watchdog(void) {}

void board_log(const char* text) {
  puts(text);
}
