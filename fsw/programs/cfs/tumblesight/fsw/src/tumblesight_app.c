/* The Tumblesight app: takes messages from its pipe, and runs a cycle of the flight application at each
 * wake-up. */
#include "tumblesight_app.h"

#include <string.h>

#include "tumblesight_app_eventids.h"
#include "tumblesight_app_msgids.h"
#include "tumblesight_app_output.h"
#include "tumblesight_app_perfids.h"
#include "tumblesight_app_platform.h"
#include "tumblesight_app_table.h"

/* The packets of docs/icd.md have the primary header of CCSDS version 1 only. */
CompileTimeAssert(sizeof(CFE_MSG_Message_t) == 6, TUMBLESIGHT_APP_NEEDS_CFE_WITHOUT_EXTENDED_HEADERS);
/* The ids of packets are their first two bytes: without the APID, those of a command or of telemetry with a
 * secondary header. */
#define TUMBLESIGHT_APP_IS_COMMAND(Mid) (((Mid) & ~0x7FF) == 0x1800)
#define TUMBLESIGHT_APP_IS_TELEMETRY(Mid) (((Mid) & ~0x7FF) == 0x0800)
CompileTimeAssert(TUMBLESIGHT_APP_IS_COMMAND(TUMBLESIGHT_APP_CMD_MID),
                  TUMBLESIGHT_APP_CMD_MID_IS_THAT_OF_A_COMMAND);
CompileTimeAssert(TUMBLESIGHT_APP_IS_TELEMETRY(TUMBLESIGHT_APP_ATTITUDE_MID) &&
                      TUMBLESIGHT_APP_IS_TELEMETRY(TUMBLESIGHT_APP_TLM_MID) &&
                      TUMBLESIGHT_APP_IS_TELEMETRY(TUMBLESIGHT_APP_EVENT_MID) &&
                      TUMBLESIGHT_APP_IS_TELEMETRY(TUMBLESIGHT_APP_DUMP_MID),
                  TUMBLESIGHT_APP_PACKET_MIDS_ARE_THOSE_OF_TELEMETRY);
CompileTimeAssert(TUMBLESIGHT_APP_HK_TLM_MID != TUMBLESIGHT_APP_ATTITUDE_MID &&
                      TUMBLESIGHT_APP_HK_TLM_MID != TUMBLESIGHT_APP_TLM_MID &&
                      TUMBLESIGHT_APP_HK_TLM_MID != TUMBLESIGHT_APP_EVENT_MID &&
                      TUMBLESIGHT_APP_HK_TLM_MID != TUMBLESIGHT_APP_DUMP_MID,
                  TUMBLESIGHT_APP_HK_TLM_MID_IS_THAT_OF_NO_PACKET);
CompileTimeAssert(TUMBLESIGHT_APP_WAKEUP_LIMIT + TUMBLESIGHT_APP_SEND_HK_LIMIT + TUMBLESIGHT_APP_CMD_LIMIT +
                          TUMBLESIGHT_APP_FRAME_LIMIT + TUMBLESIGHT_APP_NAV_LIMIT <=
                      TUMBLESIGHT_APP_PIPE_DEPTH,
                  TUMBLESIGHT_APP_PIPE_DEPTH_IS_THE_SUM_OF_THE_LIMITS);
CompileTimeAssert(TUMBLESIGHT_APP_FRAME_BUFFERS >= 2 &&
                      TUMBLESIGHT_APP_FRAME_BUFFERS <= TUMBLESIGHT_MAX_FRAMES,
                  TUMBLESIGHT_APP_FRAME_BUFFERS_ARE_2_TO_32);

TUMBLESIGHT_APP_Data_t TUMBLESIGHT_APP_Data;

/* --- start-up --- */

static CFE_Status_t Subscribe(CFE_SB_MsgId_Atom_t Mid, uint16 Limit) {
  const CFE_Status_t Status =
      CFE_SB_SubscribeEx(CFE_SB_ValueToMsgId(Mid), TUMBLESIGHT_APP_Data.Pipe, CFE_SB_DEFAULT_QOS, Limit);
  if (Status != CFE_SUCCESS)
    CFE_EVS_SendEvent(TUMBLESIGHT_APP_PIPE_ERR_EID, CFE_EVS_EventType_ERROR,
                      "TUMBLESIGHT: no subscription to 0x%04lX, RC = 0x%08lX", (unsigned long)Mid,
                      TUMBLESIGHT_APP_RC(Status));
  return Status;
}

static CFE_Status_t SetUpPipe(void) {
  CFE_Status_t Status =
      CFE_SB_CreatePipe(&TUMBLESIGHT_APP_Data.Pipe, TUMBLESIGHT_APP_PIPE_DEPTH, "TUMBLESIGHT_PIPE");
  if (Status != CFE_SUCCESS) {
    CFE_EVS_SendEvent(TUMBLESIGHT_APP_PIPE_ERR_EID, CFE_EVS_EventType_ERROR,
                      "TUMBLESIGHT: no pipe of depth %d, RC = 0x%08lX", TUMBLESIGHT_APP_PIPE_DEPTH,
                      TUMBLESIGHT_APP_RC(Status));
    return Status;
  }
  Status = Subscribe(TUMBLESIGHT_APP_CMD_MID, TUMBLESIGHT_APP_CMD_LIMIT);
  if (Status == CFE_SUCCESS) Status = Subscribe(TUMBLESIGHT_APP_SEND_HK_MID, TUMBLESIGHT_APP_SEND_HK_LIMIT);
  if (Status == CFE_SUCCESS) Status = Subscribe(TUMBLESIGHT_APP_FRAME_MID, TUMBLESIGHT_APP_FRAME_LIMIT);
  if (Status == CFE_SUCCESS) Status = Subscribe(TUMBLESIGHT_APP_NAV_MID, TUMBLESIGHT_APP_NAV_LIMIT);
  if (Status == CFE_SUCCESS) Status = Subscribe(TUMBLESIGHT_APP_WAKEUP_MID, TUMBLESIGHT_APP_WAKEUP_LIMIT);
  return Status;
}

static const char* CauseText(enum tumblesight_reset_cause Cause) {
  static const char* const Texts[] = {"power-on", "command", "watchdog", "other, so RUN becomes STANDBY"};
  return Texts[Cause];
}

static CFE_Status_t SetUpFlightApplication(void) {
  struct tumblesight_settings Settings;
  memset(&Settings, 0, sizeof Settings);
  TUMBLESIGHT_APP_SetUpPlatform(&Settings);
  const enum tumblesight_status Status = tumblesight_init(
      TUMBLESIGHT_APP_Data.Memory, sizeof TUMBLESIGHT_APP_Data.Memory, &Settings, &TUMBLESIGHT_APP_Data.App);
  if (TUMBLESIGHT_APP_Data.App == NULL) {
    CFE_EVS_SendEvent(TUMBLESIGHT_APP_INIT_ERR_EID, CFE_EVS_EventType_ERROR, "TUMBLESIGHT: not started: %s",
                      tumblesight_status_text(Status));
    return CFE_STATUS_EXTERNAL_RESOURCE_FAIL;
  }
  CFE_EVS_SendEvent(TUMBLESIGHT_APP_INIT_INF_EID, CFE_EVS_EventType_INFORMATION,
                    "TUMBLESIGHT: started, version %s, cause of the reset: %s", tumblesight_version(),
                    CauseText(Settings.reset_cause));
  if (Status != TUMBLESIGHT_OK)
    CFE_EVS_SendEvent(TUMBLESIGHT_APP_NO_MODEL_ERR_EID, CFE_EVS_EventType_CRITICAL, "TUMBLESIGHT: %s",
                      tumblesight_status_text(Status));
  return CFE_SUCCESS;
}

/* The event services suppress further events of messages that others send. */
static CFE_Status_t RegisterEvents(void) {
  static const CFE_EVS_BinFilter_t Filters[] = {
      {TUMBLESIGHT_APP_MID_ERR_EID, CFE_EVS_FIRST_16_STOP},
      {TUMBLESIGHT_APP_LENGTH_ERR_EID, CFE_EVS_FIRST_16_STOP},
      {TUMBLESIGHT_APP_SEGMENT_ERR_EID, CFE_EVS_FIRST_16_STOP},
      {TUMBLESIGHT_APP_FRAME_ERR_EID, CFE_EVS_FIRST_16_STOP},
      {TUMBLESIGHT_APP_BUFFER_ERR_EID, CFE_EVS_FIRST_16_STOP},
  };
  const CFE_Status_t Status =
      CFE_EVS_Register(Filters, sizeof Filters / sizeof Filters[0], CFE_EVS_EventFilter_BINARY);
  if (Status != CFE_SUCCESS)
    CFE_ES_WriteToSysLog("TUMBLESIGHT: no event services, RC = 0x%08lX\n", TUMBLESIGHT_APP_RC(Status));
  return Status;
}

static CFE_Status_t Initialize(void) {
  memset(&TUMBLESIGHT_APP_Data, 0, sizeof TUMBLESIGHT_APP_Data);
  TUMBLESIGHT_APP_Data.RunStatus = CFE_ES_RunStatus_APP_RUN;
  /* Clears the counters, so it comes before anything that counts. */
  CFE_MSG_Init(CFE_MSG_PTR(TUMBLESIGHT_APP_Data.HkTlm.TelemetryHeader),
               CFE_SB_ValueToMsgId(TUMBLESIGHT_APP_HK_TLM_MID), sizeof TUMBLESIGHT_APP_Data.HkTlm);
  CFE_Status_t Status = RegisterEvents();
  if (Status == CFE_SUCCESS) Status = SetUpPipe();
  if (Status == CFE_SUCCESS) Status = SetUpFlightApplication();
  if (Status != CFE_SUCCESS) return Status;
  TUMBLESIGHT_APP_RegisterTable();
  return CFE_SUCCESS;
}

/* --- messages --- */

static void RefuseLength(CFE_SB_MsgId_t Mid, size_t Size) {
  ++TUMBLESIGHT_APP_COUNTERS.MessagesRefused;
  CFE_EVS_SendEvent(TUMBLESIGHT_APP_LENGTH_ERR_EID, CFE_EVS_EventType_ERROR,
                    "TUMBLESIGHT: message 0x%04lX of a wrong length, %lu bytes",
                    (unsigned long)CFE_SB_MsgIdToValue(Mid), (unsigned long)Size);
}

static bool HasNoArguments(CFE_SB_MsgId_t Mid, size_t Size) {
  if (Size == sizeof(TUMBLESIGHT_APP_NoArgs_t)) return true;
  RefuseLength(Mid, Size);
  return false;
}

/* The flight application queues the packet, and checks it in the next cycle. */
static void TakeCommand(const void* Bytes, size_t Size) {
  if (tumblesight_put_command(TUMBLESIGHT_APP_Data.App, Bytes, Size) == TUMBLESIGHT_OK)
    ++TUMBLESIGHT_APP_COUNTERS.CommandsTaken;
  else
    ++TUMBLESIGHT_APP_COUNTERS.CommandsDropped;
}

/* A segment may end behind its last range. */
static void TakeFrameMessage(const TUMBLESIGHT_APP_FrameSegment_t* Message, CFE_SB_MsgId_t Mid, size_t Size) {
  const size_t Head = offsetof(TUMBLESIGHT_APP_FrameSegment_t, Payload.Ranges);
  if (Size < Head || Size > sizeof *Message ||
      Size < Head + Message->Payload.Count * sizeof Message->Payload.Ranges[0])
    RefuseLength(Mid, Size);
  else
    TUMBLESIGHT_APP_TakeSegment(&Message->Payload);
}

static void TakeNavigation(const TUMBLESIGHT_APP_Navigation_t* Message, CFE_SB_MsgId_t Mid, size_t Size) {
  if (Size != sizeof *Message)
    RefuseLength(Mid, Size);
  else
    TUMBLESIGHT_APP_Data.Chaser = TUMBLESIGHT_APP_ToChaser(&Message->Attitude);
}

/* --- a cycle --- */

/* Periods that passed without a cycle. */
static uint32 SlipsUntil(int64 Now_ns) {
  const int64 Last_ns = TUMBLESIGHT_APP_Data.LastCycle_ns;
  if (Last_ns == 0 || Now_ns <= Last_ns) return 0;
  const int64 Periods = (Now_ns - Last_ns + TUMBLESIGHT_PERIOD_NS / 2) / TUMBLESIGHT_PERIOD_NS;
  return Periods > 1 ? (uint32)(Periods - 1) : 0;
}

static void CollectInputs(struct tumblesight_inputs* Inputs) {
  memset(Inputs, 0, sizeof *Inputs);
  Inputs->now_ns = TUMBLESIGHT_APP_ToNanoseconds(CFE_TIME_GetMET());
  Inputs->slips = SlipsUntil(Inputs->now_ns);
  Inputs->frame_count = TUMBLESIGHT_APP_ListFrames();
  Inputs->frames = TUMBLESIGHT_APP_Data.Frames.List;
  Inputs->frames_dropped = TUMBLESIGHT_APP_Data.Frames.Dropped;
  Inputs->chaser = TUMBLESIGHT_APP_Data.Chaser;
}

static void EndInputs(int64 Now_ns) {
  TUMBLESIGHT_APP_Data.LastCycle_ns = Now_ns;
  TUMBLESIGHT_APP_Data.Frames.Dropped = 0;
  TUMBLESIGHT_APP_EndFrames();
}

/* RESET_COUNTERS resets the counters of the flight application. Those of the app follow: a cycle that
 * ends as number 0 had this command. */
static void ResetCountersOnCommand(const struct tumblesight_outputs* Outputs) {
  if (Outputs->telemetry.cycles == 0) memset(&TUMBLESIGHT_APP_COUNTERS, 0, sizeof TUMBLESIGHT_APP_COUNTERS);
}

static void RunCycle(void) {
  struct tumblesight_inputs Inputs;
  const struct tumblesight_outputs* Outputs = NULL;
  TUMBLESIGHT_APP_ManageTable();
  CollectInputs(&Inputs);
  CFE_ES_PerfLogEntry(TUMBLESIGHT_APP_STEP_PERF_ID);
  (void)tumblesight_step(TUMBLESIGHT_APP_Data.App, &Inputs, &Outputs); /* fails for null pointers only */
  CFE_ES_PerfLogExit(TUMBLESIGHT_APP_STEP_PERF_ID);
  EndInputs(Inputs.now_ns);
  ++TUMBLESIGHT_APP_COUNTERS.Cycles;
  TUMBLESIGHT_APP_SendPackets(TUMBLESIGHT_APP_Data.App);
  TUMBLESIGHT_APP_SendEvents(Outputs);
  ResetCountersOnCommand(Outputs);
}

static void TakeMessage(const CFE_SB_Buffer_t* Buffer) {
  CFE_SB_MsgId_t Mid;
  CFE_MSG_Size_t Size = 0;
  CFE_MSG_GetMsgId(&Buffer->Msg, &Mid);
  CFE_MSG_GetSize(&Buffer->Msg, &Size);
  switch (CFE_SB_MsgIdToValue(Mid)) {
    case TUMBLESIGHT_APP_CMD_MID:
      TakeCommand(Buffer, Size);
      break;
    case TUMBLESIGHT_APP_FRAME_MID:
      TakeFrameMessage((const void*)Buffer, Mid, Size);
      break;
    case TUMBLESIGHT_APP_NAV_MID:
      TakeNavigation((const void*)Buffer, Mid, Size);
      break;
    case TUMBLESIGHT_APP_WAKEUP_MID:
      if (HasNoArguments(Mid, Size)) RunCycle();
      break;
    case TUMBLESIGHT_APP_SEND_HK_MID:
      if (HasNoArguments(Mid, Size)) TUMBLESIGHT_APP_SendHk();
      break;
    default:
      ++TUMBLESIGHT_APP_COUNTERS.MessagesRefused;
      CFE_EVS_SendEvent(TUMBLESIGHT_APP_MID_ERR_EID, CFE_EVS_EventType_ERROR,
                        "TUMBLESIGHT: message 0x%04lX is not for this app",
                        (unsigned long)CFE_SB_MsgIdToValue(Mid));
      break;
  }
}

void TUMBLESIGHT_Main(void) {
  CFE_SB_Buffer_t* Buffer = NULL;
  CFE_ES_PerfLogEntry(TUMBLESIGHT_APP_PERF_ID);
  if (Initialize() != CFE_SUCCESS) TUMBLESIGHT_APP_Data.RunStatus = CFE_ES_RunStatus_APP_ERROR;
  while (CFE_ES_RunLoop(&TUMBLESIGHT_APP_Data.RunStatus)) {
    CFE_ES_PerfLogExit(TUMBLESIGHT_APP_PERF_ID);
    const CFE_Status_t Status = CFE_SB_ReceiveBuffer(&Buffer, TUMBLESIGHT_APP_Data.Pipe, CFE_SB_PEND_FOREVER);
    CFE_ES_PerfLogEntry(TUMBLESIGHT_APP_PERF_ID);
    if (Status == CFE_SUCCESS) {
      TakeMessage(Buffer);
      continue;
    }
    CFE_EVS_SendEvent(TUMBLESIGHT_APP_RECEIVE_ERR_EID, CFE_EVS_EventType_ERROR,
                      "TUMBLESIGHT: the pipe cannot be read, RC = 0x%08lX", TUMBLESIGHT_APP_RC(Status));
    TUMBLESIGHT_APP_Data.RunStatus = CFE_ES_RunStatus_APP_ERROR;
  }
  CFE_ES_PerfLogExit(TUMBLESIGHT_APP_PERF_ID);
  CFE_ES_ExitApp(TUMBLESIGHT_APP_Data.RunStatus);
}
