"""Tests of the requirements check: it fails when it should. Run by ctest, or by hand: python3 -m unittest discover tests/documents"""
import contextlib
import io
import pathlib
import tempfile
import unittest

import check_requirements as check

HEADER = "id,text,rationale,verification\n"
ROW = "TS-NUM-010,The component shall add.,Sums.,T\n"
CPP = '#include "a.hpp"\n\n// Verifies TS-NUM-010.\nTEST(Sum, IsRight) {\n}\n'


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.put("docs/requirements.csv", HEADER + ROW)
        self.put("tests/unit/sum_test.cpp", CPP)

    def put(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def run_check(self, *options):
        """(exit status, lines printed)"""
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            status = check.main(["--root", str(self.root), *options])
        return status, out.getvalue().splitlines()

    def page(self):
        return (self.root / "verification.md").read_text(encoding="utf-8")

    def expect_good(self):
        self.assertEqual(self.run_check("--write", str(self.root / "verification.md")), (0, []))
        self.assertEqual(self.run_check(), (0, []))

    def expect_one(self, *words):
        status, lines = self.run_check()
        self.assertEqual(status, 1)
        self.assertEqual(len(lines), 1, lines)
        for word in words:
            self.assertIn(word, lines[0])


class Table(Tree):
    def test_good_one_passes(self):
        self.expect_good()

    def test_other_columns(self):
        self.put("docs/requirements.csv", "id,text\n" + ROW)
        self.put("tests/unit/sum_test.cpp", "")
        self.expect_one("docs/requirements.csv:1", "columns")

    def test_malformed_rows(self):
        for row, word in (("TS-NUM-020,The component shall add.,T\n", "3 fields"), ("TS-NUM-20,The component shall add.,Sums.,T\n", "'TS-NUM-20'"),
                          ("TS-XYZ-020,The component shall add.,Sums.,T\n", "'TS-XYZ-020'"), (ROW, "TS-NUM-010 is in the table twice"),
                          ("TS-NUM-020,The component adds.,Sums.,T\n", "'shall'"), ("TS-NUM-020,The component shall add,Sums.,T\n", "sentence"),
                          ("TS-NUM-020,The component shall add.,,T\n", "no rationale"),
                          ("TS-NUM-020,The component shall add.,Sums.,test\n", "verification is 'test'")):
            with self.subTest(row):
                self.put("docs/requirements.csv", HEADER + ROW + row)
                self.expect_one("docs/requirements.csv:3", word)


class Tests(Tree):
    def test_no_test_names_a_requirement(self):
        self.put("tests/unit/sum_test.cpp", CPP.replace("// Verifies TS-NUM-010.\n", ""))
        self.expect_one("no test names TS-NUM-010")

    def test_a_script_of_the_audit_is_not_a_test(self):
        self.put("tests/unit/sum_test.cpp", "")
        self.put("tests/audit/audit.py", "# Verifies TS-NUM-010.\n")
        self.expect_one("no test names TS-NUM-010")

    def test_a_test_names_an_id_that_is_not_there(self):
        self.put("tests/run", "#!/bin/sh\n# Verifies TS-NUM-020.\n")
        self.expect_one("tests/run:2", "no requirement TS-NUM-020")

    def test_a_test_names_something_that_is_not_an_id(self):
        for words in ("TS-NUM-10", "TS-NUM-010 TS-NUM-020", "TS-NUM-010,", "it all", ""):
            with self.subTest(words):
                self.put("tests/other_test.cpp", f"// Verifies {words}.\n")
                self.expect_one("tests/other_test.cpp:1", "is not an id")

    def test_a_claim_in_the_middle_of_a_comment(self):
        for line in ("// Why. Verifies TS-NUM-010.", "int a;  // Verifies TS-NUM-010.", '"""Words. Verifies TS-NUM-010."""'):
            with self.subTest(line):
                self.put("tests/other_test.cpp", line + "\n")
                self.expect_one("tests/other_test.cpp:1", "put it on a line of its own")

    def test_a_comment_above_something_else(self):
        self.put("tests/unit/sum_test.cpp", CPP.replace("TEST(Sum, IsRight)", "class Sum"))
        self.expect_one("tests/unit/sum_test.cpp:3", "neither above a test nor at the file's head")


class Others(Tree):
    def put_row(self, verification, rationale="Sums."):
        self.put("docs/requirements.csv", HEADER + f"TS-NUM-010,The component shall add.,{rationale},{verification}\n")

    def test_nothing_names_an_analysis(self):
        self.put_row("A")
        self.expect_one("neither a script of tests/audit nor a document names TS-NUM-010")

    def test_a_script_or_a_document_names_an_analysis(self):
        for name, text in (("tests/audit/audit.py", "import a\n# Verifies TS-NUM-010.\nLIMIT = 1\n"), ("docs/sums.md", "Right (TS-NUM-010).\n")):
            with self.subTest(name):
                self.put_row("A")
                self.put(name, text)
                self.expect_good()
                self.assertIn(f"({check.link(name)})", self.page())
                (self.root / name).unlink()

    def test_a_document_names_an_id_that_is_not_there(self):
        self.put("docs/sums.md", "TS-NUM-020\n")
        self.expect_one("docs/sums.md", "no requirement TS-NUM-020")

    def test_an_inspection_names_a_file_that_is_there(self):
        self.put_row("I")
        self.expect_one("TS-NUM-010 names no file to inspect")
        self.put_row("I", "See docs/sums.md.")
        self.expect_one("TS-NUM-010 names no file to inspect")
        self.put("docs/sums.md", "")
        self.expect_good()
        self.assertIn("[docs/sums.md](sums.md)", self.page())


class Page(Tree):
    def test_names_every_kind_of_test(self):
        self.put("tests/unit/sum_test.cpp", "// Verifies TS-NUM-010.\n#ifdef A\n// Why.\n// Verifies TS-NUM-010,\n// TS-NUM-010. And more.\nTEST_F(Sum, A) {}\n"
                 "// Verifies TS-NUM-010.\n// Behind it.\nTYPED_TEST(SumOf, B) {}\n// Verifies TS-NUM-010.\nINSTANTIATE_TEST_SUITE_P(\n    All, Sums, x);\n")
        self.put("tests/CMakeLists.txt", "foreach(x)\n  # Verifies TS-NUM-010.\n  add_test(NAME Sum.Of_${x} COMMAND y)\n")
        self.put("tests/audit/test_audit.py", '"""Words."""\nimport a\n\n\nclass Cases(a.B):\n    # Verifies TS-NUM-010.\n    def test_c(self):\n')
        self.expect_good()
        for name in ("[sum_test.cpp]", "[Sum.A]", "[SumOf.B]", "[All/Sums]", "[Sum.Of_…]", "[Cases.test_c](../tests/audit/test_audit.py)"):
            self.assertIn(name, self.page())
        self.assertEqual(self.page().count("[Sum.A]"), 1)

    def test_escapes_bars(self):
        self.put("docs/requirements.csv", HEADER + ROW.replace("add", "compute |x|"))
        self.expect_good()
        self.assertIn("compute \\|x\\|.", self.page())


if __name__ == "__main__":
    unittest.main()
