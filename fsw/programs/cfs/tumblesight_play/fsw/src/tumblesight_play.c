/* Plays a recording to the Tumblesight app, again and again: each period a frame in its segments, then the
 * wake-up. In a mission, the LiDAR's app sends the frames and the scheduler the wake-ups. */
#include <string.h>

#include "cfe.h"
#include "tumblesight_app_msg.h"
#include "tumblesight_app_msgids.h"
#include "tumblesight_play_platform_cfg.h"
#include "tumblesight_play_recording.h"

#define TUMBLESIGHT_PLAY_START_EID 1
#define TUMBLESIGHT_PLAY_FILE_ERR_EID 2
#define TUMBLESIGHT_PLAY_SEND_ERR_EID 3

typedef struct {
  uint8 Bytes[TUMBLESIGHT_PLAY_BYTES];
  TUMBLESIGHT_PLAY_Recording_t Recording;
  TUMBLESIGHT_PLAY_Frame_t Frame;
  TUMBLESIGHT_APP_FrameSegment_t Segment;
  TUMBLESIGHT_APP_NoArgs_t WakeUp;
  uint32 SequenceNumber;
  uint64 Next_ms; /* MET of the next frame; 0: not yet known */
} TUMBLESIGHT_PLAY_Data_t;

static TUMBLESIGHT_PLAY_Data_t Data;

void TUMBLESIGHT_Player(void);

static int32 ReadFile(void) {
  osal_id_t File = OS_OBJECT_ID_UNDEFINED;
  int32 Size = 0;
  int32 Status = OS_OpenCreate(&File, TUMBLESIGHT_PLAY_FILE, OS_FILE_FLAG_NONE, OS_READ_ONLY);
  if (Status < 0) return Status;
  do {
    Status = OS_read(File, &Data.Bytes[Size], (size_t)(TUMBLESIGHT_PLAY_BYTES - Size));
    if (Status > 0) Size += Status;
  } while (Status > 0 && Size < TUMBLESIGHT_PLAY_BYTES);
  (void)OS_close(File);
  return Status < 0 ? Status : Size;
}

static bool Initialize(void) {
  memset(&Data, 0, sizeof Data);
  if (CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY) != CFE_SUCCESS) return false;
  const int32 Size = ReadFile();
  if (Size < 0 || !TUMBLESIGHT_PLAY_Open(&Data.Recording, Data.Bytes, (size_t)Size)) {
    CFE_EVS_SendEvent(TUMBLESIGHT_PLAY_FILE_ERR_EID, CFE_EVS_EventType_ERROR,
                      "TUMBLESIGHT_PLAY: %s is no recording that can be read, RC = %ld",
                      TUMBLESIGHT_PLAY_FILE, (long)Size);
    return false;
  }
  CFE_MSG_Init(CFE_MSG_PTR(Data.Segment.TelemetryHeader), CFE_SB_ValueToMsgId(TUMBLESIGHT_APP_FRAME_MID),
               sizeof Data.Segment);
  CFE_MSG_Init(CFE_MSG_PTR(Data.WakeUp.CommandHeader), CFE_SB_ValueToMsgId(TUMBLESIGHT_APP_WAKEUP_MID),
               sizeof Data.WakeUp);
  CFE_EVS_SendEvent(TUMBLESIGHT_PLAY_START_EID, CFE_EVS_EventType_INFORMATION,
                    "TUMBLESIGHT_PLAY: plays %lu frames of %s, one each %d ms",
                    (unsigned long)Data.Recording.Frames, TUMBLESIGHT_PLAY_FILE, TUMBLESIGHT_PLAY_PERIOD_MS);
  return true;
}

static void Send(CFE_MSG_Message_t* Message) {
  const CFE_Status_t Status = CFE_SB_TransmitMsg(Message, true);
  if (Status != CFE_SUCCESS)
    CFE_EVS_SendEvent(TUMBLESIGHT_PLAY_SEND_ERR_EID, CFE_EVS_EventType_ERROR,
                      "TUMBLESIGHT_PLAY: message not sent, RC = 0x%08lX", (unsigned long)(uint32)Status);
}

static void SendFrame(CFE_TIME_SysTime_t Exposure) {
  TUMBLESIGHT_APP_FrameSegment_Payload_t* Segment = &Data.Segment.Payload;
  const uint32 Rays = (uint32)Data.Frame.Rays * Data.Frame.Rays;
  Segment->Exposure = Exposure;
  Segment->SequenceNumber = ++Data.SequenceNumber;
  Segment->Fov_urad = Data.Frame.Fov_urad;
  Segment->Rays = Data.Frame.Rays;
  Segment->Chaser.Time = Exposure;
  Segment->Chaser.IsKnown = Data.Frame.ChaserIsKnown ? 1 : 0;
  memcpy(Segment->Chaser.Q_Inertial_Lrf, Data.Frame.Q_Inertial_Lrf, sizeof Segment->Chaser.Q_Inertial_Lrf);
  for (uint32 Offset = 0; Offset < Rays; Offset += TUMBLESIGHT_APP_SEGMENT_RAYS) {
    const uint32 Left = Rays - Offset;
    Segment->Offset = (uint16)Offset;
    Segment->Count = (uint16)(Left < TUMBLESIGHT_APP_SEGMENT_RAYS ? Left : TUMBLESIGHT_APP_SEGMENT_RAYS);
    memcpy(Segment->Ranges, &Data.Frame.Ranges[Offset], Segment->Count * sizeof Segment->Ranges[0]);
    Send(CFE_MSG_PTR(Data.Segment.TelemetryHeader));
  }
}

/* The recording begins again at its end: a new sequence for the Tumblesight app. */
static bool NextFrame(void) {
  if (TUMBLESIGHT_PLAY_ReadFrame(&Data.Recording, &Data.Frame)) return true;
  TUMBLESIGHT_PLAY_Rewind(&Data.Recording);
  return TUMBLESIGHT_PLAY_ReadFrame(&Data.Recording, &Data.Frame);
}

static uint64 Met_ms(CFE_TIME_SysTime_t Met) {
  return Met.Seconds * (uint64)1000 + CFE_TIME_Sub2MicroSecs(Met.Subseconds) / 1000;
}

/* At multiples of the period, so that errors of the delays do not add up. A period that was missed is left
 * out. */
static void WaitForPeriod(void) {
  const uint64 Now_ms = Met_ms(CFE_TIME_GetMET());
  const bool IsLate = Now_ms > Data.Next_ms + TUMBLESIGHT_PLAY_PERIOD_MS;
  const bool WasSetBack = Now_ms + 2 * TUMBLESIGHT_PLAY_PERIOD_MS < Data.Next_ms;
  if (Data.Next_ms == 0 || IsLate || WasSetBack)
    Data.Next_ms = (Now_ms / TUMBLESIGHT_PLAY_PERIOD_MS + 1) * TUMBLESIGHT_PLAY_PERIOD_MS;
  if (Now_ms < Data.Next_ms) OS_TaskDelay((uint32)(Data.Next_ms - Now_ms));
  Data.Next_ms += TUMBLESIGHT_PLAY_PERIOD_MS;
}

void TUMBLESIGHT_Player(void) {
  uint32 RunStatus = Initialize() ? CFE_ES_RunStatus_APP_RUN : CFE_ES_RunStatus_APP_ERROR;
  while (CFE_ES_RunLoop(&RunStatus)) {
    WaitForPeriod();
    if (NextFrame()) SendFrame(CFE_TIME_GetMET());
    Send(CFE_MSG_PTR(Data.WakeUp.CommandHeader));
  }
  CFE_ES_ExitApp(RunStatus);
}
