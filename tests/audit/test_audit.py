"""Tests of the audit itself. Run by ctest; alone: python3 -m unittest discover tests/audit"""
import csv
import pathlib
import re
import tempfile
import unittest

import audit
import network_layers
import processors
import report
import stack
import step_counts

MACS = 1000
BUDGETS = {"ram": 100, "stack": 10, "text": 100, "read_only": 100}
PROCESSOR = processors.by_name("cortex-m7")
TITLES = [limit.model.title for limit in PROCESSOR.limits]


def result(**changes):
    good = {"digest": "0", "digest_is_golden": True, "equal_counts": True, "unequal": {}, "forbidden": {}, "floating_point": [],
            "instructions": 1000, "cycles": {title: 1200 for title in TITLES}, "longest_steps": {},
            "longest_cycles": {title: {} for title in TITLES}, "registration_cycles": {title: {} for title in TITLES},
            "cycles_beside": {title: {} for title in TITLES}, "text": 50, "read_only": 50, "ram": 50, "stack": 5, "cfs_app": {}}
    return [(PROCESSOR, "fixed", {**good, **changes})]


# Verifies TS-TIM-050.
class Failures(unittest.TestCase):
    def of(self, committed=None, **changes):
        return report.failures(result(**changes), committed or {}, BUDGETS, MACS)

    def test_none_for_good_figures(self):
        self.assertEqual(self.of(), [])

    def test_each_limit_is_reported(self):
        for changes, words in (({"digest_is_golden": False}, "digest"), ({"equal_counts": False}, "depends on the frame"),
                               ({"forbidden": {"heap": ["malloc"]}}, "malloc"), ({"floating_point": ["f()"]}, "floating point"),
                               ({"instructions": 80_000_001}, "per step"), ({"ram": 101}, "ram"), ({"stack": 11}, "stack"),
                               ({"cfs_app": {"text": report.CFS_APP_LIMITS["text"] + 1}}, "text of the cFS app")):
            with self.subTest(changes):
                wrong = self.of(**changes)
                self.assertEqual(len(wrong), 1)
                self.assertIn(words, wrong[0])

    def test_every_step_is_limited_by_each_model(self):
        for limit in PROCESSOR.limits:
            most = round(limit.step * report.PERIOD_S * PROCESSOR.clock_mhz * 1e6)
            others = {title: 0 for title in TITLES}
            self.assertEqual(self.of(cycles={**others, limit.model.title: most}), [])
            self.assertIn(f"{limit.model.title}: a step", self.of(cycles={**others, limit.model.title: most + most // 100})[0])

    def test_every_longest_step_is_limited(self):
        limit = PROCESSOR.limits[0]
        most = round(limit.longest_step * report.PERIOD_S * PROCESSOR.clock_mhz * 1e6)
        more = most + most // 100
        others = {title: {} for title in TITLES}
        self.assertEqual(self.of(longest_cycles={**others, limit.model.title: {"frame": most, "boot": more}}), [])
        for name in ("frame, commands", "table rebuilt", "model activated"):
            self.assertIn(f"'{name}'", self.of(longest_cycles={**others, limit.model.title: {"boot": 1, name: more}})[0])

    # Verifies TS-TIM-120.
    def test_the_bound_of_a_step_is_limited_and_registration_by_its_budget(self):
        leon3, budget = processors.by_name("leon3"), report.registration_budget()
        slow, fast = (limit.model.title for limit in leon3.limits)
        self.assertEqual(slow, report.BUDGETED_MODEL)
        def of(registration, beside):
            figures = {"cycles": {slow: 1, fast: 1}, "longest_cycles": {slow: {"frame": 1}, fast: {"frame": 1}},
                       "registration_cycles": {slow: {"frame": registration, "table rebuilt": 0}, fast: {"frame": 300, "table rebuilt": 0}},
                       "cycles_beside": {slow: {"frame": beside, "table rebuilt": 9000}, fast: {"frame": 200, "table rebuilt": 9000}}}
            return [(leon3, "fixed", {**result()[0][2], **figures})]

        most = budget * 9 // 10
        self.assertEqual(report.bounds(of(400, 600)), {slow: 600 + budget, fast: 200 + round(0.75 * budget)})
        self.assertEqual(report.bounds(result()), {}, "without LEON3")
        self.assertEqual(report.failures(of(most, 600), {}, BUDGETS, MACS), [])
        self.assertIn("not the worst any more", report.failures(of(budget // 2, 600), {}, BUDGETS, MACS)[0])
        beside = round(leon3.limits[0].longest_step * report.PERIOD_S * leon3.clock_mhz * 1e6)
        self.assertIn("the bound of a step", report.failures(of(most, beside), {}, BUDGETS, MACS)[0])
        self.assertIn("registration takes", report.failures(of(budget + 1, 600), {}, BUDGETS, MACS)[-1])

    def test_growth_of_a_longest_step_is_reported(self):
        before = {"cortex-m7": {"fixed": {"longest_steps": {"table rebuilt": 1000}, "instructions": 1000, "text": 50, "read_only": 50,
                                          "ram": 50, "stack": 5}}}
        self.assertIn("'table rebuilt' has grown", self.of(before, longest_steps={"table rebuilt": 1021})[0])

    def test_growth_of_more_than_two_percent_is_reported(self):
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

    def test_is_the_deepest_path_including_calls_through_pointers(self):
        nodes = [("step", self.STEP, 100), ("shallow", "shallow()", 50), ("conv", "kernels::convolve()", 300), ("leaf", "leaf()", 20)]
        total, path = self.of([("step", "shallow"), ("step", "__indirect_call"), ("conv", "leaf")], nodes)
        self.assertEqual(total, 420)
        self.assertEqual([name for name, _ in path], [self.STEP, "kernels::convolve()", "leaf()"])

    def test_inline_function_is_one_node_in_every_file(self):
        name = "_ZN11tumblesight3gnc7reciprocalEv"
        nodes = [("step", self.STEP, 100), (f"../a.cpp:{name}", "reciprocal()", 40)]
        total, _ = self.of([("step", f"/build/b.cpp:{name}")], nodes)
        self.assertEqual(total, 140)

    def test_counts_functions_without_a_call_graph(self):
        total, _ = self.of([("step", "__aeabi_uldivmod")], [("step", self.STEP, 100)])
        self.assertEqual(total, 100 + stack.LIBRARY_BYTES)

    # An audit after the tests of a processor failed: they build the C interface, whose stopwatch calls through a pointer.
    def test_leaves_out_the_c_interface(self):
        with tempfile.TemporaryDirectory() as folder:
            for library, text in (("fsw_app.dir", f'node: {{ title: "step" label: "{self.STEP}\\n100 bytes (static)" }}\n'
                                                  'edge: { sourcename: "step" targetname: "__indirect_call" }\n'),
                                  ("fsw_c.dir", 'node: { title: "clock" label: "CallerStopwatch::now_ns()\\n900 bytes (static)" }\n'
                                                'edge: { sourcename: "clock" targetname: "__indirect_call" }\n')):
                pathlib.Path(folder, library).mkdir()
                pathlib.Path(folder, library, "a.ci").write_text(text)
            self.assertEqual(stack.worst_case(pathlib.Path(folder), "fixed")[0], 100)

    # The deadline of registration looks at the stopwatch: two calls through pointers, one below the other.
    def test_only_the_work_budget_reaches_the_deadline(self):
        nodes = [("step", self.STEP, 100), ("conv", "kernels::convolve()", 300), ("look", "void gnc::WorkBudget::look_at_deadline()", 30),
                 ("passed", "virtual bool fsw::CycleDeadline::has_passed()", 40), ("clock", "BoardStopwatch::now_ns()", 500)]
        edges = [("step", "look"), ("look", "__indirect_call"), ("passed", "__indirect_call")]
        total, path = self.of(edges, nodes)
        self.assertEqual(total, 100 + 30 + 40 + 500)
        self.assertEqual([name for name, _ in path][-1], "BoardStopwatch::now_ns()")
        self.assertEqual(self.of([("step", "__indirect_call"), ("passed", "__indirect_call")], nodes)[0], 100 + 500)

    # Verifies TS-MEM-040.
    def test_refuses_recursion(self):
        with self.assertRaises(SystemExit):
            self.of([("step", "a"), ("a", "step")], [("step", self.STEP, 1), ("a", "a()", 1)])


class Stages(unittest.TestCase):
    def test_first_two_begin_and_end_a_step(self):
        self.assertEqual([name for name, _ in step_counts.stages()[:2]], ["application", "(end)"])

    def test_every_layer_of_the_cnn_is_one(self):
        cnn = [layer for layer in network_layers.layers() if layer.part == "cnn"]
        names = [name for name, _ in step_counts.stages()]
        first = names.index("space to depth") + 1
        self.assertEqual(names[first:first + len(cnn)], [layer.name for layer in cnn[:-1]] + ["single-frame head"])

    def test_a_layer_is_recognized_in_either_numerics(self):
        layer = network_layers.Layer("cnn", "x", 1, "a::Dense<a::FixedPoint, 3, 4>")
        for symbol in ("a::Dense<a::FixedPoint, 3, 4>::hidden(", "a::Dense<a::Float32, 3, 4>::output("):
            self.assertRegex(symbol, network_layers.function(layer))
        self.assertNotRegex("a::Dense<a::Float32, 3, 40>::output(", network_layers.function(layer))


class Processors(unittest.TestCase):
    def test_each_has_a_preset_and_a_toolchain_file(self):
        names = [processor.name for processor in processors.ALL]
        self.assertEqual(names, list(processors.presets()))
        toolchains = {path.stem for path in (processors.ROOT / "toolchains").glob("*.cmake")
                      if re.search(r"CMAKE_CROSSCOMPILING_EMULATOR", path.read_text())}
        self.assertEqual(set(names), toolchains)

    def test_title_and_numerics_are_those_of_the_preset(self):
        self.assertEqual(PROCESSOR.title, "Cortex-M7, bare metal")
        self.assertFalse(PROCESSOR.float32)
        self.assertTrue(processors.by_name("leon3").float32)

    def test_unknown_name_is_refused(self):
        with self.assertRaisesRegex(SystemExit, "cortex-a53"):
            processors.by_name("z80")


class Documents(unittest.TestCase):
    FIGURES = {"set": "portable", "stages": {"application": 400, "conv1": 600}, "longest_steps": {"frame": 1500},
               "longest_cycles": {title: {"frame": 2000} for title in TITLES},
               "registration_cycles": {title: {"frame": 1000} for title in TITLES},
               "cycles_beside": {title: {"frame": 1000} for title in TITLES}}

    def test_table_of_the_readme_is_replaced_between_its_marks(self):
        text = f"before\n{report.BEGIN}\nold\n{report.END}\nafter\n"
        self.assertEqual(report.with_table(text, "new"), f"before\n{report.BEGIN}\nnew\n{report.END}\nafter\n")

    def test_missing_mark_is_refused(self):
        with self.assertRaises(SystemExit):
            report.with_table(f"{report.END}\n{report.BEGIN}\n", "new")

    # The audit had let the code grow beyond the 156 KiB that the requirement allowed.
    def test_budgets_are_those_of_the_requirements(self):
        with open(processors.ROOT / "docs/requirements.csv", newline="") as file:
            texts = {row[0]: row[1] for row in csv.reader(file)}
        for number, words, kib in (("TS-MEM-060", " KiB of RAM", audit.BUDGETS["ram"]), ("TS-MEM-060", " KiB of code", audit.BUDGETS["text"]),
                                   ("TS-MEM-060", " KiB of constants", audit.BUDGETS["read_only"]),
                                   ("TS-MEM-030", " KiB of stack", audit.BUDGETS["stack"])):
            self.assertIn(f"{kib / 1024:g}{words}", texts[number])

    def test_readme_has_the_marks(self):
        report.with_table((processors.ROOT / "README.md").read_text(), "new")

    def test_document_and_summary_name_every_processor(self):
        results = result(**self.FIGURES, cfs_app={"text": 4321, "data": 1, "banks": 2})
        for text in (report.as_document(results, MACS, BUDGETS, "of x", 1_000_000, "20 frames"), report.as_summary(results, MACS)):
            self.assertIn("| Cortex-M7, bare metal", text)
        self.assertIn("| Cortex-M7, bare metal | 4 321 |", report.as_document(results, MACS, BUDGETS, "of x", 1_000_000, "20 frames"))


if __name__ == "__main__":
    unittest.main()
