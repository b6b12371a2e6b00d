/* The message ids of the Tumblesight app. A mission's own file of the name tumblesight_app_msgids.h takes the
 * place of this one. The APIDs in the packets follow from these ids. */
#ifndef TUMBLESIGHT_APP_MSGIDS_H
#define TUMBLESIGHT_APP_MSGIDS_H

/* To the app. */
#define TUMBLESIGHT_APP_CMD_MID 0x19F0     /* telecommands of docs/icd.md */
#define TUMBLESIGHT_APP_SEND_HK_MID 0x19F1 /* requests TUMBLESIGHT_APP_HK_TLM_MID; a header only */
#define TUMBLESIGHT_APP_WAKEUP_MID 0x19F2  /* runs one cycle, each 2.7 s; a header only */
#define TUMBLESIGHT_APP_FRAME_MID 0x09F8   /* TUMBLESIGHT_APP_FrameSegment_t, from the LiDAR's app */
#define TUMBLESIGHT_APP_NAV_MID 0x09F9     /* TUMBLESIGHT_APP_Navigation_t, from the chaser's navigation */

/* From the app: packets of docs/icd.md. */
#define TUMBLESIGHT_APP_ATTITUDE_MID 0x09F1
#define TUMBLESIGHT_APP_TLM_MID 0x09F2
#define TUMBLESIGHT_APP_EVENT_MID 0x09F3
#define TUMBLESIGHT_APP_DUMP_MID 0x09F4

/* From the app: TUMBLESIGHT_APP_HkTlm_t. */
#define TUMBLESIGHT_APP_HK_TLM_MID 0x09F5

#endif /* TUMBLESIGHT_APP_MSGIDS_H */
