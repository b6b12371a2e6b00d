"""Tests of the models of the processors' pipelines: closed forms of short sequences, out of the manuals that the models name."""
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
        self.assertEqual(of(sparc.SLOW, "smul %g1, %g2, %g3", "add %g3, 1, %g3"), [4, 2])
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
        self.assertEqual((spent.cycles, spent.branch, spent.not_taken_cycles), (1, "c", 2))


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

    def test_a_list_of_registers_takes_a_cycle_per_pair(self):
        self.assertEqual(of(arm.M7_CACHED, "pop {r4, r5, r6, r7, r8}"), [3])

    def test_both_halves_of_a_long_product_are_written(self):
        self.assertEqual(of(arm.R5F, "smull r0, r1, r2, r3", "add r4, r1, #1"), [2, 2])

    def test_a_register_of_128_bits_is_two_of_64(self):
        self.assertEqual(arm.names("q8"), ["d16", "d17"])
        self.assertEqual(arm.names("{d16-d18}"), ["d16", "d17", "d18", "d16", "d18"])

    def test_kinds_of_branches(self):
        for model, line, kind in ((arm.M7_CACHED, "bl 100", "j"), (arm.M7_CACHED, "bls.n 100", "c"), (arm.M7_CACHED, "blt.w 100", "c"),
                                  (arm.M7_CACHED, "bx lr", "r"), (arm.M7_CACHED, "pop {r4, pc}", "r"), (arm.M7_CACHED, "cbz r0, 100", "c"),
                                  (aarch64.A53, "b.ne 100", "c"), (aarch64.A53, "ret", "r"), (powerpc.PPC750, "bdnz 100", "c"),
                                  (powerpc.PPC750, "blr", "r"), (powerpc.PPC750, "beqlr", "r"), (riscv.U54, "bnez a0,100", "c"),
                                  (riscv.U54, "jal 100", "j"), (sparc.SLOW, "b,a 100", "j"), (sparc.SLOW, "retl", "r")):
            with self.subTest(line):
                mnemonic, _, operands = line.partition(" ")
                self.assertEqual(pipeline.rule_of(model.rules, pipeline.Instruction(0, mnemonic, operands)).branch, kind)

    def test_an_instruction_without_a_timing_is_named(self):
        with self.assertRaisesRegex(ValueError, "no timing for the instruction '%x r0'"):
            of(arm.M7_CACHED, "%x r0")


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
