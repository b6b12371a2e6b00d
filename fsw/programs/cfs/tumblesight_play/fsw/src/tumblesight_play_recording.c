#include "tumblesight_play_recording.h"

#include <string.h>

#define HEADER_BYTES 12
#define CRC_BYTES 4
#define VERSION 2
#define VERSION_WITHOUT_ATTITUDES 1
/* Exposure time 8, sequence number 4, field of view 4; then the chaser: known 1, time 8, quaternion 16. */
#define FRAME_HEADER_BYTES 16
#define FOV_OFFSET 12
#define ATTITUDE_BYTES 25
#define QUATERNION_OFFSET 9
#define ROW_HEADER_BYTES 2

static uint32 Number(const uint8* From, int Bytes) {
  uint32 Value = 0;
  for (int i = Bytes - 1; i >= 0; --i) Value = Value << 8 | From[i];
  return Value;
}

void TUMBLESIGHT_PLAY_Rewind(TUMBLESIGHT_PLAY_Recording_t* Recording) {
  Recording->At = HEADER_BYTES;
  Recording->Read = 0;
}

bool TUMBLESIGHT_PLAY_Open(TUMBLESIGHT_PLAY_Recording_t* Recording, const uint8* Bytes, size_t Size) {
  if (Size < HEADER_BYTES + CRC_BYTES || memcmp(Bytes, "TSLR", 4) != 0) return false;
  const uint32 Version = Number(Bytes + 4, 2);
  if (Version != VERSION && Version != VERSION_WITHOUT_ATTITUDES) return false;
  Recording->HasAttitudes = Version == VERSION;

  Recording->Bytes = Bytes;
  Recording->End = Size - CRC_BYTES;
  Recording->Rays = (uint16)Number(Bytes + 6, 2);
  Recording->Frames = Number(Bytes + 8, 4);
  TUMBLESIGHT_PLAY_Rewind(Recording);
  return Recording->Rays >= 1 && Recording->Rays <= TUMBLESIGHT_PLAY_MAX_RAYS;
}

/* False: the row reaches beyond the frame or the recording. */
static bool ReadRow(TUMBLESIGHT_PLAY_Recording_t* Recording, uint16* Row) {
  const uint8* From = Recording->Bytes + Recording->At;
  if (Recording->At + ROW_HEADER_BYTES > Recording->End) return false;
  const uint32 First = From[0];
  const uint32 Count = From[1];
  if (First + Count > Recording->Rays || Recording->At + ROW_HEADER_BYTES + 2 * Count > Recording->End)
    return false;
  for (uint32 i = 0; i < Count; ++i) Row[First + i] = (uint16)Number(From + ROW_HEADER_BYTES + 2 * i, 2);
  Recording->At += ROW_HEADER_BYTES + 2 * Count;
  return true;
}

static void ReadAttitude(const uint8* From, TUMBLESIGHT_PLAY_Frame_t* Frame) {
  Frame->ChaserIsKnown = From[0] == 1;
  for (int i = 0; i < 4; ++i) Frame->Q_Inertial_Lrf[i] = (int32)Number(From + QUATERNION_OFFSET + 4 * i, 4);
}

bool TUMBLESIGHT_PLAY_ReadFrame(TUMBLESIGHT_PLAY_Recording_t* Recording, TUMBLESIGHT_PLAY_Frame_t* Frame) {
  const uint8* From = Recording->Bytes + Recording->At;
  const size_t HeadBytes = FRAME_HEADER_BYTES + (Recording->HasAttitudes ? ATTITUDE_BYTES : 0);
  if (Recording->Read == Recording->Frames || Recording->At + HeadBytes > Recording->End) return false;
  memset(Frame, 0, sizeof *Frame);
  Frame->Rays = Recording->Rays;
  Frame->Fov_urad = Number(From + FOV_OFFSET, 4);
  if (Recording->HasAttitudes) ReadAttitude(From + FRAME_HEADER_BYTES, Frame);
  Recording->At += HeadBytes;
  for (uint16 Row = 0; Row < Recording->Rays; ++Row)
    if (!ReadRow(Recording, &Frame->Ranges[Row * Recording->Rays])) return false;
  ++Recording->Read;
  return true;
}
