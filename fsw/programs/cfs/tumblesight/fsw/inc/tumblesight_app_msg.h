/* The messages that the Tumblesight app takes from other apps, and its housekeeping. Numbers are in the
 * processor's byte order. The packets of docs/icd.md are big-endian. */
#ifndef TUMBLESIGHT_APP_MSG_H
#define TUMBLESIGHT_APP_MSG_H

#include "cfe.h"

/* Rays of a segment: 4 KiB, so that no mission has to raise the largest message of its software bus. */
#define TUMBLESIGHT_APP_SEGMENT_RAYS 2048

/* The attitude of the chaser's LiDAR: v_inertial = Q_Inertial_Lrf v_lrf. */
typedef struct {
  CFE_TIME_SysTime_t Time; /* for which it holds, mission elapsed time (MET) */
  int32 Q_Inertial_Lrf[4]; /* Hamilton, scalar first, Q30 */
  uint32 IsKnown;          /* 0 or 1 */
} TUMBLESIGHT_APP_Attitude_t;

/* A part of a LiDAR frame of Rays x Rays ranges, row by row from the top left. The segments of a frame may
 * come in any order. All fields but Offset, Count and Ranges are the same in each of them. */
typedef struct {
  CFE_TIME_SysTime_t Exposure; /* MET */
  uint32 SequenceNumber;       /* of the frame: one more for each frame of the sensor */
  uint32 Fov_urad;             /* full field of view of both axes */
  uint16 Rays;                 /* per side, 1 ... 128 */
  uint16 Offset;               /* of the first range: a multiple of SEGMENT_RAYS */
  uint16 Count;                /* SEGMENT_RAYS, or what is left in the last segment */
  uint16 Spare;
  TUMBLESIGHT_APP_Attitude_t Chaser;           /* at the exposure */
  uint16 Ranges[TUMBLESIGHT_APP_SEGMENT_RAYS]; /* along the ray [1/128 m]; 0: no return */
} TUMBLESIGHT_APP_FrameSegment_Payload_t;

/* A message may end behind the last range that Count announces. */
typedef struct {
  CFE_MSG_TelemetryHeader_t TelemetryHeader;
  TUMBLESIGHT_APP_FrameSegment_Payload_t Payload;
} TUMBLESIGHT_APP_FrameSegment_t;

/* The chaser's attitude between frames. The newest one before a cycle is used for it. */
typedef struct {
  CFE_MSG_TelemetryHeader_t TelemetryHeader;
  TUMBLESIGHT_APP_Attitude_t Attitude;
} TUMBLESIGHT_APP_Navigation_t;

/* A message without payload. */
typedef struct {
  CFE_MSG_CommandHeader_t CommandHeader;
} TUMBLESIGHT_APP_NoArgs_t;

/* Counters since the start or the last RESET_COUNTERS. What the flight application counts is in its telemetry
 * packet, TUMBLESIGHT_APP_TLM_MID. */
typedef struct {
  uint32 Cycles;
  uint32 SegmentsTaken;
  uint32 SegmentsRefused; /* impossible fields, or unlike the frame's other segments */
  uint32 SegmentsRepeated;
  uint32 FramesAssembled;
  uint32 FramesIncomplete; /* dropped: not complete by the second cycle, or no buffer was left */
  uint32 FramesSuperseded; /* dropped although complete: more than there are buffers came in one cycle */
  uint32 CommandsTaken;
  uint32 CommandsDropped; /* more than 8 in a cycle */
  uint32 MessagesRefused; /* of an unknown id or a wrong length */
  uint32 PacketsSent;
  uint32 PacketsLost; /* the software bus had no buffer, or refused them */
  uint32 TableUpdates;
  uint32 StoreErrors; /* the critical data store could not be read or written */
} TUMBLESIGHT_APP_HkTlm_Payload_t;

typedef struct {
  CFE_MSG_TelemetryHeader_t TelemetryHeader;
  TUMBLESIGHT_APP_HkTlm_Payload_t Payload;
} TUMBLESIGHT_APP_HkTlm_t;

#endif /* TUMBLESIGHT_APP_MSG_H */
