"""Tests of the report on what llvm-cov exports: a small source whose counts are known."""
import contextlib
import io
import json
import pathlib
import tempfile
import unittest

import report

SOURCE = """bool f(bool a, bool b, bool c) {
  if (a && b) return true;
  if (kFixed) return c;
  return a || c;
}
"""
# line, column, last line, last column; times true, times false; three numbers that are not used
BRANCHES = [[2, 7, 2, 8, 3, 1, 0, 0, 6], [2, 12, 2, 13, 1, 2, 0, 0, 6], [3, 7, 3, 13, 0, 0, 0, 0, 4],
            [4, 10, 4, 11, 1, 2, 0, 0, 6], [4, 15, 4, 16, 0, 2, 0, 0, 6]]
# As llvm-cov 19 writes them: the place, a number of the file, a kind, whether each condition decides.
DECISIONS = [[2, 7, 2, 13, 0, 5, [True, True]], [4, 10, 4, 16, 0, 5, [True, False]]]
SEGMENTS = [[1, 32, 4, True, True, False], [3, 7, 3, True, True, False], [5, 2, 0, False, False, False]]


class Coverage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        (self.root / "gnc").mkdir()
        (self.root / "gnc/f.cpp").write_text(SOURCE)

    def read(self, branches=BRANCHES, decisions=DECISIONS, segments=SEGMENTS):
        file = {"filename": str(self.root / "gnc/f.cpp"), "branches": branches, "mcdc_records": decisions, "segments": segments,
                "summary": {"lines": {"count": 4, "covered": 4}}}
        return report.read(json.dumps({"data": [{"files": [file]}]}), self.root)

    def report(self, files, least=0.0, least_conditions=0.0):
        """(passed, what it prints)"""
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            passed = report.report(files, least, least_conditions)
        return passed, out.getvalue()

    def test_counts_outcomes_but_none_that_the_compiler_knows(self):
        file, = self.read()
        self.assertEqual(str(file.branches()), str(report.Count(7, 8)))
        self.assertEqual(list(file.never_taken()), ["gnc/f.cpp:4: `c` is never true"])

    def test_code_that_never_ran_is_not_known(self):
        file, = self.read(segments=[[1, 32, 0, True, True, False]])
        self.assertEqual(str(file.branches()), str(report.Count(7, 10)))

    def test_a_condition_that_decides_nowhere_is_named_and_counts(self):
        passed, text = self.report(self.read(), least_conditions=75.0)
        self.assertTrue(passed)
        self.assertIn("gnc/f.cpp:4: no test shows that `c` alone decides `a || c`", text)
        self.assertIn("75.0 % of 4 conditions", text)
        self.assertFalse(self.report(self.read(), least_conditions=76.0)[0])

    def test_without_a_decision_nothing_was_measured(self):
        self.assertFalse(self.report(self.read(decisions=[]))[0])

    def test_another_branch_inside_a_decision_is_no_condition(self):
        choice = [4, 15, 4, 15, 1, 1, 0, 0, 4]
        file, = self.read(branches=sorted([*BRANCHES, choice]))
        self.assertEqual([condition for _, _, condition in file.undecided()], ["c"])

    def test_the_instances_of_a_template_count_together(self):
        other = [*DECISIONS, [4, 10, 4, 16, 0, 5, [False, True]]]
        self.assertTrue(self.report(self.read(decisions=other), least_conditions=100.0)[0])

    def test_a_decision_of_a_macro_is_listed_and_not_counted(self):
        elsewhere = [one for one in BRANCHES if one[0] != 4]
        passed, text = self.report(self.read(branches=elsewhere), least_conditions=100.0)
        self.assertTrue(passed)
        self.assertIn("gnc/f.cpp:4: not counted", text)

    def test_too_few_branches_fail(self):
        other = [*DECISIONS, [4, 10, 4, 16, 0, 5, [False, True]]]
        self.assertTrue(self.report(self.read(decisions=other), least=87.5)[0])
        self.assertFalse(self.report(self.read(decisions=other), least=88.0)[0])


if __name__ == "__main__":
    unittest.main()
