/* The calls of NASA's cFE, OSAL and PSP that the Tumblesight app uses, for its tests: names, arguments and
 * status values as cFE 7 declares them. cfe_stub.hpp steers what they return. */
#ifndef CFE_H
#define CFE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef uint8_t uint8;
typedef uint16_t uint16;
typedef uint32_t uint32;
typedef uint64_t uint64;
typedef int32_t int32;
typedef int64_t int64;

#define CompileTimeAssert(Condition, Name) typedef char Name[(Condition) ? 1 : -1]

/* --- OSAL and PSP --- */

typedef uint32 osal_id_t;
#define OS_OBJECT_ID_UNDEFINED ((osal_id_t){0})
typedef struct {
  int64 ticks; /* of 100 ns */
} OS_time_t;
#define OS_SUCCESS 0
#define OS_ERROR (-1)
#define OS_FILE_FLAG_NONE 0
#define OS_READ_ONLY 0
static inline int64 OS_TimeGetTotalNanoseconds(OS_time_t Time) {
  return Time.ticks * 100;
}
int32 OS_OpenCreate(osal_id_t* File, const char* Path, int32 Flags, int32 Access);
int32 OS_read(osal_id_t File, void* Bytes, size_t Count);
int32 OS_close(osal_id_t File);
int32 OS_TaskDelay(uint32 Milliseconds);

#define CFE_PSP_RST_TYPE_PROCESSOR 1
#define CFE_PSP_RST_TYPE_POWERON 2
#define CFE_PSP_RST_SUBTYPE_POWER_CYCLE 1
#define CFE_PSP_RST_SUBTYPE_HW_SPECIAL_COMMAND 3
#define CFE_PSP_RST_SUBTYPE_HW_WATCHDOG 4
#define CFE_PSP_RST_SUBTYPE_RESET_COMMAND 5
#define CFE_PSP_RST_SUBTYPE_EXCEPTION 6
void CFE_PSP_GetTime(OS_time_t* Time);

/* --- status values --- */

typedef int32 CFE_Status_t;
#define CFE_SUCCESS ((CFE_Status_t)0)
#define CFE_STATUS_EXTERNAL_RESOURCE_FAIL ((CFE_Status_t)0xc8000005)
#define CFE_STATUS_VALIDATION_FAILURE ((CFE_Status_t)0xc8000007)
#define CFE_ES_CDS_ALREADY_EXISTS ((CFE_Status_t)0x4400000d)
#define CFE_ES_CDS_INSUFFICIENT_MEMORY ((CFE_Status_t)0xc400000e)
#define CFE_ES_CDS_ACCESS_ERROR ((CFE_Status_t)0xc4000013)
#define CFE_ES_CDS_BLOCK_CRC_ERR ((CFE_Status_t)0xc400001a)
#define CFE_ES_OPERATION_TIMED_OUT ((CFE_Status_t)0xc4000027)
#define CFE_EVS_UNKNOWN_FILTER ((CFE_Status_t)0xc2000001)
#define CFE_SB_PIPE_CR_ERR ((CFE_Status_t)0xca000005)
#define CFE_SB_PIPE_RD_ERR ((CFE_Status_t)0xca000006)
#define CFE_SB_BUF_ALOC_ERR ((CFE_Status_t)0xca000008)
#define CFE_SB_MAX_MSGS_MET ((CFE_Status_t)0xca000009)
#define CFE_SB_BUFFER_INVALID ((CFE_Status_t)0xca00000e)
#define CFE_TBL_ERR_INVALID_SIZE ((CFE_Status_t)0xcc000016)
#define CFE_TBL_ERR_NEVER_LOADED ((CFE_Status_t)0xcc000005)
#define CFE_TBL_ERR_ACCESS ((CFE_Status_t)0xcc00002c)
#define CFE_TBL_INFO_UPDATED ((CFE_Status_t)0x4c00000e)
#define CFE_TBL_WARN_SHORT_FILE ((CFE_Status_t)0x4c000015)

/* --- time --- */

typedef struct {
  uint32 Seconds;
  uint32 Subseconds; /* 2^-32 s */
} CFE_TIME_SysTime_t;
CFE_TIME_SysTime_t CFE_TIME_GetMET(void);
uint32 CFE_TIME_Sub2MicroSecs(uint32 Subseconds);

/* --- messages and the software bus --- */

typedef uint32 CFE_SB_MsgId_Atom_t;
typedef struct {
  CFE_SB_MsgId_Atom_t Value;
} CFE_SB_MsgId_t;
typedef uint32 CFE_SB_PipeId_t;
typedef struct {
  uint8 Priority;
  uint8 Reliability;
} CFE_SB_Qos_t;
#define CFE_SB_DEFAULT_QOS ((CFE_SB_Qos_t){0, 0})
#define CFE_SB_PEND_FOREVER (-1)
typedef size_t CFE_MSG_Size_t;
typedef struct {
  uint8 Byte[6];
} CFE_MSG_Message_t;
typedef struct {
  CFE_MSG_Message_t Msg;
  uint8 Sec[2];
} CFE_MSG_CommandHeader_t;
typedef struct {
  CFE_MSG_Message_t Msg;
  uint8 Sec[6];
  uint8 Spare[4];
} CFE_MSG_TelemetryHeader_t;
typedef union {
  CFE_MSG_Message_t Msg;
  long long LongInt;
  long double LongDouble;
} CFE_SB_Buffer_t;
#define CFE_MSG_PTR(Header) (&((Header).Msg))

static inline CFE_SB_MsgId_t CFE_SB_ValueToMsgId(CFE_SB_MsgId_Atom_t Value) {
  CFE_SB_MsgId_t Id;
  Id.Value = Value;
  return Id;
}
static inline CFE_SB_MsgId_Atom_t CFE_SB_MsgIdToValue(CFE_SB_MsgId_t Id) {
  return Id.Value;
}
CFE_Status_t CFE_MSG_Init(CFE_MSG_Message_t* Message, CFE_SB_MsgId_t Id, CFE_MSG_Size_t Size);
CFE_Status_t CFE_MSG_GetMsgId(const CFE_MSG_Message_t* Message, CFE_SB_MsgId_t* Id);
CFE_Status_t CFE_MSG_GetSize(const CFE_MSG_Message_t* Message, CFE_MSG_Size_t* Size);
CFE_Status_t CFE_SB_CreatePipe(CFE_SB_PipeId_t* Pipe, uint16 Depth, const char* Name);
CFE_Status_t CFE_SB_SubscribeEx(CFE_SB_MsgId_t Id, CFE_SB_PipeId_t Pipe, CFE_SB_Qos_t Quality, uint16 Limit);
CFE_Status_t CFE_SB_ReceiveBuffer(CFE_SB_Buffer_t** Buffer, CFE_SB_PipeId_t Pipe, int32 Timeout);
CFE_SB_Buffer_t* CFE_SB_AllocateMessageBuffer(size_t Size);
CFE_Status_t CFE_SB_ReleaseMessageBuffer(CFE_SB_Buffer_t* Buffer);
CFE_Status_t CFE_SB_TransmitBuffer(CFE_SB_Buffer_t* Buffer, bool IsOrigination);
CFE_Status_t CFE_SB_TransmitMsg(const CFE_MSG_Message_t* Message, bool IsOrigination);
void CFE_SB_TimeStampMsg(CFE_MSG_Message_t* Message);

/* --- executive services --- */

typedef uint32 CFE_ES_CDSHandle_t;
#define CFE_ES_RunStatus_APP_RUN 1
#define CFE_ES_RunStatus_APP_EXIT 2
#define CFE_ES_RunStatus_APP_ERROR 3
void CFE_ES_PerfLogEntry(uint32 Marker);
void CFE_ES_PerfLogExit(uint32 Marker);
bool CFE_ES_RunLoop(uint32* RunStatus);
void CFE_ES_ExitApp(uint32 ExitStatus);
int32 CFE_ES_GetResetType(uint32* Subtype);
#define CFE_ES_SystemState_APPS_INIT 4
CFE_Status_t CFE_ES_WaitForSystemState(uint32 State, uint32 Timeout_ms);
CFE_Status_t CFE_ES_WriteToSysLog(const char* Format, ...) __attribute__((format(printf, 1, 2)));
CFE_Status_t CFE_ES_RegisterCDS(CFE_ES_CDSHandle_t* Handle, size_t Size, const char* Name);
CFE_Status_t CFE_ES_CopyToCDS(CFE_ES_CDSHandle_t Handle, const void* From);
CFE_Status_t CFE_ES_RestoreFromCDS(void* To, CFE_ES_CDSHandle_t Handle);

/* --- event services --- */

typedef struct {
  uint16 EventID;
  uint16 Mask;
} CFE_EVS_BinFilter_t;
#define CFE_EVS_EventFilter_BINARY 0
#define CFE_EVS_FIRST_16_STOP 0xFFF0
#define CFE_EVS_EventType_INFORMATION 2
#define CFE_EVS_EventType_ERROR 3
#define CFE_EVS_EventType_CRITICAL 4
CFE_Status_t CFE_EVS_Register(const void* Filters, uint16 Count, uint16 Scheme);
CFE_Status_t CFE_EVS_SendEvent(uint16 Id, uint16 Type, const char* Format, ...)
    __attribute__((format(printf, 3, 4)));

/* --- table services --- */

typedef int16_t CFE_TBL_Handle_t;
typedef CFE_Status_t (*CFE_TBL_CallbackFuncPtr_t)(void* Table);
typedef enum { CFE_TBL_SRC_FILE = 0, CFE_TBL_SRC_ADDRESS = 1 } CFE_TBL_SrcEnum_t;
#define CFE_TBL_OPT_DEFAULT 0
CFE_Status_t CFE_TBL_Register(CFE_TBL_Handle_t* Handle, const char* Name, size_t Size, uint16 Options,
                              CFE_TBL_CallbackFuncPtr_t Validate);
CFE_Status_t CFE_TBL_Load(CFE_TBL_Handle_t Handle, CFE_TBL_SrcEnum_t Source, const void* From);
CFE_Status_t CFE_TBL_Manage(CFE_TBL_Handle_t Handle);
CFE_Status_t CFE_TBL_GetAddress(void** Address, CFE_TBL_Handle_t Handle);
CFE_Status_t CFE_TBL_ReleaseAddress(CFE_TBL_Handle_t Handle);

#ifdef __cplusplus
}
#endif

#endif /* CFE_H */
