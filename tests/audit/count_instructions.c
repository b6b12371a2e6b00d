/* A plugin for QEMU: counts the instructions that a program executes, stage by stage.
     qemu-… -plugin count_instructions.so,stages=FILE,out=FILE …
   `stages`: lines "ADDRESS NAME" with the address (hexadecimal) where the stage's function begins. A stage
   lasts until the next one begins. The first stage begins a step, the second ends it. `out`: one line per
   step with the stages' counts in that order. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* QEMU's plugin interface, version 1, as far as needed: Debian has no header for it. */
typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
enum { QEMU_PLUGIN_CB_NO_REGS = 0, QEMU_PLUGIN_INLINE_ADD_U64 = 0 };
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*callback)(qemu_plugin_id_t, struct qemu_plugin_tb*));
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* tb);
struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb* tb, size_t index);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn* insn);
void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn* insn, int operation, void* to,
                                                uint64_t value);
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn* insn, void (*callback)(unsigned, void*),
                                            int flags, void* data);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, void*),
                                    void* data);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

enum { kMaxStages = 64, kFirst = 0, kEnd = 1 };
static uint64_t address[kMaxStages];
static int stages;
static FILE* out;

static uint64_t executed;          /* since the start */
static uint64_t at_last_change;    /* value of `executed` at the last change of stage */
static uint64_t count[kMaxStages]; /* of this step */
static int current = kEnd;

static void begin_stage(unsigned processor, void* data) {
  (void)processor;
  const int stage = (int)(intptr_t)data;
  count[current] += executed - at_last_change;
  at_last_change = executed;
  if (stage == kEnd && current != kEnd) {
    for (int i = 0; i < stages; ++i) {
      if (i != kEnd) fprintf(out, "%" PRIu64 " ", count[i]);
    }
    fprintf(out, "\n");
  }
  if (stage == kEnd || (stage == kFirst && current == kEnd)) memset(count, 0, sizeof count);
  if (current != kEnd || stage == kFirst) current = stage;
}

static void translate(qemu_plugin_id_t id, struct qemu_plugin_tb* tb) {
  (void)id;
  for (size_t i = 0; i < qemu_plugin_tb_n_insns(tb); ++i) {
    struct qemu_plugin_insn* const insn = qemu_plugin_tb_get_insn(tb, i);
    const uint64_t at = qemu_plugin_insn_vaddr(insn);
    for (int stage = 0; stage < stages; ++stage) {
      if (address[stage] == at)
        qemu_plugin_register_vcpu_insn_exec_cb(insn, begin_stage, QEMU_PLUGIN_CB_NO_REGS,
                                               (void*)(intptr_t)stage);
    }
    qemu_plugin_register_vcpu_insn_exec_inline(insn, QEMU_PLUGIN_INLINE_ADD_U64, &executed, 1);
  }
}

static void finish(qemu_plugin_id_t id, void* data) {
  (void)id;
  (void)data;
  fclose(out);
}

static int read_stages(const char* path) {
  FILE* const file = fopen(path, "r");
  if (file == NULL) return -1;
  while (stages < kMaxStages && fscanf(file, "%" SCNx64 " %*[^\n]", &address[stages]) == 1) ++stages;
  fclose(file);
  return stages > kEnd ? 0 : -1;
}

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const void* info,
                                                               int argc, char** argv) {
  (void)info;
  int status = -1;
  for (int i = 0; i < argc; ++i) {
    if (strncmp(argv[i], "stages=", 7) == 0) status = read_stages(argv[i] + 7);
    if (strncmp(argv[i], "out=", 4) == 0) out = fopen(argv[i] + 4, "w");
  }
  if (status != 0 || out == NULL) {
    fprintf(stderr, "count_instructions: needs stages=FILE (at least two) and out=FILE\n");
    return -1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
  qemu_plugin_register_atexit_cb(id, finish, NULL);
  return 0;
}
