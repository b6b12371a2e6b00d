#include "tumblesight_app_platform.h"

#include <string.h>

#include "tumblesight_app.h"
#include "tumblesight_app_eventids.h"
#include "tumblesight_app_msgids.h"

#define TUMBLESIGHT_APP_STORED_COPIES 2
#define TUMBLESIGHT_APP_IMAGE_ALIGNMENT 64
#define TUMBLESIGHT_APP_APID_MASK 0x7FF

/* The memory of the banks. */
typedef struct {
  uint8 Bytes[TUMBLESIGHT_APP_BANKS][TUMBLESIGHT_APP_MODEL_BYTES]
      __attribute__((aligned(TUMBLESIGHT_APP_IMAGE_ALIGNMENT)));
} TUMBLESIGHT_APP_Models_t;

CompileTimeAssert(TUMBLESIGHT_APP_BANKS >= 1 && TUMBLESIGHT_APP_BANKS <= TUMBLESIGHT_BANKS,
                  TUMBLESIGHT_APP_BANKS_IS_1_OR_2);
CompileTimeAssert(TUMBLESIGHT_APP_MODEL_BYTES % TUMBLESIGHT_APP_IMAGE_ALIGNMENT == 0,
                  TUMBLESIGHT_APP_MODEL_BYTES_IS_A_MULTIPLE_OF_64);

static TUMBLESIGHT_APP_Models_t TUMBLESIGHT_APP_Models;
static CFE_ES_CDSHandle_t TUMBLESIGHT_APP_Stored[TUMBLESIGHT_APP_STORED_COPIES];

int64 TUMBLESIGHT_APP_ToNanoseconds(CFE_TIME_SysTime_t Time) {
  const uint64 Second_ns = 1000000000U;
  const uint64 Rest_ns = (Time.Subseconds * Second_ns + (1U << 31)) >> 32;
  return (int64)(Time.Seconds * Second_ns + Rest_ns);
}

struct tumblesight_chaser TUMBLESIGHT_APP_ToChaser(const TUMBLESIGHT_APP_Attitude_t* Attitude) {
  struct tumblesight_chaser Chaser;
  Chaser.time_ns = TUMBLESIGHT_APP_ToNanoseconds(Attitude->Time);
  memcpy(Chaser.q_inertial_lrf, Attitude->Q_Inertial_Lrf, sizeof Chaser.q_inertial_lrf);
  Chaser.is_known = Attitude->IsKnown != 0;
  return Chaser;
}

static uint64_t Stopwatch_ns(void* Context) {
  OS_time_t Now;
  (void)Context;
  CFE_PSP_GetTime(&Now);
  return (uint64_t)OS_TimeGetTotalNanoseconds(Now);
}

/* --- the critical data store: two blocks, one a copy --- */

static bool IsBlank(const uint8_t* Bytes) {
  for (size_t i = 0; i < TUMBLESIGHT_STORED_BYTES; ++i)
    if (Bytes[i] != 0) return false;
  return true;
}

static enum tumblesight_store_status ReadStored(void* Context, int Copy, uint8_t* Bytes) {
  const CFE_Status_t Status = CFE_ES_RestoreFromCDS(Bytes, TUMBLESIGHT_APP_Stored[Copy]);
  (void)Context;
  if (Status == CFE_SUCCESS) return IsBlank(Bytes) ? TUMBLESIGHT_STORE_BLANK : TUMBLESIGHT_STORE_OK;
  ++TUMBLESIGHT_APP_COUNTERS.StoreErrors;
  return Status == CFE_ES_CDS_BLOCK_CRC_ERR ? TUMBLESIGHT_STORE_DAMAGED : TUMBLESIGHT_STORE_FAILED;
}

static enum tumblesight_store_status WriteStored(void* Context, int Copy, const uint8_t* Bytes) {
  (void)Context;
  if (CFE_ES_CopyToCDS(TUMBLESIGHT_APP_Stored[Copy], Bytes) == CFE_SUCCESS) return TUMBLESIGHT_STORE_OK;
  ++TUMBLESIGHT_APP_COUNTERS.StoreErrors;
  return TUMBLESIGHT_STORE_FAILED;
}

/* A new block has no content that could be read. Zeros mark it as blank, also after a reset. */
static CFE_Status_t RegisterCopy(int Copy, bool* Existed) {
  static const char* const Names[TUMBLESIGHT_APP_STORED_COPIES] = {"State0", "State1"};
  static const uint8 Blank[TUMBLESIGHT_STORED_BYTES];
  CFE_Status_t Status =
      CFE_ES_RegisterCDS(&TUMBLESIGHT_APP_Stored[Copy], TUMBLESIGHT_STORED_BYTES, Names[Copy]);
  if (Status == CFE_ES_CDS_ALREADY_EXISTS) {
    *Existed = true;
    Status = CFE_SUCCESS;
  } else if (Status == CFE_SUCCESS) {
    Status = CFE_ES_CopyToCDS(TUMBLESIGHT_APP_Stored[Copy], Blank);
  }
  return Status;
}

/* `*MayHaveRun`: the app has run before, since the store was cleared, or that is not known. */
static void SetUpStore(struct tumblesight_settings* Settings, bool* MayHaveRun) {
  CFE_Status_t Status = CFE_SUCCESS;
  for (int Copy = 0; Copy < TUMBLESIGHT_APP_STORED_COPIES && Status == CFE_SUCCESS; ++Copy)
    Status = RegisterCopy(Copy, MayHaveRun);
  if (Status == CFE_SUCCESS) {
    Settings->read_stored = ReadStored;
    Settings->write_stored = WriteStored;
    return;
  }
  *MayHaveRun = true;
  ++TUMBLESIGHT_APP_COUNTERS.StoreErrors;
  CFE_EVS_SendEvent(
      TUMBLESIGHT_APP_CDS_ERR_EID, CFE_EVS_EventType_ERROR,
      "TUMBLESIGHT: no critical data store, RC = 0x%08lX: a reset will lose mode, bank and parameters",
      TUMBLESIGHT_APP_RC(Status));
}

/* Whether cFE has started before this app, so that the app alone starts now. */
static bool IsStartedAlone(void) {
  return CFE_ES_WaitForSystemState(CFE_ES_SystemState_APPS_INIT, 0) == CFE_SUCCESS;
}

/* cFE gives the type and subtype with which the processor started, also to an app that is started again
 * later: by command or after an exception. */
static enum tumblesight_reset_cause ResetCause(bool MayHaveRun) {
  uint32 Subtype = 0;
  const int32 Type = CFE_ES_GetResetType(&Subtype);
  if (IsStartedAlone()) return MayHaveRun ? TUMBLESIGHT_RESET_OTHER : TUMBLESIGHT_RESET_POWER_ON;
  if (Type == CFE_PSP_RST_TYPE_POWERON) return TUMBLESIGHT_RESET_POWER_ON;
  if (Subtype == CFE_PSP_RST_SUBTYPE_HW_WATCHDOG) return TUMBLESIGHT_RESET_WATCHDOG;
  if (TUMBLESIGHT_APP_TRUSTS_RESET_COMMAND && Subtype == CFE_PSP_RST_SUBTYPE_RESET_COMMAND)
    return TUMBLESIGHT_RESET_COMMANDED;
  return TUMBLESIGHT_RESET_OTHER;
}

/* --- model files --- */

/* Returns the size of the file, or a negative status of OSAL. A file that is larger than a bank fills it. */
static int32 ReadFile(const char* Path, uint8* Bytes) {
  osal_id_t File = OS_OBJECT_ID_UNDEFINED;
  int32 Size = 0;
  int32 Status = OS_OpenCreate(&File, Path, OS_FILE_FLAG_NONE, OS_READ_ONLY);
  if (Status < 0) return Status;
  do {
    Status = OS_read(File, &Bytes[Size], (size_t)(TUMBLESIGHT_APP_MODEL_BYTES - Size));
    if (Status > 0) Size += Status;
  } while (Status > 0 && Size < TUMBLESIGHT_APP_MODEL_BYTES);
  (void)OS_close(File);
  return Status < 0 ? Status : Size;
}

static void LoadBank(const char* Path, uint8* Bytes, struct tumblesight_bank* Bank) {
  const int32 Size = Path[0] == '\0' ? 0 : ReadFile(Path, Bytes);
  Bank->image = Bytes;
  Bank->writable = Bytes;
  Bank->capacity_bytes = TUMBLESIGHT_APP_MODEL_BYTES;
  Bank->image_bytes = Size > 0 ? (size_t)Size : 0;
  if (Size < 0 || (Size == 0 && Path[0] != '\0'))
    CFE_EVS_SendEvent(TUMBLESIGHT_APP_MODEL_FILE_ERR_EID, CFE_EVS_EventType_ERROR,
                      "TUMBLESIGHT: model file %s %s, RC = %ld", Path,
                      Size < 0 ? "cannot be read" : "is empty", (long)Size);
}

void TUMBLESIGHT_APP_SetUpPlatform(struct tumblesight_settings* Settings) {
  static const char* const Paths[TUMBLESIGHT_BANKS] = {TUMBLESIGHT_APP_MODEL_FILE_0,
                                                       TUMBLESIGHT_APP_MODEL_FILE_1};
  static const char Target[] = TUMBLESIGHT_APP_EXPECTED_TARGET;
  bool MayHaveRun = false;
  for (int Bank = 0; Bank < TUMBLESIGHT_APP_BANKS; ++Bank)
    LoadBank(Paths[Bank], TUMBLESIGHT_APP_Models.Bytes[Bank], &Settings->bank[Bank]);
  SetUpStore(Settings, &MayHaveRun);
  Settings->expected_target = sizeof Target > 1 ? Target : NULL;
  Settings->reset_cause = ResetCause(MayHaveRun);
  Settings->apids.command = TUMBLESIGHT_APP_CMD_MID & TUMBLESIGHT_APP_APID_MASK;
  Settings->apids.attitude_report = TUMBLESIGHT_APP_ATTITUDE_MID & TUMBLESIGHT_APP_APID_MASK;
  Settings->apids.telemetry = TUMBLESIGHT_APP_TLM_MID & TUMBLESIGHT_APP_APID_MASK;
  Settings->apids.event = TUMBLESIGHT_APP_EVENT_MID & TUMBLESIGHT_APP_APID_MASK;
  Settings->apids.memory_dump = TUMBLESIGHT_APP_DUMP_MID & TUMBLESIGHT_APP_APID_MASK;
  Settings->stopwatch_ns = Stopwatch_ns;
}
