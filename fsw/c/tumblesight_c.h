/* The flight application for C, and for languages that call C (Ada, Rust): one object in memory of the
 * caller, tumblesight_init() at start-up and tumblesight_step() once per period.
 *
 *   static uint64_t memory[TUMBLESIGHT_MEMORY_BYTES / 8];
 *   struct tumblesight_app *app;
 *   tumblesight_init(memory, sizeof memory, &settings, &app);
 *   for (;;) {
 *     ... wait for the period, collect the frames and commands that have arrived ...
 *     tumblesight_step(app, &inputs, &outputs);
 *     ... send *outputs ...
 *   }
 *
 * docs/examples/smallest.c is a whole program. Link tumblesight::fsw_c, or the static libraries of the
 * package.
 *
 * Nothing is allocated, nothing blocks, and no function keeps a pointer into `inputs`. Call all functions of
 * one object from one thread, which needs 10 KiB of stack. Several objects are independent of each other.
 *
 * Frames: the target's (TRF), the LiDAR's (LRF: x right, y boresight, z up). Quaternions: Hamilton, scalar
 * first, Q30. Times: nanoseconds of the platform's clock, which must not go back. docs/icd.md explains every
 * field, event and command. */
#ifndef TUMBLESIGHT_C_H
#define TUMBLESIGHT_C_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Enough for the object on every processor, at any address. */
#if defined(__x86_64__)
#define TUMBLESIGHT_MEMORY_BYTES (424 * 1024)
#else
#define TUMBLESIGHT_MEMORY_BYTES (258 * 1024)
#endif

#define TUMBLESIGHT_PERIOD_NS 2700000000LL
#define TUMBLESIGHT_MAX_RAYS 128
#define TUMBLESIGHT_MAX_FRAMES 32     /* per step */
#define TUMBLESIGHT_MAX_COMMANDS 8    /* per step */
#define TUMBLESIGHT_COMMAND_PLACES 16 /* for commands that wait */
#define TUMBLESIGHT_MAX_COMMAND_BYTES 1060
#define TUMBLESIGHT_COMMAND_REFUSALS 17 /* reasons to refuse a command */
#define TUMBLESIGHT_MAX_EVENTS 16       /* per step */
#define TUMBLESIGHT_MAX_PACKET_BYTES 1055
#define TUMBLESIGHT_BANKS 2
#define TUMBLESIGHT_CYCLE_TIME_BINS 8
#define TUMBLESIGHT_DUMP_BYTES 1024
#define TUMBLESIGHT_STORED_BYTES 256
#define TUMBLESIGHT_KEY_SLOTS 4
#define TUMBLESIGHT_KEY_BYTES 32
#define TUMBLESIGHT_FAULTS 10
#define TUMBLESIGHT_MAX_APID 0x7FE

enum tumblesight_status {
  TUMBLESIGHT_OK = 0,
  /* init: no bank holds an image that passes every check. The object works: it is in mode SAFE, reports
   * telemetry, and a new image can be loaded. */
  TUMBLESIGHT_NO_MODEL = 1,
  TUMBLESIGHT_NULL_ARGUMENT = 2,     /* a pointer that is needed is null */
  TUMBLESIGHT_TOO_LITTLE_MEMORY = 3, /* less than tumblesight_memory_bytes(memory) */
  TUMBLESIGHT_MISALIGNED_IMAGE = 4,  /* the address of a bank is no multiple of 64 */
  TUMBLESIGHT_OTHER_ADDRESS = 5,     /* the writable address of a bank is not that of its image */
  TUMBLESIGHT_BAD_RESET_CAUSE = 6,   /* no value of enum tumblesight_reset_cause */
  TUMBLESIGHT_TOO_MANY = 7,          /* more frames or commands than one step takes; nothing was done */
  TUMBLESIGHT_BAD_APIDS = 8,         /* an APID is above TUMBLESIGHT_MAX_APID, or two are equal */
  TUMBLESIGHT_BAD_PARAMETER = 9,     /* a parameter has a value that is not allowed; nothing was done */
  TUMBLESIGHT_COMMAND_DROPPED = 10,  /* not authentic, or no place is free for it; telemetry counts it */
  /* init: the object, its settings, keys and target, the two banks and the pointer to it share memory.
   * step: the pointer to the outputs lies in the object. Nothing was done. */
  TUMBLESIGHT_OVERLAP = 11,
  TUMBLESIGHT_IMAGE_TOO_LARGE = 12,    /* the image of a bank is larger than the bank's capacity */
  TUMBLESIGHT_MISALIGNED_ARGUMENT = 13 /* a pointer is not aligned for its type; nothing was done */
};
/* One line for a log. Any value. */
const char* tumblesight_status_text(enum tumblesight_status status);

/* --- start-up --- */

enum tumblesight_reset_cause {
  TUMBLESIGHT_RESET_POWER_ON = 0,
  TUMBLESIGHT_RESET_COMMANDED = 1,
  TUMBLESIGHT_RESET_WATCHDOG = 2,
  TUMBLESIGHT_RESET_OTHER = 3
};

/* Results of the functions of a persistent store. */
enum tumblesight_store_status {
  TUMBLESIGHT_STORE_OK = 0,
  TUMBLESIGHT_STORE_BLANK = 1,  /* read: nothing has ever been written */
  TUMBLESIGHT_STORE_FAILED = 2, /* the memory could not be read or written */
  TUMBLESIGHT_STORE_DAMAGED = 3 /* read: the memory knows that its content is wrong */
};

/* Memory of a model image. It stays valid as long as the object, at an address that is a multiple of 64. */
struct tumblesight_bank {
  const uint8_t* image;  /* null: the bank does not exist */
  size_t image_bytes;    /* of the image at start; 0: none */
  uint8_t* writable;     /* the same address if the ground may load images into it, else null */
  size_t capacity_bytes; /* of `writable` */
};

/* For commands with a security trailer (docs/icd.md). */
struct tumblesight_command_keys {
  uint8_t slots[TUMBLESIGHT_KEY_SLOTS][TUMBLESIGHT_KEY_BYTES]; /* a key of zeros: the slot is empty */
  uint16_t spacecraft_id;
};

/* The APIDs of the packets. All zero: 0x1F0 to 0x1F4, in this order. */
struct tumblesight_apids {
  uint16_t command;
  uint16_t attitude_report;
  uint16_t telemetry;
  uint16_t event;
  uint16_t memory_dump;
};

/* All of it may be zero, except bank[0]. */
struct tumblesight_settings {
  struct tumblesight_bank bank[TUMBLESIGHT_BANKS];
  const char* expected_target; /* refuse the model of another target; null: any */
  enum tumblesight_reset_cause reset_cause;
  struct tumblesight_apids apids;
  const struct tumblesight_command_keys*
      command_keys; /* copied; null: the caller authenticates all commands */
  void* context;    /* first argument of the functions below */
  /* Monotonic: for durations in telemetry, and to cut the registration of a late step short, so that its
   * report is on time (cycle_budget_us). Null: durations are 0, and nothing is cut short. */
  uint64_t (*stopwatch_ns)(void* context);
  /* A store that survives a reset, with two copies (0 and 1) of TUMBLESIGHT_STORED_BYTES. Both null: none.
   * Each call takes a few milliseconds at most. A write that fails must not change the other copy. */
  enum tumblesight_store_status (*read_stored)(void* context, int copy, uint8_t* bytes);
  enum tumblesight_store_status (*write_stored)(void* context, int copy, const uint8_t* bytes);
};

struct tumblesight_app; /* the object */

/* What the object needs at this address, at most TUMBLESIGHT_MEMORY_BYTES. */
size_t tumblesight_memory_bytes(const void* memory);

/* Makes the object in `memory`, which stays its own as long as it is used, and boots it. `*app`: for all
 * other functions; set for TUMBLESIGHT_OK and TUMBLESIGHT_NO_MODEL, else null. May be called again. */
enum tumblesight_status tumblesight_init(void* memory, size_t memory_bytes,
                                         const struct tumblesight_settings* settings,
                                         struct tumblesight_app** app);

/* --- parameters --- */

enum tumblesight_response {
  TUMBLESIGHT_RESPONSE_IGNORE = 0,
  TUMBLESIGHT_RESPONSE_FLAG = 1,           /* an event */
  TUMBLESIGHT_RESPONSE_RESET_SEQUENCE = 2, /* an event, and the estimator is reset */
  TUMBLESIGHT_RESPONSE_SWITCH_BANK = 3,    /* an event, and the other bank's model is activated */
  TUMBLESIGHT_RESPONSE_SAFE = 4            /* an event, and the mode becomes SAFE */
};

/* A fault persists when it was present in `cycles` of the last `window_cycles` cycles. It is over after
 * `good_cycles` consecutive cycles without it. */
struct tumblesight_fault_rule {
  uint8_t cycles;        /* 1 ... window_cycles */
  uint8_t window_cycles; /* at most 32 */
  uint8_t good_cycles;   /* at least 1 */
  uint8_t response;      /* enum tumblesight_response */
};

/* What the ground can change without new software; also by the telecommands SET_PARAMETER and TABLE_LOAD.
 * docs/icd.md gives the meaning, the limits and the initial value of each field, and the faults by number. */
struct tumblesight_parameters {
  uint32_t predicted_error_urad;
  uint32_t attitude_jump_urad;
  uint32_t cycle_budget_us;
  uint32_t scrub_blocks;
  uint32_t future_tolerance_us;
  uint32_t max_frame_age_ms;
  uint32_t longest_coast_ms;
  uint32_t chaser_time_tolerance_us;
  uint32_t events_of_a_kind;
  uint32_t event_window_cycles;
  uint32_t longest_without_chaser_ms;
  struct tumblesight_fault_rule fault_rules[TUMBLESIGHT_FAULTS];
};

/* A field that is not allowed. */
struct tumblesight_wrong_parameter {
  const char* name;
  uint32_t value;   /* a rule: its four bytes, cycles first */
  uint32_t lowest;  /* of a rule 0 */
  uint32_t highest; /* of a rule 0 */
};

/* The values after a first start. */
void tumblesight_initial_parameters(struct tumblesight_parameters* parameters);

/* Whether tumblesight_set_parameters() takes them: TUMBLESIGHT_OK or TUMBLESIGHT_BAD_PARAMETER. `wrong` may
 * be null; else it is set to the first field that is not allowed. */
enum tumblesight_status tumblesight_check_parameters(const struct tumblesight_parameters* parameters,
                                                     struct tumblesight_wrong_parameter* wrong);

/* --- one step --- */

/* The chaser's attitude, or rather that of its LiDAR: v_inertial = q_inertial_lrf v_lrf. */
struct tumblesight_chaser {
  int64_t time_ns; /* for which it holds */
  int32_t q_inertial_lrf[4];
  bool is_known;
};

/* A frame of rays x rays ranges, row by row from the top left. Ray (row, column) points along (u, 1, v) of
 * the LRF: u = tan(fov / 2) ((2 column + 1) / rays - 1), v = tan(fov / 2) (1 - (2 row + 1) / rays). */
struct tumblesight_frame {
  int64_t exposure_time_ns;
  uint32_t sequence_number;
  uint32_t fov_urad;                /* full field of view of both axes */
  uint16_t rays;                    /* per side, at most TUMBLESIGHT_MAX_RAYS */
  const uint16_t* ranges;           /* along the ray [1/128 m]; 0: no return */
  struct tumblesight_chaser chaser; /* at the exposure */
};

/* A telecommand: a CCSDS packet with cFS's secondary header (docs/icd.md). */
struct tumblesight_command {
  const uint8_t* bytes;
  size_t size_bytes;
};

/* What has arrived since the last step. A step without frames and commands is normal. */
struct tumblesight_inputs {
  int64_t now_ns;                             /* later than in the last step */
  uint32_t slips;                             /* periods that were missed since then */
  const struct tumblesight_frame* frames;     /* the oldest first; the step uses the newest good one */
  size_t frame_count;                         /* at most TUMBLESIGHT_MAX_FRAMES */
  uint32_t frames_dropped;                    /* by the caller, for lack of room */
  const struct tumblesight_command* commands; /* joins those of tumblesight_put_command() */
  size_t command_count;                       /* at most TUMBLESIGHT_MAX_COMMANDS */
  uint32_t commands_dropped;                  /* by the caller, for lack of room */
  struct tumblesight_chaser chaser;           /* at now_ns */
};

enum tumblesight_validity {
  TUMBLESIGHT_VALID = 0,
  TUMBLESIGHT_STANDBY = 1, /* the mode is not RUN */
  TUMBLESIGHT_NO_FRAME = 2,
  TUMBLESIGHT_FRAME_REFUSED = 3, /* an event gives the reason */
  TUMBLESIGHT_DOUBTFUL = 4,      /* `doubts` gives the reasons */
  TUMBLESIGHT_PASSED_OVER = 5
};

/* An attitude may be used if `validity` is TUMBLESIGHT_VALID, a pose if `pose_doubts` is 0. */
struct tumblesight_attitude_report {
  int64_t time_ns;
  int64_t exposure_time_ns;
  uint32_t sequence_number;
  uint8_t validity;
  uint32_t frames_since_reset;
  int32_t q_lrf_trf[4];
  uint32_t predicted_error_urad;
  int32_t q_lrf_trf_single_frame[4];
  uint32_t predicted_error_single_frame_urad;
  uint8_t doubts;
  uint8_t law;
  int32_t rate_lrf_urad_s[3];
  int32_t attitude_covariance_e8[6];
  int32_t rate_covariance_e8[6];
  int32_t q_lrf_trf_now[4];
  int32_t rate_lrf_now_urad_s[3];
  int32_t q_lrf_trf_second[4];
  uint32_t second_odds_ppm;
  int32_t centroid_lrf_mm[3];
  uint8_t pose_doubts;
  uint8_t pose_frames;
  int32_t pose_q_lrf_trf[4];
  int32_t pose_origin_lrf_um[3];
  int32_t pose_rate_lrf_urad_s[3];
  int32_t pose_velocity_lrf_um_s[3];
  uint32_t pose_sigma[12];
  int16_t pose_correlation_q15[66];
  int32_t pose_q_lrf_trf_now[4];
  int32_t pose_origin_lrf_now_um[3];
  int32_t pose_rate_lrf_now_urad_s[3];
  int32_t pose_velocity_lrf_now_um_s[3];
  uint32_t pose_mean_square_q8;
  uint32_t pose_unexplained_ppm;
  uint32_t pose_missing_ppm;
  int32_t pose_advantage_q8;
};

struct tumblesight_telemetry {
  int64_t time_ns;
  uint8_t mode;
  uint8_t safe_cause;
  uint8_t safe_fault;
  uint32_t faults_persisting;
  uint32_t responses_disabled;
  uint32_t cycles;
  uint32_t commands_accepted;
  uint32_t commands_refused;
  uint32_t commands_refused_by[TUMBLESIGHT_COMMAND_REFUSALS];
  uint32_t command_counter;
  uint8_t key_slot;
  uint8_t store_health;
  uint32_t state_writes_failed;
  uint32_t store_given_up;
  uint32_t frames_used;
  uint32_t frames_missing;
  uint32_t frames_refused;
  uint32_t frames_duplicate;
  uint32_t frames_stale;
  uint32_t frames_bad;
  uint32_t frames_repeated;
  uint32_t frames_without_chaser;
  uint32_t frames_superseded;
  uint32_t frames_overflowed;
  uint32_t frames_passed_over;
  uint32_t sequence_gaps;
  uint32_t estimator_resets;
  uint32_t attitudes_doubtful;
  uint32_t poses_verified;
  uint32_t events;
  uint32_t events_suppressed;
  uint32_t events_lost;
  uint32_t events_waiting;
  uint32_t events_waiting_max;
  uint32_t memory_corrections;
  uint32_t states_restored;
  uint32_t states_lost;
  uint32_t constants_reloaded;
  uint32_t model_blocks_repaired;
  uint32_t model_blocks_lost;
  uint32_t model_tables_rebuilt;
  uint32_t model_passes;
  uint32_t bank_switches;
  uint8_t bank_in_use;
  uint8_t second_copy;
  uint8_t long_task;
  uint8_t bank_status[TUMBLESIGHT_BANKS];
  uint8_t bank_activity[TUMBLESIGHT_BANKS];
  uint32_t bank_crc32[TUMBLESIGHT_BANKS];
  uint32_t model_segments_missing;
  uint8_t table_status;
  uint32_t table_crc32;
  uint32_t inference_us;
  uint32_t inference_max_us;
  uint32_t cycle_us;
  uint32_t cycle_max_us;
  uint32_t store_us;
  uint32_t store_max_us;
  uint32_t cycles_by_time[TUMBLESIGHT_CYCLE_TIME_BINS];
  uint32_t deadline_overruns;
  uint32_t registrations_cut_short;
  uint32_t cycle_slips;
  uint32_t heap_allocations;
  uint32_t stack_left_min_bytes;
};

struct tumblesight_event {
  int64_t time_ns;
  uint16_t id;
  uint8_t severity;
  int32_t arguments[3];
};

struct tumblesight_memory_dump {
  int64_t time_ns;
  uint8_t memory;
  uint32_t offset;
  uint16_t size;
  uint8_t bytes[TUMBLESIGHT_DUMP_BYTES];
};

struct tumblesight_outputs {
  struct tumblesight_attitude_report attitude;
  struct tumblesight_telemetry telemetry;
  struct tumblesight_event events[TUMBLESIGHT_MAX_EVENTS];
  size_t event_count;
  struct tumblesight_memory_dump dump;
  bool has_dump;    /* `dump` answers a command of this step */
  bool duties_done; /* kick the watchdog after the outputs are sent */
};

/* Queues a telecommand for the next steps, each of which carries out the TUMBLESIGHT_MAX_COMMANDS oldest.
 * Call it whenever a command has arrived, or give commands to the step, which queues them in the same way.
 * With command keys, what is not authentic takes no place. The last four of TUMBLESIGHT_COMMAND_PLACES are
 * not for segments of a model, and the last one is for SET_MODE SAFE alone: so no upload and no other
 * commands keep it out. A size beyond TUMBLESIGHT_MAX_COMMAND_BYTES is refused by the step. */
enum tumblesight_status tumblesight_put_command(struct tumblesight_app* app, const uint8_t* bytes,
                                                size_t size_bytes);

/* Runs one cycle. `*outputs` stays valid until the next call. */
enum tumblesight_status tumblesight_step(struct tumblesight_app* app, const struct tumblesight_inputs* inputs,
                                         const struct tumblesight_outputs** outputs);

/* Between two steps: replaces all parameters. The next step stores them like those of a telecommand. */
enum tumblesight_status tumblesight_set_parameters(struct tumblesight_app* app,
                                                   const struct tumblesight_parameters* parameters);

/* The version of the library, as "0.1.0". */
const char* tumblesight_version(void);

/* What an event means, in a few words. Any number. */
const char* tumblesight_event_text(uint16_t event_id);

/* The outputs of the last step as CCSDS telemetry packets (docs/icd.md), one per call: attitude, telemetry,
 * events, dump. Returns the size of the packet in `bytes`, and 0 after the last one. `capacity_bytes`: at
 * least TUMBLESIGHT_MAX_PACKET_BYTES; with less nothing is written, and 0 returned. */
size_t tumblesight_take_packet(struct tumblesight_app* app, uint8_t* bytes, size_t capacity_bytes);

/* Of everything that the next step depends on, to compare runs: the same on every processor. 0 for null. */
uint32_t tumblesight_state_crc32(const struct tumblesight_app* app);

#ifdef __cplusplus
}
#endif

#endif /* TUMBLESIGHT_C_H */
