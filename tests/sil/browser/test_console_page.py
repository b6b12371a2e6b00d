"""The console's page in a browser: a run while it goes on, and a recording of one.

Usage: test_console_page.py TUMBLESIGHT [FOLDER]     FOLDER keeps the screenshots
"""
# Verifies TS-SIL-195.

import collections
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

import browser

SEQUENCES = 30
FRAMES = 10
STEPS = SEQUENCES * FRAMES
DOMAIN = "213"  # that no other run takes by itself
ENDLESS = 200   # sequences: more than a test on a slow machine lets pass
INFO, WARNING, ERROR = range(3)  # as the server numbers severities
MODEL_IMAGE = pathlib.Path(__file__).parents[3] / "fsw/models/near_shoemaker.tsm"  # all have the same size


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
        try:
            self.process.wait(timeout=20)
        finally:
            self.process.kill()
            self.process.stdout.close()

    def get(self, path, query=""):
        """What the API answers, beside the page."""
        address = self.address.replace("/?", f"{path}?{query}&")
        return json.load(urllib.request.urlopen(address, timeout=30))

    def newest(self):
        """The newest step."""
        return self.get("/api/step", f"k={self.get('/api/run')['steps'] - 1}")

    def severities(self):
        """How many events of each severity there are."""
        events = self.get("/api/steps", "from=0")["events"]
        return collections.Counter(severity for _, _, severity, *_ in events)


def end(process):
    """Ends a run, and the flight program with it."""
    process.terminate()
    try:
        process.wait(timeout=30)
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


def state(page, name):
    return page.value_of(f"console_state().{name}")


def has_event(severity, words):
    """An expression: the list shows such an event."""
    return (f"[...document.querySelectorAll('#event-list .event:not([hidden])')].some(({{children}}) => "
            f"children[1].textContent === {severity!r} && children[2].textContent.startsWith({words!r}))")


class Page(unittest.TestCase):
    def simulate(self, *arguments, sequences=SEQUENCES):
        """A run that ends with the test at the latest."""
        run = subprocess.Popen([TUMBLESIGHT, "simulate", "--sequences", str(sequences), "--frames", str(FRAMES),
                                "--report", str(FOLDER / "report.html"), *arguments],
                               stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL, start_new_session=True)
        self.addCleanup(end, run)
        return run

    def watch(self, page, changes):
        """The errors of the pose while the page goes to another step so many times."""
        errors, selected = [], state(page, "selected")
        for _ in range(changes):
            shown = page.wait_for(f"console_state().selected > {selected} && console_state()")
            selected = shown["selected"]
            if shown["pose_error_deg"] is not None:
                errors.append(shown["pose_error_deg"])
        return errors

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
            self.assertEqual(state(page, "steps"), 0)
            self.assertFalse(state(page, "mesh"))
            run = self.simulate("--speed", "40", "--domain", DOMAIN)
            page.wait_for("console_state().steps > 5 && console_state().points > 100 && console_state().mesh")
            self.assertTrue(state(page, "following"))
            self.check_title(page, console)
            errors = self.watch(page, 12)
            self.assertGreater(len(set(errors)), 1, "the estimate does not move")
            self.assertLess(min(errors), 1.0)
            self.check_view(page, "live")
            self.assertEqual(run.wait(timeout=120), 0)
            last = page.wait_for("document.body.innerText.includes('ended') && console_state()")
            self.assertEqual(last["selected"], last["steps"] - 1)
            self.assertGreater(last["steps"], STEPS - 20)
            self.check_that_another_run_is_followed(page, console)
            # A console that joins while the first step is under way may never get its frame.
            self.assertEqual([error for error in page.errors if not re.search(r"/api/(frame|depth)\?k=0&", error)], [])

    def test_steps_have_the_numbers_of_the_run_after_a_pause_of_the_console(self):
        with Console("--domain", DOMAIN) as console, browser.Browser(console.address) as page:
            page.wait_for("window.console_state && console_state().connected")
            self.simulate("--speed", "40", "--domain", DOMAIN, sequences=ENDLESS)
            page.wait_for("console_state().steps > 5")
            missed = state(page, "missed")
            console.process.send_signal(signal.SIGSTOP)
            time.sleep(5)  # some 70 steps
            console.process.send_signal(signal.SIGCONT)
            page.wait_for(f"console_state().missed > {missed}")
            self.send(page, "command-form", "NOOP: in step")
            sent = int(re.search(r"in step (\d+)", page.value_of("document.querySelector('[data-testid=command-answer]').innerText"))[1])
            page.wait_for(f"console_state().step >= {sent}")
            shown = page.value_of("console_state()")
            self.assertEqual(shown["step"], shown["selected"] + shown["missed"])
            page.wait_for("(() => { const { step, missed } = console_state(), text = document.body.innerText;"
                          "return text.includes(`Step ${step} of ${step} `) && text.includes(`${missed} steps of the run not seen`); })()")

    def check_title(self, page, console):
        target = console.get("/api/run")["target"]
        self.assertNotEqual(target, "")
        for title in (page.value_of("document.title"), page.value_of("document.querySelector('[data-testid=run-title]').innerText")):
            self.assertRegex(title, f"^{target}, run [0-9a-f]{{8}}")

    def check_that_another_run_is_followed(self, page, console):
        self.simulate("--target", "magellan", "--speed", "20", "--domain", DOMAIN, sequences=4)
        page.wait_for("document.title.startsWith('magellan') && console_state().steps > 10 && console_state().mesh")
        self.assertLessEqual(state(page, "steps"), 4 * FRAMES)
        self.check_title(page, console)

    def check_counts(self, page, console):
        """The filter counts the events as the server does."""
        counts = console.severities()
        for name, severity in (("info", INFO), ("warning", WARNING), ("error", ERROR)):
            title = page.value_of(f"document.querySelector('[data-testid=filter-{name}]').title")
            self.assertEqual(title, f"Show or hide ({counts[severity]})", name)
        return counts

    def send(self, page, form, answer):
        page.value_of(f"document.querySelector('[data-testid={form}] button').click()")
        page.wait_for("document.querySelector('[data-testid=command-answer]').innerText.includes(" + repr(answer) + ")")

    def fill(self, page, name, value):
        page.value_of(f"(() => {{ const field = document.querySelector('#command-panel [name={name}]'); field.value = {value!r}; }})()")

    def give_strength(self, page, value):
        page.value_of(f"(() => {{ document.querySelector('[data-testid=fault-strength]').value = {value!r}; }})()")

    def give_steps(self, page, value):
        page.value_of(f"(() => {{ document.querySelector('[data-testid=fault-steps]').value = {value!r}; }})()")

    def answer(self, page):
        return page.value_of("document.querySelector('[data-testid=command-answer]').innerText")

    def check_that_empty_fields_are_not_sent(self, page):
        page.value_of("(() => { const fetch = window.fetch; window.posts = 0;"
                      "window.fetch = (url, what) => { posts += what?.method === 'POST'; return fetch(url, what); }; })()")
        self.choose(page, "command-name", "Bytes, unchecked")
        self.send(page, "command-form", "function '' must be a whole number from 0 to 127")
        self.choose(page, "fault-kind", "debris")
        for strength, steps in (("", "5"), ("6", "")):
            self.give_strength(page, strength)
            self.give_steps(page, steps)
            page.value_of("document.querySelector('[data-testid=fault-form] button').click()")
        self.assertIn("function ''", self.answer(page), "the form of faults was sent")
        self.assertEqual(page.value_of("posts"), 0)

    def check_error(self, page, console):
        """An image that was begun, as a copy of the one in use, and is then validated with a wrong checksum."""
        end = time.monotonic() + 60
        while console.newest()["telemetry"]["model_segments_missing"] > 0:
            self.assertLess(time.monotonic(), end, "the image in use was not copied")
            time.sleep(0.2)
        self.choose(page, "command-name", "SET_MODE")
        self.fill(page, "mode", "1")  # STANDBY, where an image can be validated
        self.send(page, "command-form", "SET_MODE: in step")
        page.wait_for("Object.values(console_state().light_texts).includes('STANDBY')")
        self.choose(page, "command-name", "MODEL_VALIDATE")
        self.fill(page, "size", str(MODEL_IMAGE.stat().st_size))
        self.fill(page, "crc32", "0")
        self.send(page, "command-form", "MODEL_VALIDATE: in step")
        page.wait_for(has_event("■ Error", "model image refused"))
        page.wait_for("document.querySelector('[data-testid=filter-error]').innerText === 'Errors 1'")
        page.wait_for(has_event("▲ Warning", "telecommand without a model to act on"))

    def choose(self, page, name, value):
        page.value_of(f"(() => {{ const list = document.querySelector('[data-testid={name}]'); list.value = {value!r};"
                      "list.dispatchEvent(new Event('change')); })()")

    def test_commands_and_faults_go_into_a_live_run(self):
        with Console("--domain", DOMAIN) as console, browser.Browser(console.address) as page:
            self.simulate("--speed", "20", "--domain", DOMAIN, sequences=ENDLESS)
            page.wait_for("window.console_state && console_state().steps > 5 && document.querySelector('#command-panel form:not([hidden])')")
            events = "document.querySelector('[data-testid=event-list]').innerText"
            self.check_that_empty_fields_are_not_sent(page)
            self.choose(page, "command-name", "NOOP")
            self.send(page, "command-form", "NOOP: in step")
            page.wait_for(f"{events}.includes('NOOP: accepted')")
            self.choose(page, "command-name", "SET_MODE")
            self.fill(page, "mode", "9")
            self.send(page, "command-form", "must be a whole number from 1 to 3")
            self.choose(page, "command-name", "Bytes, unchecked")
            self.fill(page, "function", "99")
            self.fill(page, "bytes", "00ff")
            self.send(page, "command-form", "Bytes, unchecked: in step")
            # "in part" if the simulator resets the sequence in the same step.
            page.wait_for(f"{has_event('▸ Command', 'FUNCTION 99 0 255: refused')} || "
                          f"{has_event('▸ Command', 'FUNCTION 99 0 255: in part refused')}")
            page.wait_for(has_event("▲ Warning", "telecommand unknown"))
            self.choose(page, "command-name", "MODEL_BEGIN")
            self.fill(page, "base", "1")
            self.send(page, "command-form", "MODEL_BEGIN: in step")
            self.choose(page, "fault-kind", "freeze")
            self.give_steps(page, "20")
            self.send(page, "fault-form", "Freeze the sensor: in step")
            page.wait_for("Object.values(console_state().light_texts).some((text) => text.includes('FRAME_FROZEN'))")
            page.screenshot(FOLDER / "frozen.png")
            page.wait_for("!Object.values(console_state().light_texts).some((text) => text.includes('FRAME_FROZEN'))")
            self.choose(page, "fault-kind", "debris")
            self.give_strength(page, "99")
            self.send(page, "fault-form", "the strength must be a number from 0.1 to 10 m, not 99")
            self.give_strength(page, "6")
            self.send(page, "fault-form", "debris: in step")
            self.watch(page, 3)
            page.screenshot(FOLDER / "debris.png")
            self.choose(page, "fault-kind", "occlude")
            self.give_strength(page, "0.4")
            self.send(page, "fault-form", "Occlude the target: in step")
            self.watch(page, 3)
            page.screenshot(FOLDER / "occluded.png")
            self.check_error(page, console)
            page.screenshot(FOLDER / "error.png")

    def test_a_recording_is_scrubbed(self):
        path = FOLDER / "run.mcap"
        self.assertEqual(self.simulate("--mcap", str(path)).wait(timeout=120), 0)
        with Console(str(path)) as console, browser.Browser(console.address) as page:
            page.wait_for(f"window.console_state && console_state().steps == {STEPS} && console_state().points > 100")
            self.assertFalse(state(page, "following"))
            self.assertEqual(state(page, "selected"), 0)
            self.check_title(page, console)
            self.assertGreater(self.check_counts(page, console)[INFO], 0)
            self.assertFalse(page.value_of(has_event("i Info", "")))
            page.value_of("document.querySelector('[data-testid=filter-info]').click()")
            page.wait_for(has_event("i Info", "model activated"))
            page.value_of("document.querySelector('[data-testid=filter-info]').click()")
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
