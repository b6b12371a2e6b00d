"""The audit fails when it has to. Run by ctest; alone: python3 -m unittest discover tests/audit"""
import pathlib
import tempfile
import unittest

import instruction_count
import processors
import report
import stack

MACS = 1000
BUDGETS = {"ram": 100, "stack": 10, "text": 100, "read_only": 100}
PROCESSOR = processors.by_name("cortex-m7")


def result(**changes):
    good = {"digest": "0", "digest_is_golden": True, "equal_counts": True, "unequal": {}, "forbidden": {}, "floating_point": [],
            "instructions": 1000, "text": 50, "read_only": 50, "ram": 50, "stack": 5}
    return [(PROCESSOR, "fixed", {**good, **changes})]


# Verifies TS-TIM-050.
class Failures(unittest.TestCase):
    def of(self, committed=None, **changes):
        return report.failures(result(**changes), committed or {}, BUDGETS, MACS)

    def test_none_where_all_is_well(self):
        self.assertEqual(self.of(), [])

    def test_each_requirement_has_its_own(self):
        for changes, words in (({"digest_is_golden": False}, "digest"), ({"equal_counts": False}, "depends on the frame"),
                               ({"forbidden": {"heap": ["malloc"]}}, "malloc"), ({"floating_point": ["f()"]}, "floating point"),
                               ({"instructions": 1201}, "per MAC"), ({"ram": 101}, "ram"), ({"stack": 11}, "stack")):
            with self.subTest(changes):
                wrong = self.of(**changes)
                self.assertEqual(len(wrong), 1)
                self.assertIn(words, wrong[0])

    def test_more_than_two_percent_more_is_growth(self):
        before = {"cortex-m7": {"fixed": {"instructions": 1000, "text": 50, "read_only": 50, "ram": 50, "stack": 5}}}
        self.assertEqual(self.of(before, instructions=1020), [])
        self.assertIn("grown from 1000 to 1021", self.of(before, instructions=1021)[0])
        self.assertIn("ram has grown", self.of(before, ram=52)[0])


# Verifies TS-MEM-030.
class WorstCaseStack(unittest.TestCase):
    STEP = "void fsw::AttitudeInitApp::step(int64_t, const StepInputs&, StepOutputs&)"

    def of(self, edges, nodes):
        with tempfile.TemporaryDirectory() as folder:
            text = "".join(f'node: {{ title: "{n}" label: "{label}\\n{size} bytes (static)" }}\n' for n, label, size in nodes)
            text += "".join(f'edge: {{ sourcename: "{a}" targetname: "{b}" }}\n' for a, b in edges)
            pathlib.Path(folder, "a.ci").write_text(text)
            return stack.worst_case(pathlib.Path(folder), "fixed")

    def test_is_the_deepest_path_with_pointers_to_kernels(self):
        nodes = [("step", self.STEP, 100), ("shallow", "shallow()", 50), ("conv", "kernels::convolve()", 300), ("leaf", "leaf()", 20)]
        total, path = self.of([("step", "shallow"), ("step", "__indirect_call"), ("conv", "leaf")], nodes)
        self.assertEqual(total, 420)
        self.assertEqual([name for name, _ in path], [self.STEP, "kernels::convolve()", "leaf()"])

    def test_counts_functions_without_source(self):
        total, _ = self.of([("step", "__aeabi_uldivmod")], [("step", self.STEP, 100)])
        self.assertEqual(total, 100 + stack.LIBRARY_BYTES)

    # Verifies TS-MEM-040.
    def test_refuses_recursion(self):
        with self.assertRaises(SystemExit):
            self.of([("step", "a"), ("a", "step")], [("step", self.STEP, 1), ("a", "a()", 1)])


class Stages(unittest.TestCase):
    def test_begin_and_end_a_step(self):
        self.assertEqual([name for name, _ in instruction_count.STAGES[:2]], ["application", "(end)"])


if __name__ == "__main__":
    unittest.main()
