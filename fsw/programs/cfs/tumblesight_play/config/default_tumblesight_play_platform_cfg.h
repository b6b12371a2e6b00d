/* What a mission may change of the player. A mission's own file of the name tumblesight_play_platform_cfg.h
 * takes the place of this one. */
#ifndef TUMBLESIGHT_PLAY_PLATFORM_CFG_H
#define TUMBLESIGHT_PLAY_PLATFORM_CFG_H

/* A recording of `tumblesight record`; tests/audit/near_shoemaker.tslr is one. */
#define TUMBLESIGHT_PLAY_FILE "/cf/near_shoemaker.tslr"
/* Room for the recording [bytes]. */
#define TUMBLESIGHT_PLAY_BYTES (1024 * 1024)
/* Time between two frames. Recordings have 2700 ms; another value shows another rotation. */
#define TUMBLESIGHT_PLAY_PERIOD_MS 2700

#endif /* TUMBLESIGHT_PLAY_PLATFORM_CFG_H */
