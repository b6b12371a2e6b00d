/* A plugin for QEMU: counts the instructions that a program executes and the cycles that they take, stage by
   stage.
     qemu-… -plugin count_cycles.so,stages=FILE,cycles=FILE,model=FILE,out=FILE …

   stages: lines "ADDRESS NAME" with the address (hexadecimal) where the stage's function begins. A stage
   lasts until the next one begins. The first stage begins a step, the second ends it.

   cycles: lines "ADDRESS CYCLES BRANCH MORE", in order of the addresses: what each instruction keeps the
   pipeline busy; '-', 'c' (conditional branch), 'a' (the same with a delay slot that is annulled if it is not
   taken), 'j' (jump, call) or 'r' (through a register); more cycles of a branch that is not taken. Of an
   instruction without a line: one cycle.

   model: lines "NAME VALUE", the rest of the processor; see read_model().

   out: one line per step, the stages' instructions in that order and then their cycles. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* QEMU's plugin interface, version 1, as far as needed: Debian has no header for it. */
typedef uint64_t qemu_plugin_id_t;
typedef uint32_t qemu_plugin_meminfo_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
enum { QEMU_PLUGIN_CB_NO_REGS = 0, QEMU_PLUGIN_INLINE_ADD_U64 = 0, QEMU_PLUGIN_MEM_RW = 3 };
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*callback)(qemu_plugin_id_t, struct qemu_plugin_tb*));
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* tb);
struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb* tb, size_t index);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn* insn);
size_t qemu_plugin_insn_size(const struct qemu_plugin_insn* insn);
void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn* insn, int operation, void* to,
                                                uint64_t value);
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn* insn, void (*callback)(unsigned, void*),
                                            int flags, void* data);
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb* tb, void (*callback)(unsigned, void*),
                                          int flags, void* data);
void qemu_plugin_register_vcpu_mem_cb(struct qemu_plugin_insn* insn,
                                      void (*callback)(unsigned, qemu_plugin_meminfo_t, uint64_t, void*),
                                      int flags, int access, void* data);
int qemu_plugin_mem_is_store(qemu_plugin_meminfo_t info);
unsigned qemu_plugin_mem_size_shift(qemu_plugin_meminfo_t info);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, void*),
                                    void* data);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

enum { kMaxStages = 64, kFirst = 0, kEnd = 1 };
static uint64_t address[kMaxStages];
static int stages;
static FILE* out;

typedef struct {
  uint64_t instructions, cycles;
} Count;
static Count executed;          /* since the start */
static Count at_last_change;    /* value of `executed` at the last change of stage */
static Count count[kMaxStages]; /* of this step */
static int current = kEnd;

/* A set-associative cache, its least recently used line replaced. */
typedef struct {
  uint64_t line_bytes, sets, ways, miss_cycles, store_miss_cycles, allocates_on_store;
  uint64_t* lines; /* [sets][ways], the last used first: the line's number + 1; 0: empty */
  uint64_t misses;
} Cache;
static Cache fetches = {.allocates_on_store = 1}, accesses = {.allocates_on_store = 1};

/* Branches. Without a predictor every taken branch costs taken_cycles. The predictor is a table of two-bit
   counters. */
static uint64_t has_predictor, taken_cycles, mispredicted_cycles, indirect_cycles;
enum { kCounters = 1024 };
static uint8_t counter[kCounters];

/* What the table of cycles says of an instruction. */
typedef struct {
  uint64_t at;
  uint32_t cycles;
  char branch;
  uint32_t not_taken_cycles;
} Entry;
static Entry* entries;
static size_t entry_count;

/* A block of translated instructions: only the last, or the one before its delay slot, branches. */
typedef struct {
  uint64_t begin, end;
  Entry branch;
} Block;
static const Block* before; /* the block executed before */

static void begin_stage(unsigned processor, void* data) {
  (void)processor;
  const int stage = (int)(intptr_t)data;
  count[current].instructions += executed.instructions - at_last_change.instructions;
  count[current].cycles += executed.cycles - at_last_change.cycles;
  at_last_change = executed;
  if (stage == kEnd && current != kEnd) {
    for (int i = 0; i < stages; ++i) {
      if (i != kEnd) fprintf(out, "%" PRIu64 " ", count[i].instructions);
    }
    for (int i = 0; i < stages; ++i) {
      if (i != kEnd) fprintf(out, "%" PRIu64 " ", count[i].cycles);
    }
    fprintf(out, "\n");
  }
  if (stage == kEnd || (stage == kFirst && current == kEnd)) memset(count, 0, sizeof count);
  if (current != kEnd || stage == kFirst) current = stage;
}

/* Whether the cache holds the line; it does afterwards if `allocate`. */
static int touch(Cache* cache, uint64_t line, int allocate) {
  uint64_t* const set = cache->lines + line % cache->sets * cache->ways;
  const uint64_t tag = line + 1;
  if (set[0] == tag) return 1;
  uint64_t way = 1;
  while (way < cache->ways && set[way] != tag) ++way;
  const int hit = way < cache->ways;
  if (!hit) ++cache->misses;
  if (!hit && !allocate) return 0;
  if (!hit) way = cache->ways - 1;
  memmove(set + 1, set, way * sizeof *set);
  set[0] = tag;
  return hit;
}

/* The write buffer holds one store. Until it is empty, stores wait, and so do fetches and loads that miss. */
static uint64_t buffer_cycles, double_buffer_cycles, buffer_is_empty_at;
static void wait_for_buffer(void) {
  if (executed.cycles < buffer_is_empty_at) executed.cycles = buffer_is_empty_at;
}

static void access_memory(unsigned processor, qemu_plugin_meminfo_t info, uint64_t at, void* data) {
  (void)processor;
  (void)data;
  const int store = qemu_plugin_mem_is_store(info);
  if (store && buffer_cycles > 0) {
    wait_for_buffer();
    const int is_double = qemu_plugin_mem_size_shift(info) == 3;
    buffer_is_empty_at = executed.cycles + (is_double ? double_buffer_cycles : buffer_cycles);
  }
  if (touch(&accesses, at / accesses.line_bytes, !store || accesses.allocates_on_store)) return;
  if (!store) wait_for_buffer();
  executed.cycles += store ? accesses.store_miss_cycles : accesses.miss_cycles;
}

static void leave(const Block* block, uint64_t to) {
  const Entry* const branch = &block->branch;
  if (branch->branch == 'r') executed.cycles += indirect_cycles;
  if (branch->branch == 'j') executed.cycles += taken_cycles;
  if (branch->branch != 'c' && branch->branch != 'a') return;
  /* SPARC: QEMU ends the block before a delay slot that may be annulled, and goes on with it if the branch is
     taken. */
  const int annuls = branch->branch == 'a';
  const int taken = (to == block->end) == annuls;
  if (!taken) executed.cycles += branch->not_taken_cycles + annuls;
  int predicted = 1;
  if (has_predictor) {
    uint8_t* const state = &counter[(branch->at >> 1) % kCounters];
    predicted = (*state >= 2) == taken;
    if (taken && *state < 3) ++*state;
    if (!taken && *state > 0) --*state;
  }
  executed.cycles += !predicted ? mispredicted_cycles : taken ? taken_cycles : 0;
}

static void execute_block(unsigned processor, void* data) {
  (void)processor;
  const Block* const block = data;
  if (before != NULL) leave(before, block->begin);
  before = block;
  if (fetches.sets == 0) return;
  for (uint64_t line = block->begin / fetches.line_bytes; line <= (block->end - 1) / fetches.line_bytes;
       ++line) {
    if (touch(&fetches, line, 1)) continue;
    wait_for_buffer();
    executed.cycles += fetches.miss_cycles;
  }
}

static int compare_entries(const void* a, const void* b) {
  const uint64_t x = ((const Entry*)a)->at, y = ((const Entry*)b)->at;
  return (x > y) - (x < y);
}

static Entry entry_at(uint64_t at) {
  const Entry wanted = {.at = at};
  const Entry* const found = bsearch(&wanted, entries, entry_count, sizeof wanted, compare_entries);
  return found ? *found : (Entry){.at = at, .cycles = 1, .branch = '-'};
}

static void translate(qemu_plugin_id_t id, struct qemu_plugin_tb* tb) {
  (void)id;
  Block* const block = calloc(1, sizeof *block); /* kept: QEMU goes on to call with it */
  for (size_t i = 0; i < qemu_plugin_tb_n_insns(tb); ++i) {
    struct qemu_plugin_insn* const insn = qemu_plugin_tb_get_insn(tb, i);
    const uint64_t at = qemu_plugin_insn_vaddr(insn);
    const Entry entry = entry_at(at);
    for (int stage = 0; stage < stages; ++stage) {
      if (address[stage] == at)
        qemu_plugin_register_vcpu_insn_exec_cb(insn, begin_stage, QEMU_PLUGIN_CB_NO_REGS,
                                               (void*)(intptr_t)stage);
    }
    qemu_plugin_register_vcpu_insn_exec_inline(insn, QEMU_PLUGIN_INLINE_ADD_U64, &executed.instructions, 1);
    if (entry.cycles > 0)
      qemu_plugin_register_vcpu_insn_exec_inline(insn, QEMU_PLUGIN_INLINE_ADD_U64, &executed.cycles,
                                                 entry.cycles);
    if (accesses.sets > 0)
      qemu_plugin_register_vcpu_mem_cb(insn, access_memory, QEMU_PLUGIN_CB_NO_REGS, QEMU_PLUGIN_MEM_RW, NULL);
    if (i == 0) block->begin = at;
    block->end = at + qemu_plugin_insn_size(insn);
    if (entry.branch != '-') block->branch = entry;
  }
  qemu_plugin_register_vcpu_tb_exec_cb(tb, execute_block, QEMU_PLUGIN_CB_NO_REGS, block);
}

static void finish(qemu_plugin_id_t id, void* data) {
  (void)id;
  (void)data;
  fclose(out);
  fprintf(stderr,
          "count_cycles: %" PRIu64 " instructions, %" PRIu64 " cycles, %" PRIu64 " fetch misses, %" PRIu64
          " data misses\n",
          executed.instructions, executed.cycles, fetches.misses, accesses.misses);
}

static int read_stages(const char* path) {
  FILE* const file = fopen(path, "r");
  if (file == NULL) return -1;
  while (stages < kMaxStages && fscanf(file, "%" SCNx64 " %*[^\n]", &address[stages]) == 1) ++stages;
  fclose(file);
  return stages > kEnd ? 0 : -1;
}

static int read_cycles(const char* path) {
  FILE* const file = fopen(path, "r");
  if (file == NULL) return -1;
  size_t room = 0;
  Entry entry;
  while (fscanf(file, "%" SCNx64 " %" SCNu32 " %c %" SCNu32, &entry.at, &entry.cycles, &entry.branch,
                &entry.not_taken_cycles) == 4) {
    if (entry_count == room) {
      room = 2 * room + 1024;
      entries = realloc(entries, room * sizeof *entries);
    }
    entries[entry_count++] = entry;
  }
  fclose(file);
  return entry_count > 0 ? 0 : -1;
}

static int read_model(const char* path) {
  const struct {
    const char* name;
    uint64_t* value;
  } fields[] = {{"fetch_line_bytes", &fetches.line_bytes},
                {"fetch_sets", &fetches.sets},
                {"fetch_ways", &fetches.ways},
                {"fetch_miss_cycles", &fetches.miss_cycles},
                {"data_line_bytes", &accesses.line_bytes},
                {"data_sets", &accesses.sets},
                {"data_ways", &accesses.ways},
                {"data_miss_cycles", &accesses.miss_cycles},
                {"data_store_miss_cycles", &accesses.store_miss_cycles},
                {"data_allocates_on_store", &accesses.allocates_on_store},
                {"buffer_cycles", &buffer_cycles},
                {"double_buffer_cycles", &double_buffer_cycles},
                {"has_predictor", &has_predictor},
                {"taken_cycles", &taken_cycles},
                {"mispredicted_cycles", &mispredicted_cycles},
                {"indirect_cycles", &indirect_cycles}};
  FILE* const file = fopen(path, "r");
  if (file == NULL) return -1;
  char name[64];
  uint64_t value;
  int known = 1;
  while (known && fscanf(file, "%63s %" SCNu64, name, &value) == 2) {
    known = 0;
    for (size_t i = 0; i < sizeof fields / sizeof *fields; ++i) {
      if (strcmp(fields[i].name, name) == 0) {
        *fields[i].value = value;
        known = 1;
      }
    }
  }
  fclose(file);
  fetches.lines = calloc(fetches.sets * fetches.ways + 1, sizeof *fetches.lines);
  accesses.lines = calloc(accesses.sets * accesses.ways + 1, sizeof *accesses.lines);
  return known ? 0 : -1;
}

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const void* info,
                                                               int argc, char** argv) {
  (void)info;
  int missing = 3;
  for (int i = 0; i < argc; ++i) {
    if (strncmp(argv[i], "stages=", 7) == 0) missing -= read_stages(argv[i] + 7) == 0;
    if (strncmp(argv[i], "cycles=", 7) == 0) missing -= read_cycles(argv[i] + 7) == 0;
    if (strncmp(argv[i], "model=", 6) == 0) missing -= read_model(argv[i] + 6) == 0;
    if (strncmp(argv[i], "out=", 4) == 0) out = fopen(argv[i] + 4, "w");
  }
  if (missing != 0 || out == NULL) {
    fprintf(stderr, "count_cycles: needs stages=FILE (at least two), cycles=FILE, model=FILE and out=FILE\n");
    return -1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
  qemu_plugin_register_atexit_cb(id, finish, NULL);
  return 0;
}
