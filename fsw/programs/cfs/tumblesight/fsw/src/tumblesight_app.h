/* The data of the app. All of it is static. */
#ifndef TUMBLESIGHT_APP_H
#define TUMBLESIGHT_APP_H

#include "cfe.h"
#include "fsw/c/tumblesight_c.h"
#include "tumblesight_app_frames.h"
#include "tumblesight_app_msg.h"
#include "tumblesight_app_platform_cfg.h"

typedef struct {
  uint32 RunStatus;
  CFE_SB_PipeId_t Pipe;
  CFE_TBL_Handle_t Table;
  bool HasTable;

  struct tumblesight_app* App;
  int64 LastCycle_ns; /* 0: there was none */

  TUMBLESIGHT_APP_Frames_t Frames;
  struct tumblesight_chaser Chaser; /* the newest one */
  TUMBLESIGHT_APP_HkTlm_t HkTlm;
  uint64 Memory[TUMBLESIGHT_MEMORY_BYTES / sizeof(uint64)]; /* of App */
} TUMBLESIGHT_APP_Data_t;

extern TUMBLESIGHT_APP_Data_t TUMBLESIGHT_APP_Data;

/* The counters of the housekeeping. */
#define TUMBLESIGHT_APP_COUNTERS (TUMBLESIGHT_APP_Data.HkTlm.Payload)

/* A status of cFE for a format with 0x%08lX: without the sign, which would take 64 bits. */
#define TUMBLESIGHT_APP_RC(Status) ((unsigned long)(uint32)(Status))

/* The task. Named in cfe_es_startup.scr. */
void TUMBLESIGHT_Main(void);

#endif /* TUMBLESIGHT_APP_H */
