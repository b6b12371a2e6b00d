/* The events of the app itself. Ids below 200 are those of the flight application (docs/icd.md). */
#ifndef TUMBLESIGHT_APP_EVENTIDS_H
#define TUMBLESIGHT_APP_EVENTIDS_H

#define TUMBLESIGHT_APP_INIT_INF_EID 200
#define TUMBLESIGHT_APP_PIPE_ERR_EID 201       /* no pipe or subscription: the app ends */
#define TUMBLESIGHT_APP_RECEIVE_ERR_EID 202    /* the pipe cannot be read: the app ends */
#define TUMBLESIGHT_APP_INIT_ERR_EID 203       /* the flight application refuses its settings: the app ends */
#define TUMBLESIGHT_APP_NO_MODEL_ERR_EID 204   /* no bank holds a good image: mode SAFE */
#define TUMBLESIGHT_APP_MODEL_FILE_ERR_EID 205 /* a model file cannot be read: its bank is empty */
#define TUMBLESIGHT_APP_TBL_ERR_EID 206        /* no table: the initial parameters are used */
#define TUMBLESIGHT_APP_TBL_VALUE_ERR_EID 207  /* a field of a table is not allowed: the table is refused */
#define TUMBLESIGHT_APP_TBL_INF_EID 208        /* new parameters are in use */
#define TUMBLESIGHT_APP_CDS_ERR_EID 209        /* no critical data store: a reset loses the state */
#define TUMBLESIGHT_APP_MID_ERR_EID 210        /* a message that is not the app's */
#define TUMBLESIGHT_APP_LENGTH_ERR_EID 211     /* a message of a wrong length */
#define TUMBLESIGHT_APP_SEGMENT_ERR_EID 212    /* a frame segment with impossible fields */
#define TUMBLESIGHT_APP_FRAME_ERR_EID 213      /* a frame that was not complete by the second cycle */
#define TUMBLESIGHT_APP_BUFFER_ERR_EID 214     /* a packet was not sent */

#endif /* TUMBLESIGHT_APP_EVENTIDS_H */
