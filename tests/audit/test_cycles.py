"""Tests of the models of the processors' pipelines: closed forms of short sequences, out of the manuals that the models name."""
import ctypes
import pathlib
import subprocess
import tempfile
import unittest

from cycles import aarch64, arm, pipeline, powerpc, riscv, sparc


def of(model, *lines):
    """Cycles of each line, as 'ld [%g1], %g2'."""
    program = [pipeline.Instruction(4 * i, *(line.split(" ", 1) + [""])[:2]) for i, line in enumerate(lines)]
    return [spent.cycles for spent in pipeline.static_cycles(program, model)]


class Leon3(unittest.TestCase):
    def test_a_load_is_waited_for_by_the_next_instruction_only(self):
        self.assertEqual(of(sparc.SLOW, "ld [ %g1 ], %g2", "add %g2, 1, %g3"), [1, 2])
        self.assertEqual(of(sparc.SLOW, "ld [ %g1 ], %g2", "mov 1, %g4", "add %g2, 1, %g3"), [1, 1, 1])

    def test_of_a_double_load_the_odd_register_comes_last(self):
        self.assertEqual(of(sparc.SLOW, "ldd [ %g1 ], %g2", "add %g2, 1, %g4"), [2, 1])
        self.assertEqual(of(sparc.SLOW, "ldd [ %g1 ], %g2", "add %g3, 1, %g4"), [2, 2])

    def test_what_is_stored_is_not_waited_for_but_the_address_is(self):
        self.assertEqual(of(sparc.SLOW, "ld [ %g1 ], %g2", "st %g2, [ %g3 ]"), [1, 2])
        self.assertEqual(of(sparc.SLOW, "ld [ %g1 ], %g2", "st %g3, [ %g2 ]"), [1, 3])

    def test_multiplier(self):
        self.assertEqual(of(sparc.SLOW, "smul %g1, %g2, %g3", "add %g3, 1, %g3"), [5, 2])
        self.assertEqual(of(sparc.FAST, "smul %g1, %g2, %g3", "add %g3, 1, %g3"), [1, 2])
        self.assertEqual(of(sparc.FAST, "smul %g1, %g2, %g3", "nop", "add %g3, 1, %g3"), [1, 1, 1])

    def test_a_register_is_cleared_in_one_cycle_and_memory_in_two(self):
        self.assertEqual(of(sparc.SLOW, "clr %g1", "clr [ %g1 ]"), [1, 2])

    def test_a_branch_waits_for_its_condition(self):
        self.assertEqual(of(sparc.SLOW, "cmp %g1, 3", "bne 40000000"), [1, 3])
        self.assertEqual(of(sparc.SLOW, "cmp %g1, 3", "nop", "nop", "bne 40000000"), [1, 1, 1, 1])

    def test_a_predicted_branch_waits_only_if_it_is_not_taken(self):
        program = [pipeline.Instruction(0, "cmp", "%g1, 3"), pipeline.Instruction(4, "bne,a", "40000000")]
        spent = pipeline.static_cycles(program, sparc.FAST)[1]
        self.assertEqual((spent.cycles, spent.branch, spent.not_taken_cycles), (1, "a", 2))

    def test_what_is_increased_is_read(self):
        self.assertEqual(of(sparc.SLOW, "ld [ %g1 ], %g2", "inc %g2"), [1, 2])

    def test_a_call_through_a_register_is_a_jump(self):
        self.assertEqual(of(sparc.SLOW, "call %g1", "call 40000000"), [3, 1])


class OtherProcessors(unittest.TestCase):
    def test_two_instructions_start_together_if_neither_needs_the_other(self):
        for model, first, second, third in ((arm.M7_CACHED, "add r0, r1, r2", "add r3, r4, r5", "add r3, r0, r5"),
                                            (aarch64.A53, "add w0, w1, w2", "add w3, w4, w5", "add w3, w0, w5"),
                                            (powerpc.PPC750, "add r0,r1,r2", "add r3,r4,r5", "add r3,r0,r5")):
            with self.subTest(model.title):
                self.assertEqual(of(model, first, second), [1, 0])
                self.assertEqual(of(model, first, third), [1, 1])

    def test_not_two_of_one_unit(self):
        self.assertEqual(of(arm.M7_CACHED, "mul r0, r1, r2", "mul r3, r4, r5"), [1, 1])
        self.assertEqual(of(powerpc.PPC750, "mullw r0,r1,r2", "mullw r3,r4,r5"), [1, 5])

    def test_loads(self):
        self.assertEqual(of(arm.M7_CACHED, "ldr r0, [r1]", "add r2, r0, #1"), [1, 2])
        self.assertEqual(of(arm.A9, "ldrb r0, [r1]", "add r2, r0, #1"), [2, 3])
        self.assertEqual(of(riscv.U54, "lw a0,8(a1)", "addi a0,a0,1"), [1, 2])
        self.assertEqual(of(riscv.U54, "lh a0,8(a1)", "addi a0,a0,1"), [1, 3])

    def test_a_destination_that_is_also_read_is_waited_for(self):
        self.assertEqual(of(arm.M7_CACHED, "ldr r3, [r1]", "adds r3, #1"), [1, 2])
        self.assertEqual(of(arm.M7_CACHED, "ldr r3, [r1]", "movs r3, #1"), [1, 0])
        self.assertEqual(of(aarch64.A53, "smlal v0.4s, v1.4h, v2.4h", "smlal v0.4s, v3.4h, v4.4h"), [2, 5])
        self.assertEqual(of(powerpc.PPC750, "lwz r3,0(r4)", "rlwimi r3,r5,0,8,15"), [1, 2])

    def test_a_special_register_is_written_from_a_general_one(self):
        self.assertEqual(of(powerpc.PPC750, "lwz r0,20(r1)", "mtlr r0"), [1, 2])
        self.assertEqual(of(powerpc.PPC750, "mullw r9,r3,r4", "mtctr r9"), [1, 5])

    def test_halfword_products_use_the_multiplier(self):
        self.assertEqual(of(arm.A9, "smulbb r0, r1, r2", "add r3, r0, #1"), [1, 3])

    def test_a_literal_is_a_load_and_no_jump(self):
        self.assertEqual(of(arm.M7_CACHED, "ldr r3, [pc, #16]", "add r2, r3, #1"), [1, 2])

    def test_a_list_of_registers_takes_a_cycle_per_pair(self):
        self.assertEqual(of(arm.M7_CACHED, "pop {r4, r5, r6, r7, r8}"), [3])

    def test_both_halves_of_a_long_product_are_written(self):
        self.assertEqual(of(arm.R5F, "smull r0, r1, r2, r3", "add r4, r1, #1"), [2, 2])

    def test_a_register_of_128_bits_is_two_of_64(self):
        self.assertEqual(arm.names("q8"), ["d16", "d17"])
        self.assertEqual(arm.names("{d16-d18}"), ["d16", "d17", "d18", "d16", "d18"])

    def test_kinds_of_branches(self):
        for model, line, kind in ((arm.M7_CACHED, "bl 100", "j"), (arm.M7_CACHED, "bls.n 100", "c"), (arm.M7_CACHED, "blt.w 100", "c"),
                                  (arm.M7_CACHED, "bx lr", "r"), (arm.M7_CACHED, "ldr.w pc, [sp], #4", "r"),
                                  (arm.M7_CACHED, "ldr r3, [pc, #16]", "-"), (arm.M7_CACHED, "pop.w {r4, pc}", "r"), (sparc.SLOW, "btst 4, %g1", "-"),
                                  (sparc.SLOW, "bne,a 100", "a"), (sparc.SLOW, "bne 100", "c"), (sparc.SLOW, "call %g1", "r"), (arm.M7_CACHED, "pop {r4, pc}", "r"), (arm.M7_CACHED, "cbz r0, 100", "c"),
                                  (aarch64.A53, "b.ne 100", "c"), (aarch64.A53, "ret", "r"), (powerpc.PPC750, "bdnz 100", "c"),
                                  (powerpc.PPC750, "blr", "r"), (powerpc.PPC750, "beqlr", "r"), (riscv.U54, "bnez a0,100", "c"),
                                  (riscv.U54, "jal 100", "j"), (sparc.SLOW, "b,a 100", "j"), (sparc.SLOW, "retl", "r")):
            with self.subTest(line):
                mnemonic, _, operands = line.partition(" ")
                self.assertEqual(pipeline.rule_of(model.rules, pipeline.Instruction(0, mnemonic, operands)).branch, kind)

    def test_an_instruction_without_a_timing_is_named(self):
        with self.assertRaisesRegex(ValueError, "no timing for the instruction '%x r0'"):
            of(arm.M7_CACHED, "%x r0")


# The plug-in without QEMU: its functions by name, and what they call of QEMU's as far as a test needs it.
PLUGIN = """
#include "count_cycles.c"
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* tb) { (void)tb; return 0; }
struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb* tb, size_t i) { (void)tb; (void)i; return NULL; }
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn* insn) { (void)insn; return 0; }
size_t qemu_plugin_insn_size(const struct qemu_plugin_insn* insn) { (void)insn; return 0; }
int qemu_plugin_mem_is_store(qemu_plugin_meminfo_t info) { return (int)info & 1; }
unsigned qemu_plugin_mem_size_shift(qemu_plugin_meminfo_t info) { return info >> 1; }
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t i, void (*f)(qemu_plugin_id_t, struct qemu_plugin_tb*)) { (void)i; (void)f; }
void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn* a, int b, void* c, uint64_t d) { (void)a; (void)b; (void)c; (void)d; }
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn* a, void (*b)(unsigned, void*), int c, void* d) {
  (void)a; (void)b; (void)c; (void)d;
}
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb* a, void (*b)(unsigned, void*), int c, void* d) {
  (void)a; (void)b; (void)c; (void)d;
}
void qemu_plugin_register_vcpu_mem_cb(struct qemu_plugin_insn* a, void (*b)(unsigned, qemu_plugin_meminfo_t, uint64_t, void*), int c,
                                      int d, void* e) {
  (void)a; (void)b; (void)c; (void)d; (void)e;
}
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t a, void (*b)(qemu_plugin_id_t, void*), void* c) { (void)a; (void)b; (void)c; }
void begin(const char* model) {
  memset(&executed, 0, sizeof executed);
  memset(counter, 0, sizeof counter);
  memset(&fetches, 0, sizeof fetches);
  accesses = (Cache){.allocates_on_store = 1};
  buffer_cycles = double_buffer_cycles = buffer_is_empty_at = 0;
  has_predictor = taken_cycles = mispredicted_cycles = indirect_cycles = 0;
  if (read_model(model) != 0) abort();
}
void pass_(uint64_t cycles) { executed.cycles += cycles; }
uint64_t access_at(uint64_t at, int store) {
  const uint64_t before_it = executed.cycles;
  access_memory(0, (qemu_plugin_meminfo_t)store, at, NULL);
  return executed.cycles - before_it;
}
uint64_t leave_for(char kind, uint32_t not_taken, uint64_t to) {
  const Block block = {.begin = 0, .end = 8, .branch = {.at = 4, .branch = kind, .not_taken_cycles = not_taken}};
  const uint64_t before_it = executed.cycles;
  leave(&block, to);
  return executed.cycles - before_it;
}
"""


class Plugin(unittest.TestCase):
    """What count_cycles.c adds to the pipeline's cycles."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        source, library = pathlib.Path(cls.folder.name, "plugin.c"), pathlib.Path(cls.folder.name, "plugin.so")
        source.write_text(PLUGIN)
        subprocess.run(["gcc", "-shared", "-fPIC", "-I", str(pathlib.Path(__file__).parent), str(source), "-o", str(library)], check=True)
        cls.plugin = ctypes.CDLL(str(library))
        for function, arguments in (("access_at", [ctypes.c_uint64, ctypes.c_int]),
                                    ("pass_", [ctypes.c_uint64]), ("leave_for", [ctypes.c_char, ctypes.c_uint32, ctypes.c_uint64])):
            getattr(cls.plugin, function).argtypes = arguments
            getattr(cls.plugin, function).restype = ctypes.c_uint64

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def begin(self, model):
        settings = pathlib.Path(self.folder.name, "model")
        settings.write_text(pipeline.as_settings(model))
        self.plugin.begin(str(settings).encode())

    def test_a_cache_keeps_the_lines_used_last(self):
        cache = pipeline.Cache(size_bytes=2 * 2 * 16, ways=2, line_bytes=16, miss_cycles=10)
        self.begin(pipeline.Model("", None, (), accesses=cache))
        # Two sets; lines 0, 2 and 4 share one, of two ways.
        reads = [(0, 10), (4, 0), (32, 10), (0, 0), (64, 10), (0, 0), (32, 10), (16, 10), (64, 10)]
        self.assertEqual([self.plugin.access_at(at, 0) for at, _ in reads], [cycles for _, cycles in reads])

    def test_a_store_that_misses(self):
        through = pipeline.Cache(64, 2, 16, miss_cycles=10, allocates_on_store=False)
        self.begin(pipeline.Model("", None, (), accesses=through))
        self.assertEqual([self.plugin.access_at(0, 1), self.plugin.access_at(0, 0)], [0, 10])
        back = pipeline.Cache(64, 2, 16, miss_cycles=10, store_miss_cycles=3)
        self.begin(pipeline.Model("", None, (), accesses=back))
        self.assertEqual([self.plugin.access_at(0, 1), self.plugin.access_at(0, 0)], [3, 0])

    # As GRLIB 2025.2 in simulation: stores in a row take as long as the memory, and so does a load that misses behind one.
    def test_a_store_waits_until_the_one_before_is_written(self):
        cache = pipeline.Cache(64, 2, 16, miss_cycles=10, allocates_on_store=False)
        self.begin(pipeline.Model("", None, (), accesses=cache, write_buffer=pipeline.WriteBuffer(5, 9)))
        load, store, double_store = 0, 1, 1 + 2 * 3
        self.plugin.access_at(0, load)
        at = 0
        for cycles, access, waits in ((2, store, 0), (2, store, 3), (3, double_store, 3), (2, store, 6), (2, load, 0), (9, store, 1)):
            with self.subTest(at := at + 1):
                self.assertEqual(self.plugin.access_at(0, access), waits)
                self.plugin.pass_(cycles)
        self.assertEqual(self.plugin.access_at(0, store), 0)
        self.plugin.pass_(2)
        self.assertEqual(self.plugin.access_at(1024, load), 3 + 10, "a miss")

    def test_branches_without_a_predictor(self):
        self.begin(pipeline.Model("", None, (), branches=pipeline.Branches(taken=2, indirect=5)))
        end, elsewhere = 8, 100
        for kind, to, cycles in ((b"c", elsewhere, 2), (b"c", end, 7), (b"a", end, 2), (b"a", 12, 8), (b"j", elsewhere, 2),
                                 (b"r", elsewhere, 5), (b"-", end, 0)):
            with self.subTest((kind, to)):
                self.assertEqual(self.plugin.leave_for(kind, 7, to), cycles)

    def test_a_predictor_learns_and_errs_once_at_the_end_of_a_loop(self):
        self.begin(pipeline.Model("", None, (), branches=pipeline.Branches(mispredicted=9, predicted=True)))
        self.assertEqual([self.plugin.leave_for(b"c", 0, to) for to in (100, 100, 100, 100, 8, 100)], [9, 9, 0, 0, 9, 0])


class Inputs(unittest.TestCase):
    def test_operands_are_separated_outside_of_brackets(self):
        self.assertEqual(pipeline.split("r0, [r1, #4], {d0, d1}"), ["r0", "[r1, #4]", "{d0, d1}"])

    def test_settings_hold_the_geometry_of_the_caches(self):
        text = pipeline.as_settings(sparc.SLOW)
        for line in ("fetch_sets 128", "data_sets 256", "data_miss_cycles 14", "data_allocates_on_store 0", "has_predictor 0"):
            self.assertIn(line + "\n", text)
        self.assertNotIn("fetch", pipeline.as_settings(arm.M7_TIGHTLY_COUPLED))


if __name__ == "__main__":
    unittest.main()
