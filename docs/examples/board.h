/* What smallest.c needs of a board: replace these with your drivers. tests/unit/fsw/c/replay_board.cpp plays
 * a recording instead. */
#ifndef BOARD_H
#define BOARD_H

#include "fsw/c/tumblesight_c.h"

/* The model image in memory, at an address that is a multiple of 64. */
const uint8_t* board_model_image(size_t* size_bytes);
/* Waits for the next period. `*now_ns`: its time. False: the program shall end. */
bool board_wait(int64_t* now_ns);
/* The frames since the last call, at most TUMBLESIGHT_MAX_FRAMES; valid until the next call. */
const struct tumblesight_frame* board_frames(size_t* count);
/* The chaser's attitude at `now_ns`. */
struct tumblesight_chaser board_chaser(int64_t now_ns);
void board_send(const struct tumblesight_app* app, const struct tumblesight_outputs* outputs);
void board_kick_watchdog(void);
void board_log(const char* text);

#endif /* BOARD_H */
