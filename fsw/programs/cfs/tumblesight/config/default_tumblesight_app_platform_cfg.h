/* What a mission may change of the Tumblesight app. A mission's own file of the name
 * tumblesight_app_platform_cfg.h takes the place of this one. */
#ifndef TUMBLESIGHT_APP_PLATFORM_CFG_H
#define TUMBLESIGHT_APP_PLATFORM_CFG_H

/* The model images of banks 0 and 1: `tumblesight quantize` writes them, fsw/models/ holds the shipped ones.
 * "": the bank is empty at start-up, and the ground can load an image into it. */
#define TUMBLESIGHT_APP_MODEL_FILE_0 "/cf/near_shoemaker.tsm"
#define TUMBLESIGHT_APP_MODEL_FILE_1 ""

/* Banks for model images, 1 or 2. With one, no other image can be loaded in flight. */
#define TUMBLESIGHT_APP_BANKS 2

/* Room for an image [bytes], a multiple of 64, in static memory of the app for each bank. */
#define TUMBLESIGHT_APP_MODEL_BYTES (1472 * 1024)

/* Refuse the model of another target; "": any. */
#define TUMBLESIGHT_APP_EXPECTED_TARGET ""

#define TUMBLESIGHT_APP_TABLE_FILE "/cf/tumblesight_tbl.tbl"

/* 1: after a processor reset with the subtype RESET_COMMAND the mode RUN goes on. 0: RUN becomes STANDBY, as
 * after every other reset but power-on. Many platform support packages report this subtype after an
 * exception, too. */
#define TUMBLESIGHT_APP_TRUSTS_RESET_COMMAND 0

/* Frames that are assembled or wait for the next cycle, 32 KiB each. At least 2. */
#define TUMBLESIGHT_APP_FRAME_BUFFERS 3

/* Messages that may wait while a cycle runs. The sum must not exceed the pipe's depth, and that must not
 * exceed OSAL's OS_QUEUE_MAX_DEPTH. */
#define TUMBLESIGHT_APP_PIPE_DEPTH 48
#define TUMBLESIGHT_APP_WAKEUP_LIMIT 1
#define TUMBLESIGHT_APP_SEND_HK_LIMIT 2
#define TUMBLESIGHT_APP_CMD_LIMIT 16
#define TUMBLESIGHT_APP_FRAME_LIMIT 24 /* a frame of 128 x 128 rays has 8 segments */
#define TUMBLESIGHT_APP_NAV_LIMIT 5

#endif /* TUMBLESIGHT_APP_PLATFORM_CFG_H */
