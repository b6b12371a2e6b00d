/* The default parameter table: the values of a first start. docs/icd.md says what they mean and what is
 * allowed. Copy this file to the mission's definitions to change them. */
#include "cfe_tbl_filedef.h"
#include "fsw/c/tumblesight_c.h"

struct tumblesight_parameters TUMBLESIGHT_Parameters = {
    .predicted_error_urad = 523599,
    .attitude_jump_urad = 1047198,
    .cycle_budget_us = 1350000,
    .scrub_blocks = 12,
    .future_tolerance_us = 1000,
    .max_frame_age_ms = 2970,
    .longest_coast_ms = 21600,
    .chaser_time_tolerance_us = 10000,
    .events_of_a_kind = 8,
    .event_window_cycles = 16,
    .longest_without_chaser_ms = 8100,
    .fault_rules =
        {
            /* cycles, window_cycles, good_cycles, response */
            {1, 1, 1, TUMBLESIGHT_RESPONSE_RESET_SEQUENCE}, /* 0 state lost: cannot be changed */
            {1, 1, 1, TUMBLESIGHT_RESPONSE_SWITCH_BANK},    /* 1 model corrupted: cannot be changed */
            {1, 1, 1, TUMBLESIGHT_RESPONSE_RESET_SEQUENCE}, /* 2 attitude unsound */
            {10, 20, 10, TUMBLESIGHT_RESPONSE_FLAG},        /* 3 expected error large */
            {3, 6, 3, TUMBLESIGHT_RESPONSE_RESET_SEQUENCE}, /* 4 attitude jump */
            {4, 8, 4, TUMBLESIGHT_RESPONSE_FLAG},           /* 5 outage of frames */
            {3, 8, 3, TUMBLESIGHT_RESPONSE_FLAG},           /* 6 deadline overrun */
            {3, 8, 3, TUMBLESIGHT_RESPONSE_FLAG},           /* 7 cycle missed */
            {3, 8, 3, TUMBLESIGHT_RESPONSE_FLAG},           /* 8 frame frozen */
            {3, 16, 16, TUMBLESIGHT_RESPONSE_FLAG},         /* 9 track restarts */
        },
};

CFE_TBL_FILEDEF(TUMBLESIGHT_Parameters, TUMBLESIGHT.Parameters, Tumblesight parameters, tumblesight_tbl.tbl)
