/* Assembles LiDAR frames from their segments. */
#ifndef TUMBLESIGHT_APP_FRAMES_H
#define TUMBLESIGHT_APP_FRAMES_H

#include "cfe.h"
#include "fsw/c/tumblesight_c.h"
#include "tumblesight_app_msg.h"
#include "tumblesight_app_platform_cfg.h"

typedef struct {
  TUMBLESIGHT_APP_FrameSegment_Payload_t First; /* without ranges: the fields that all segments share */
  uint32 Missing;                               /* bit n: segment n has not arrived; 0: complete or empty */
  uint32 Cycles;                                /* that passed since the first segment */
  bool IsRepeat;                                /* of a frame that was assembled before */
  uint32 Age;                                   /* order of arrival; 0: the buffer is free */
  uint16 Ranges[TUMBLESIGHT_MAX_RAYS * TUMBLESIGHT_MAX_RAYS];
} TUMBLESIGHT_APP_FrameBuffer_t;

/* What tells a frame from others. */
typedef struct {
  uint32 SequenceNumber;
  CFE_TIME_SysTime_t Exposure;
} TUMBLESIGHT_APP_FrameId_t;

#define TUMBLESIGHT_APP_REMEMBERED_FRAMES 4

typedef struct {
  TUMBLESIGHT_APP_FrameBuffer_t Buffers[TUMBLESIGHT_APP_FRAME_BUFFERS];
  struct tumblesight_frame List[TUMBLESIGHT_APP_FRAME_BUFFERS]; /* the complete frames of this cycle */
  TUMBLESIGHT_APP_FrameId_t Assembled[TUMBLESIGHT_APP_REMEMBERED_FRAMES]; /* the last ones */
  uint32 AssembledCount;
  uint32 Arrivals;
  uint32 Dropped; /* since the last cycle */
} TUMBLESIGHT_APP_Frames_t;

/* A message of TUMBLESIGHT_APP_FRAME_MID. */
void TUMBLESIGHT_APP_TakeSegment(const TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment);

/* The complete frames for a cycle, the oldest first: they stay valid until TUMBLESIGHT_APP_EndFrames(). */
size_t TUMBLESIGHT_APP_ListFrames(void);

/* After a cycle: frees the buffers of the frames that it had, and those of frames that stay incomplete. */
void TUMBLESIGHT_APP_EndFrames(void);

#endif /* TUMBLESIGHT_APP_FRAMES_H */
