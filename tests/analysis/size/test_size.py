"""size.py: what it counts, and that the table has every folder and adds up."""
import pathlib
import subprocess
import tempfile
import unittest

import size


class Sizes(unittest.TestCase):
    def test_count_lines_of_code_and_all_files_that_git_keeps(self):
        with tempfile.TemporaryDirectory() as place:
            root = pathlib.Path(place)
            for path, text in {"gnc/nn/lstm.cpp": "a\nb\n", "gnc/nn/kernels/avx2.cpp": "a\n", "gnc/README.md": "x\n",
                               "CMakeLists.txt": "a\nb\nc\n", "tests/run": "a\n", "gnc/nn/not_kept.cpp": "a\n"}.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text)
            subprocess.run(["git", "init", "-q"], cwd=root, check=True)
            subprocess.run(["git", "add", "gnc/nn/lstm.cpp", "gnc/nn/kernels", "gnc/README.md", "CMakeLists.txt", "tests"],
                           cwd=root, check=True)
            found = size.sizes(root)
        self.assertEqual(found, {"gnc/nn": (2, 3), "gnc": (1, 0), ".": (1, 3), "tests": (1, 1)})
        self.assertEqual(size.totals(found), {"product": (4, 6), "tests": (1, 1)})

    def test_table_has_what_is_new_and_what_is_gone(self):
        lines = size.table({"gnc": (2, 1500)}, {"sim": (1, 10)})
        self.assertEqual([" ".join(line.split()) for line in lines],
                         ["gnc 1,500 lines +1,500 2 files +2", "sim 0 lines -10 0 files -1"])

    def test_the_release_is_read_and_the_tree_counted(self):
        if not (size.ROOT / ".git").exists():
            self.skipTest("no git repository")
        now, before = size.sizes(size.ROOT), size.read_release()
        for folder in ("gnc/nn", "sim/world", "tests/unit"):
            self.assertGreater(now[folder][1], 100, folder)
            self.assertGreater(before[folder][1], 100, folder)
        print("\n" + "\n".join(size.table(now, before) + size.table(size.totals(now), size.totals(before))))


if __name__ == "__main__":
    unittest.main()
