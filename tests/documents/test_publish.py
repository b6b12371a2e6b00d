"""fsw/models/publish: its tables, its marks, and what it says to wrong input."""
import contextlib
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from load_script import loaded

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "fsw/models/publish"


def row(condition, mean_deg, pose=None, **others):
    return {"target": "magellan", "model": "magellan", "mesh": "magellan.stl", "condition": condition, "effect": None,
            "disturbances": {}, "rcnn": {"mean_deg": mean_deg, "within_20deg": 0.999}, "pose": pose,
            "paper_rcnn": {"mean_deg": 3.99, "within_20deg": 0.99}, **others}


class Tables(unittest.TestCase):
    def setUp(self):
        self.publish = loaded(SCRIPT)

    def test_accuracy_takes_the_mesh_file_and_leaves_out_effects_ranges_and_disturbed_runs(self):
        pose = {"mean_within_20_deg": 0.061, "within_20deg": 1.0}
        rows = [row(c, 90.0, mesh="parametric") for c in self.publish.CONDITIONS]
        rows += [row("nominal", 80.0, effect="plume=0.05"), row("nominal", 70.0, disturbances={"lost-frames": 1})]
        rows += [row(c, 1.16, pose) for c in self.publish.CONDITIONS]
        rows.append(row("nominal", 60.0, ranges_m=[10.0, 12.0], paper_rcnn=None))
        table = self.publish.accuracy_table(rows).splitlines()
        self.assertEqual(table[2], "| **Magellan** | " + " | ".join(["**1.16°**, 99.9 %"] * 4) + " |")
        self.assertEqual(table[3], "| with registration | " + " | ".join(["**0.06°**, 100.0 %"] * 4) + " |")
        self.assertEqual(table[4], "| the paper | " + " | ".join(["3.99°, 99 %"] * 4) + " |")
        self.assertEqual(len(table), 5)

    def test_summary_has_the_nominal_means_of_paper_network_and_pose(self):
        pose = {"mean_within_20_deg": 0.061, "within_20deg": 1.0}
        rows = [row(c, 1.16, pose) for c in self.publish.CONDITIONS] + [row("nominal", 80.0, pose, effect="plume=0.05")]
        self.assertEqual(self.publish.summary_table(rows).splitlines()[2:], ["| Magellan | 3.99° | 1.16° | 0.06° |"])
        self.assertEqual(len(self.publish.summary_table([row("nominal", 1.16)]).splitlines()), 2)

    def test_figures_of_the_tree_are_those_of_its_document(self):
        begin, end = (self.publish.MARK.format("figures", word) for word in ("begin", "end"))
        text = self.publish.README.read_text()
        between = text[text.index(begin) + len(begin):text.index(end)].strip()
        self.assertEqual(between, self.publish.figures_table(self.publish.HERE))

    def test_text_is_put_between_the_marks_and_nowhere_else(self):
        begin, end = (self.publish.MARK.format("figures", word) for word in ("begin", "end"))
        with tempfile.TemporaryDirectory(dir=self.publish.ROOT / "tests") as folder:
            path = pathlib.Path(folder) / "page.md"
            path.write_text(f"before\n{begin}\nold\n{end}\nafter\n")
            with contextlib.redirect_stdout(io.StringIO()):
                self.publish.replace_between_marks(path, "figures", "new")
            self.assertEqual(path.read_text(), f"before\n{begin}\nnew\n{end}\nafter\n")
            path.write_text(f"{end}\n{begin}\n")
            with self.assertRaises(SystemExit):
                self.publish.replace_between_marks(path, "figures", "new")

    def test_documents_have_their_marks_once(self):
        for path, name in ((self.publish.README, "figures"), (self.publish.EVIDENCE, "accuracy"),
                           (self.publish.MAIN_README, "accuracy")):
            for word in ("begin", "end"):
                self.assertEqual(path.read_text().count(self.publish.MARK.format(name, word)), 1, path)


class Arguments(unittest.TestCase):
    def output(self, *arguments):
        done = subprocess.run([sys.executable, "-B", SCRIPT, *arguments], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def test_help_names_every_step(self):
        status, text = self.output("--help")
        self.assertEqual(status, 0)
        for step in loaded(SCRIPT).STEPS:
            self.assertIn(f"\n    {step} ", text)

    def test_an_unknown_step_is_named_with_those_that_exist(self):
        status, text = self.output("--only", "images,nothing")
        self.assertNotEqual(status, 0)
        self.assertIn("unknown step 'nothing'; the steps are: images, figures", text)

    def test_a_folder_without_images_is_named_and_nothing_is_copied(self):
        publish = loaded(SCRIPT)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            (path / "magellan.float32.tsm").write_bytes(b"x")
            with self.assertRaises(SystemExit) as ended:
                publish.images([path], None)
            self.assertIn("magellan.tsm is missing", str(ended.exception))
        with self.assertRaises(SystemExit) as ended:
            publish.images([], None)
        self.assertIn("needs the folders of the trainings", str(ended.exception))


if __name__ == "__main__":
    unittest.main()
