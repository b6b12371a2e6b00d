/* Reads the frames of a recording (format: hal/replay/recording.hpp) one after the other. */
#ifndef TUMBLESIGHT_PLAY_RECORDING_H
#define TUMBLESIGHT_PLAY_RECORDING_H

#include "cfe.h"

#define TUMBLESIGHT_PLAY_MAX_RAYS 128

typedef struct {
  uint32 Fov_urad;
  uint16 Rays;
  uint16 Ranges[TUMBLESIGHT_PLAY_MAX_RAYS * TUMBLESIGHT_PLAY_MAX_RAYS];
  bool ChaserIsKnown;
  int32 Q_Inertial_Lrf[4];
} TUMBLESIGHT_PLAY_Frame_t;

typedef struct {
  const uint8* Bytes;
  size_t End; /* of the frames */
  size_t At;  /* of the next frame */
  uint16 Rays;
  bool HasAttitudes; /* of the chaser */
  uint32 Frames;     /* in the recording */
  uint32 Read;
} TUMBLESIGHT_PLAY_Recording_t;

/* False: the bytes are no recording of version 1 or 2. */
bool TUMBLESIGHT_PLAY_Open(TUMBLESIGHT_PLAY_Recording_t* Recording, const uint8* Bytes, size_t Size);

/* False: there is no further frame, or the rest is damaged. */
bool TUMBLESIGHT_PLAY_ReadFrame(TUMBLESIGHT_PLAY_Recording_t* Recording, TUMBLESIGHT_PLAY_Frame_t* Frame);

/* To the first frame. */
void TUMBLESIGHT_PLAY_Rewind(TUMBLESIGHT_PLAY_Recording_t* Recording);

#endif /* TUMBLESIGHT_PLAY_RECORDING_H */
