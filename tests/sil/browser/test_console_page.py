"""The console's page in a browser: a run while it goes on, and a recording of one. Verifies TS-SIL-195.

Usage: test_console_page.py TUMBLESIGHT [FOLDER]     FOLDER keeps the screenshots
"""

import collections
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

import browser

SEQUENCES = 30
FRAMES = 10
STEPS = SEQUENCES * FRAMES
DOMAIN = "213"  # that no other run takes by itself


class Console:
    """`tumblesight console` with these arguments, and its address."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen([TUMBLESIGHT, "console", "--port", "0", *arguments], stdout=subprocess.PIPE,
                                        stdin=subprocess.DEVNULL, text=True)
        for line in self.process.stdout:
            found = re.search(r"http://127\.0\.0\.1:\d+/\?token=\w+", line)
            if found:
                self.address = found.group(0)
                return
        raise RuntimeError(f"no address; the console ended with {self.process.wait()}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=20)
        self.process.stdout.close()


def simulate(*arguments):
    return subprocess.Popen([TUMBLESIGHT, "simulate", "--sequences", str(SEQUENCES), "--report", str(FOLDER / "report.html"), *arguments],
                            stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)


def state(page, name):
    return page.value_of(f"console_state().{name}")


class Page(unittest.TestCase):
    def check_view(self, page, name):
        """The 3-D view shows something: many colours beside its background."""
        rows = page.screenshot(FOLDER / f"{name}_view.png", "[data-testid=view-3d] canvas")
        colours = collections.Counter(pixel for row in rows for pixel in row)
        pixels = sum(colours.values())
        self.assertGreater(len(colours), 100, "the view is empty")
        self.assertGreater(1 - colours.most_common(1)[0][1] / pixels, 0.01, "less than 1 % of the view is drawn")
        page.screenshot(FOLDER / f"{name}.png")

    def test_a_live_run_is_followed_to_its_end(self):
        with Console("--domain", DOMAIN) as console, browser.Browser(console.address) as page:
            page.wait_for("window.console_state && console_state().connected")
            run = simulate("--speed", "100", "--domain", DOMAIN)
            page.wait_for("console_state().steps > 20 && console_state().points > 100")
            self.assertTrue(state(page, "following"))
            seen = [page.wait_for(f"console_state().selected >= {step} && console_state()") for step in (40, 80, 120)]
            errors = {state_then["pose_error_deg"] for state_then in seen}
            self.assertGreater(len(errors), 1, "the estimate does not move")
            self.assertLess(min(errors), 1.0)
            self.check_view(page, "live")
            self.assertEqual(run.wait(timeout=120), 0)
            last = page.wait_for("document.body.innerText.includes('ended') && console_state()")
            self.assertEqual(last["selected"], last["steps"] - 1)
            self.assertGreater(last["steps"], STEPS - 20)
            self.assertEqual(page.errors, [])

    def send(self, page, form, answer):
        page.value_of(f"document.querySelector('[data-testid={form}] button').click()")
        page.wait_for("document.querySelector('[data-testid=command-answer]').innerText.includes(" + repr(answer) + ")")

    def fill(self, page, name, value):
        page.value_of(f"(() => {{ const field = document.querySelector('#command-panel [name={name}]'); field.value = {value!r}; }})()")

    def choose(self, page, name, value):
        page.value_of(f"(() => {{ const list = document.querySelector('[data-testid={name}]'); list.value = {value!r};"
                      "list.dispatchEvent(new Event('change')); })()")

    def test_commands_and_faults_go_into_a_live_run(self):
        with Console("--domain", DOMAIN) as console, browser.Browser(console.address) as page:
            run = simulate("--speed", "30", "--domain", DOMAIN)
            page.wait_for("window.console_state && console_state().steps > 5 && document.querySelector('[data-testid=command-form]')")
            events = "document.querySelector('[data-testid=event-list]').innerText"
            self.send(page, "command-form", "NOOP: in step")
            page.wait_for(f"{events}.includes('NOOP: accepted')")
            self.choose(page, "command-name", "SET_MODE")
            self.fill(page, "mode", "9")
            self.send(page, "command-form", "must be a whole number from 1 to 3")
            self.choose(page, "command-name", "Bytes, unchecked")
            self.fill(page, "function", "99")
            self.fill(page, "bytes", "00ff")
            self.send(page, "command-form", "Bytes, unchecked: in step")
            page.wait_for(f"{events}.includes('FUNCTION 99 0 255: refused')")
            self.choose(page, "fault-kind", "freeze")
            self.send(page, "fault-form", "Freeze the sensor: in step")
            page.wait_for("Object.values(console_state().light_texts).some((text) => text.includes('FRAME_FROZEN'))")
            page.screenshot(FOLDER / "frozen.png")
            page.wait_for("!Object.values(console_state().light_texts).some((text) => text.includes('FRAME_FROZEN'))")
            run.terminate()
            run.wait(timeout=30)

    def test_a_recording_is_scrubbed(self):
        path = FOLDER / "run.mcap"
        self.assertEqual(simulate("--mcap", str(path)).wait(timeout=120), 0)
        with Console(str(path)) as console, browser.Browser(console.address) as page:
            page.wait_for(f"window.console_state && console_state().steps == {STEPS} && console_state().points > 100")
            self.assertFalse(state(page, "following"))
            self.assertEqual(state(page, "selected"), 0)
            page.press("End")
            page.wait_for(f"console_state().selected == {STEPS - 1}")
            page.press("Home")
            page.press("ArrowRight")
            page.wait_for("console_state().selected == 1")
            page.press("n")  # the telecommand before the second sequence
            page.wait_for(f"console_state().selected == {FRAMES}")
            first = page.value_of("document.querySelector('[data-testid=numbers]').innerText")
            page.press("ArrowRight")
            page.wait_for("document.querySelector('[data-testid=numbers]').innerText != " + repr(first))
            self.check_view(page, "recording")
            for theme in ("dark", "light"):
                page.value_of("document.querySelector('[data-testid=theme-button]').click()")
                page.screenshot(FOLDER / f"other_theme_{theme}.png")
            page.press(" ")
            page.wait_for(f"console_state().selected > {FRAMES + 2}")
            self.assertEqual(page.errors, [])

    def test_without_the_token_there_is_no_page(self):
        with Console() as console, browser.Browser(console.address.split("?")[0]) as page:
            self.assertIn("token", page.wait_for("document.body && document.body.innerText"))


if __name__ == "__main__":
    TUMBLESIGHT = sys.argv[1]
    TEMPORARY = tempfile.TemporaryDirectory(prefix="tumblesight-page-")
    FOLDER = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else TEMPORARY.name)
    if browser.find_chromium() is None:
        print("SKIPPED: no Chromium (Debian: chromium)")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
