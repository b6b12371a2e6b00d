/* What a cycle sends: packets on the software bus, and events. */
#ifndef TUMBLESIGHT_APP_OUTPUT_H
#define TUMBLESIGHT_APP_OUTPUT_H

#include "fsw/c/tumblesight_c.h"

/* Sends the packets of docs/icd.md unchanged: attitude, telemetry, events, dump. */
void TUMBLESIGHT_APP_SendPackets(struct tumblesight_app* App);

/* Sends the events of a cycle to the event services, under their ids of docs/icd.md. */
void TUMBLESIGHT_APP_SendEvents(const struct tumblesight_outputs* Outputs);

/* Sends the app's own housekeeping. */
void TUMBLESIGHT_APP_SendHk(void);

#endif /* TUMBLESIGHT_APP_OUTPUT_H */
