/* The platform of the flight application on cFE: time, the critical data store (CDS), model files, the cause
 * of the reset. */
#ifndef TUMBLESIGHT_APP_PLATFORM_H
#define TUMBLESIGHT_APP_PLATFORM_H

#include "cfe.h"
#include "fsw/c/tumblesight_c.h"
#include "tumblesight_app_msg.h"

/* To the nearest nanosecond. */
int64 TUMBLESIGHT_APP_ToNanoseconds(CFE_TIME_SysTime_t Time);

struct tumblesight_chaser TUMBLESIGHT_APP_ToChaser(const TUMBLESIGHT_APP_Attitude_t* Attitude);

/* Registers the CDS, reads the model files, and sets all of `Settings` (zero before). */
void TUMBLESIGHT_APP_SetUpPlatform(struct tumblesight_settings* Settings);

#endif /* TUMBLESIGHT_APP_PLATFORM_H */
