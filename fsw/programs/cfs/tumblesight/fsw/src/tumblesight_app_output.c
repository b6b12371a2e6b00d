#include "tumblesight_app_output.h"

#include <string.h>

#include "tumblesight_app.h"
#include "tumblesight_app_eventids.h"

static void CountLost(const char* Why, CFE_Status_t Status) {
  ++TUMBLESIGHT_APP_COUNTERS.PacketsLost;
  CFE_EVS_SendEvent(TUMBLESIGHT_APP_BUFFER_ERR_EID, CFE_EVS_EventType_ERROR,
                    "TUMBLESIGHT: packet not sent: %s, RC = 0x%08lX", Why, TUMBLESIGHT_APP_RC(Status));
}

/* Headers and sequence counts are those of the packet: the bus must not write its own. */
static void SendPacket(const uint8* Bytes, size_t Size) {
  CFE_SB_Buffer_t* const Buffer = CFE_SB_AllocateMessageBuffer(Size);
  if (Buffer == NULL) {
    CountLost("the software bus has no buffer", CFE_SB_BUF_ALOC_ERR);
    return;
  }
  memcpy(Buffer, Bytes, Size);
  const CFE_Status_t Status = CFE_SB_TransmitBuffer(Buffer, false);
  if (Status == CFE_SUCCESS) {
    ++TUMBLESIGHT_APP_COUNTERS.PacketsSent;
    return;
  }
  (void)CFE_SB_ReleaseMessageBuffer(Buffer);
  CountLost("the software bus refused it", Status);
}

void TUMBLESIGHT_APP_SendPackets(struct tumblesight_app* App) {
  uint8 Bytes[TUMBLESIGHT_MAX_PACKET_BYTES];
  size_t Size = tumblesight_take_packet(App, Bytes, sizeof Bytes);
  while (Size > 0) {
    SendPacket(Bytes, Size);
    Size = tumblesight_take_packet(App, Bytes, sizeof Bytes);
  }
}

/* Severities of docs/icd.md: information, warning, error. */
static uint16 TypeOf(uint8_t Severity) {
  if (Severity == 0) return CFE_EVS_EventType_INFORMATION;
  return Severity == 1 ? CFE_EVS_EventType_ERROR : CFE_EVS_EventType_CRITICAL;
}

void TUMBLESIGHT_APP_SendEvents(const struct tumblesight_outputs* Outputs) {
  for (size_t i = 0; i < Outputs->event_count; ++i) {
    const struct tumblesight_event* Event = &Outputs->events[i];
    CFE_EVS_SendEvent(Event->id, TypeOf(Event->severity), "TUMBLESIGHT: %s [%ld, %ld, %ld]",
                      tumblesight_event_text(Event->id), (long)Event->arguments[0], (long)Event->arguments[1],
                      (long)Event->arguments[2]);
  }
}

void TUMBLESIGHT_APP_SendHk(void) {
  CFE_MSG_Message_t* const Message = CFE_MSG_PTR(TUMBLESIGHT_APP_Data.HkTlm.TelemetryHeader);
  CFE_SB_TimeStampMsg(Message);
  const CFE_Status_t Status = CFE_SB_TransmitMsg(Message, true);
  if (Status != CFE_SUCCESS) CountLost("the software bus refused the housekeeping", Status);
}
