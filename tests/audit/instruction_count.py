"""Counts the instructions of every step of flight_replay per stage, with a QEMU plugin."""
import pathlib
import re
import subprocess

# The stages in the order of execution, each with the function that begins it. The first one begins a step, the second one ends
# it. Code between two stages counts for the earlier one.
STAGES = (
    ("application", r"fsw::AttitudeInitApp::step\("),
    ("(end)", r"replay::ConsoleLink::publish\(tumblesight::hal::AttitudeReport"),
    ("depth image", r"gnc::make_depth_image\(.*DepthLoops const&\)"),
    ("space to depth", r"gnc::space_to_depth<"),
    ("conv1", r"ConvBlock<.*, 50, \d+, \d+>::forward\("),
    ("conv2", r"ConvBlock<.*, 25, \d+, \d+>::forward\("),
    ("conv3", r"ConvBlock<.*, 12, \d+, \d+>::forward\("),
    ("conv4", r"ConvBlock<.*, 6, \d+, \d+>::forward\("),
    ("dense1", r"Dense<.*, 2160, \d+>::hidden\("),
    ("dense2", r"Dense<.*, 192, 128>::hidden\("),
    ("single-frame head", r"Dense<.*, 128, 57>::output\("),
    ("hypotheses", r"gnc::decode_hypotheses<"),
    ("prediction", r"gnc::predict<"),
    ("LSTM input", r"gnc::fill_lstm_input<"),
    ("LSTM", r"Lstm<.*>::forward\("),
    ("recurrent head", r"Dense<.*, 382, 128>::hidden\("),
    ("fusion", r"gnc::advance<"),
    ("telemetry", r"BoardStopwatch::now_ns\("),
)
TIME_LIMIT_S = 1200


def build_plugin(folder):
    plugin = folder / "count_instructions.so"
    source = pathlib.Path(__file__).with_suffix("").parent / "count_instructions.c"
    subprocess.run(["gcc", "-O2", "-shared", "-fPIC", str(source), "-o", str(plugin)], check=True)
    return plugin


def addresses(processor, program, stages):
    """The addresses of the stages' functions, in the order of `stages`."""
    listing = subprocess.run([processor.tool("nm"), "-C", str(program)], check=True, capture_output=True, text=True).stdout
    symbols = [line.split(" ", 2) for line in listing.splitlines() if re.match(r"[0-9a-f]+ [tTwW] ", line)]
    found = []
    for name, pattern in stages:
        matches = [(int(address, 16), symbol) for address, _, symbol in symbols if re.search(pattern, symbol)]
        matches.sort(key=lambda match: "[clone" in match[1])  # the function itself before its clones
        if not matches:
            raise SystemExit(f"audit: {program}: no function for stage '{name}' ({pattern})")
        found.append(matches[0][0] & ~1 if processor.architecture == "arm" else matches[0][0])
    return found


def run_and_count(processor, program, plugin, folder, stages):
    """([instructions per stage] of every step, lines of the console)"""
    table, out = folder / f"{program.name}.stages", folder / f"{program.name}.counts"
    lines = (f"{address:x} {name}\n" for address, (name, _) in zip(addresses(processor, program, stages), stages))
    table.write_text("".join(lines))
    out.unlink(missing_ok=True)
    command = list(processor.emulator)
    at = -1 if command[-1] == "-kernel" else len(command)
    command[at:at] = ["-plugin", f"{plugin},stages={table},out={out}"]
    run = subprocess.run(command + [str(program)], capture_output=True, text=True, timeout=TIME_LIMIT_S, stdin=subprocess.DEVNULL)
    console = (run.stdout + run.stderr).splitlines()
    if run.returncode != 0:
        raise SystemExit(f"audit: {program} on {processor.name} ended with status {run.returncode}:\n" + "\n".join(console[-5:]))
    return [tuple(map(int, line.split())) for line in out.read_text().splitlines()], console


# Verifies TS-NUM-070.
def count(processor, program, plugin, folder):
    """(names of the stages, [instructions per stage] of every step, lines of the console)"""
    steps, console = run_and_count(processor, program, plugin, folder, STAGES)
    return [name for name, _ in STAGES if name != "(end)"], steps, console


# A whole step of flight_worst_step.
WHOLE_STEP = (("step", r"fsw::AttitudeInitApp::step\("), ("(end)", r"^tumblesight_step_ended"))


# Verifies TS-TIM-100.
def count_worst_steps(processor, program, plugin, folder):
    """{name of a step: instructions, the most of all steps with this name}, without the quiet ones"""
    steps, console = run_and_count(processor, program, plugin, folder, WHOLE_STEP)
    names = [line.split(" ", 1)[1] for line in console if line.startswith("step ")]
    if len(names) != len(steps) or "all steps done" not in console:
        raise SystemExit(f"audit: {program} on {processor.name}: {len(names)} names for {len(steps)} steps:\n" + "\n".join(console[-5:]))
    worst = {}
    for name, (instructions,) in zip(names, steps):
        if name != "quiet":
            worst[name] = max(worst.get(name, 0), instructions)
    return worst
