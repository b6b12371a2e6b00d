/* The performance markers of the Tumblesight app. */
#ifndef TUMBLESIGHT_APP_PERFIDS_H
#define TUMBLESIGHT_APP_PERFIDS_H

#define TUMBLESIGHT_APP_PERF_ID 61      /* the app is not waiting for a message */
#define TUMBLESIGHT_APP_STEP_PERF_ID 62 /* a cycle of the flight application */

#endif /* TUMBLESIGHT_APP_PERFIDS_H */
