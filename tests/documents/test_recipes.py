"""Applies the recipes of docs/contributing.md to a copy of the tree: each addition must do with the files that its recipe names.
What a recipe says does not compile must not compile."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("TUMBLESIGHT_BUILD", ROOT / "build/test"))  # for what is generated there
COPIED = ("gnc", "fsw/app", "fsw/c", "fsw/config", "hal", "sim/host", "sim/world", "docs/contributing.md", "docs/icd.md", "tests/documents")
COMPILER = ["g++", "-std=c++17", "-O0", "-fsyntax-only", "-DTUMBLESIGHT_FLOAT32=1", "-DTUMBLESIGHT_APP_FLOAT32=0",
            '-DTUMBLESIGHT_VERSION="0"', "-isystem", "/usr/include/eigen3"]


class Recipe(unittest.TestCase):
    """A test names its recipe, edits files of the copy and says what holds then."""
    section = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        for name in COPIED:
            source, copy = ROOT / name, cls.root / name
            copy.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, copy, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, copy)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.before = {}
        text = (ROOT / "docs/contributing.md").read_text(encoding="utf-8")
        self.recipe = re.search(rf"\n### {re.escape(self.section)}\n(.*?)(?=\n##)", text, re.DOTALL).group(1)

    def tearDown(self):
        for path, text in self.before.items():
            path.write_text(text, encoding="utf-8")

    def edit(self, name, old, new):
        """Replaces the last `old` of a file that the recipe names."""
        said = [one for one in re.findall(r"`([\w./<>]+)`", self.recipe) if "." in one]
        fits = any(re.fullmatch(re.sub(r"<\w+>", r"\\w+", re.escape(one).replace(r"\<", "<").replace(r"\>", ">")), name)
                   or name.endswith("/" + one) for one in said)
        self.assertTrue(fits, f"the recipe '{self.section}' does not name {name}, but: {', '.join(said)}")
        path = self.root / name
        text = path.read_text(encoding="utf-8")
        self.assertIn(old, text, name)
        self.before.setdefault(path, text)
        before, after = text.rsplit(old, 1)
        path.write_text(before + new + after, encoding="utf-8")

    def compiles(self, name):
        """(whether it does, what the compiler says)"""
        run = subprocess.run([*COMPILER, f"-I{self.root}", f"-I{BUILD}", "-Werror=switch", str(self.root / name)], capture_output=True, text=True)
        return run.returncode == 0, run.stderr

    def expect_compiles(self, name):
        good, says = self.compiles(name)
        self.assertTrue(good, says)

    def expect_refused(self, name, because):
        good, says = self.compiles(name)
        self.assertFalse(good, f"{name} compiles without the rest of the recipe")
        self.assertIn(because, says)

    def script(self, name, *options):
        """(exit status, what it prints)"""
        run = subprocess.run([sys.executable, "-B", str(self.root / "tests/documents" / name), *options], capture_output=True, text=True)
        return run.returncode, run.stdout + run.stderr

    def expect_documented(self, *words):
        page = self.root / "docs/icd.md"
        self.before.setdefault(page, page.read_text(encoding="utf-8"))
        self.assertNotEqual(self.script("icd.py")[0], 0, "a table of the interface document is out of date")
        self.assertEqual(self.script("icd.py", "--write"), (0, ""))
        missing = [word for word in words if word not in page.read_text(encoding="utf-8")]
        self.assertEqual(missing, [], "not in docs/icd.md")


class Telecommand(Recipe):
    section = "A telecommand"

    def test_is_a_row_and_a_handler(self):
        self.edit("hal/messages/telecommands.inc", "TUMBLESIGHT_TELECOMMAND(16,",
                  'TUMBLESIGHT_TELECOMMAND(17, Blink, kInSafe, TUMBLESIGHT_NUMBER(times, 1, 1, 9, "how often"))\nTUMBLESIGHT_TELECOMMAND(16,')
        self.expect_refused("fsw/app/commands.cpp", "kBlink")
        self.edit("fsw/app/commands.cpp", "using Handler = ",
                  "bool blink(const Telecommand&, const CommandContext&, Refusal&) {\n  return true;\n}\n\nusing Handler = ")
        self.edit("fsw/app/commands.cpp", "    case FunctionCode::kNoop:", "    case FunctionCode::kBlink:\n      return blink;\n    case FunctionCode::kNoop:")
        self.expect_compiles("fsw/app/commands.cpp")
        self.expect_documented("BLINK", "how often")
        database = self.root / "x.xml"
        self.assertEqual(self.script("xtce.py", "--write", str(database)), (0, ""))
        self.assertIn("BLINK", database.read_text(encoding="utf-8").upper())


class Parameter(Recipe):
    section = "A parameter"

    def test_is_a_row(self):
        row = "TUMBLESIGHT_PARAMETER(LongestWithoutChaser_ms,"
        self.edit("fsw/config/parameters.inc", row, "TUMBLESIGHT_PARAMETER(Patience_ms, 1, 9, 5)  // how long it waits\n" + row)
        self.expect_compiles("fsw/app/parameter_table.cpp")
        self.expect_refused("fsw/c/parameters.cpp", "a parameter is missing here")
        self.edit("fsw/c/tumblesight_c.h", "  uint32_t longest_without_chaser_ms;", "  uint32_t patience_ms;\n  uint32_t longest_without_chaser_ms;")
        self.edit("fsw/c/parameters.cpp", "    &tumblesight_parameters::longest_without_chaser_ms,",
                  "    &tumblesight_parameters::patience_ms,\n    &tumblesight_parameters::longest_without_chaser_ms,")
        self.expect_compiles("fsw/c/parameters.cpp")
        self.expect_documented("Patience_ms", "how long it waits")


class TelemetryField(Recipe):
    section = "A telemetry field"

    def test_is_a_member_and_a_field_of_the_topic(self):
        member = "  std::uint32_t inference_max_us = 0;\n"
        self.edit("hal/messages/telemetry.hpp", member, member + "  std::uint32_t blinks = 0;  // since the start\n")
        status, says = self.script("icd.py", "--messages")
        self.assertNotEqual(status, 0)
        self.assertIn("blinks", says)
        self.edit("hal/dds/idl/tumblesight.idl", "  unsigned long inference_max_us;\n",
                  "  unsigned long inference_max_us;\n  unsigned long blinks;\n")
        self.assertEqual(self.script("icd.py", "--messages")[0], 0)
        self.edit("fsw/c/tumblesight_c.h", "  uint32_t inference_max_us;", "  uint32_t inference_max_us;\n  uint32_t blinks;")
        self.expect_documented("`blinks`", "since the start")


class Event(Recipe):
    section = "An event"

    def test_is_a_row(self):
        row = "TUMBLESIGHT_EVENT(KeyActivated,"
        self.edit("hal/messages/events.inc", row, 'TUMBLESIGHT_EVENT(Blinked, 120, Information, "blinked")  // [times, -, -]\n' + row)
        self.expect_compiles("hal/messages/event_text.hpp")
        self.expect_documented("| 120 | information | BLINKED | times")


class MemberOfTheState(Recipe):
    section = "A member of the application's state"

    def test_does_not_compile_until_the_digest_knows_it(self):
        self.edit("fsw/app/app_state.hpp", "  bool boot_to_report = false;", "  std::uint32_t blinks = 0;\n  bool boot_to_report = false;")
        self.expect_refused("fsw/app/state_digest.cpp", "names provided")


class Condition(Recipe):
    section = "A condition"

    def test_is_an_enumerator_and_a_row(self):
        name = "sim/world/scenario/condition.hpp"
        self.edit(name, "kApproach };", "kApproach, kSlow };")
        self.edit(name, "};\n// clang-format on", '    {Condition::kSlow, "slow", "it hardly turns", kPaperSensor,\n     RotationModel::kConstantRate, 1.0, false, 0.0, '
                  "false,\n     kNotTrained, false, false, kNoTarget},\n};\n// clang-format on")
        self.expect_compiles("sim/world/scenario/condition.cpp")


class Disturbance(Recipe):
    section = "A disturbance"

    def test_is_a_member_and_a_row(self):
        name = "sim/world/scenario/disturbance.hpp"
        self.edit(name, "struct Disturbances {\n", "struct Disturbances {\n  int blinks = 0;\n")
        self.edit(name, "};\n// clang-format on", '    disturbance_row<&Disturbances::blinks>("blinks", "N", "N frames are dark", '
                  "DisturbanceKind::kWholeNumber, 0, 9),\n};\n// clang-format on")
        self.expect_compiles("sim/world/scenario/disturbance.cpp")


class Effect(Recipe):
    section = "A sensor effect"

    def test_is_a_strength_a_row_and_a_function(self):
        arguments = "(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid)"
        self.edit("sim/world/sensor/effects.hpp", "struct Effects {\n", "struct Effects {\n  double fog = 0.0;\n")
        self.edit("sim/world/sensor/effects.cpp", '      {"rays", &Effects::rays,',
                  '      {"fog", &Effects::fog, "1/m", 0.001, 1, "light is lost on the way", "Beer and Lambert", add_fog},\n      {"rays", &Effects::rays,')
        self.edit("sim/world/sensor/effect_functions.hpp", "void add_plume(", f"void add_fog{arguments};\nvoid add_plume(")
        self.expect_compiles("sim/world/sensor/effects.cpp")


class Page(unittest.TestCase):
    def test_every_file_that_it_names_exists(self):
        text = (ROOT / "docs/contributing.md").read_text(encoding="utf-8")
        names = set(re.findall(r"`((?:gnc|fsw|hal|sim|tests|docs|cmake|toolchains)/[\w./]+\.\w+)`", text))
        self.assertGreater(len(names), 40)
        self.assertEqual([name for name in sorted(names) if not (ROOT / name).exists()], [])

    def test_every_addition_of_the_table_has_its_section(self):
        text = (ROOT / "docs/contributing.md").read_text(encoding="utf-8")
        anchors = set(re.findall(r"\]\(#([\w-]+)\)", text))
        sections = {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in re.findall(r"\n##+ (.*)", text)}
        self.assertEqual(anchors - sections, set())


del Recipe  # no test of its own


if __name__ == "__main__":
    unittest.main()
