"""Counts the instructions and the cycles of every step of flight_replay per stage, with a QEMU plugin."""
import pathlib
import re
import subprocess

from cycles import pipeline
from network_layers import function, layers

# The stages in the order of execution, each with the function that begins it. The first one begins a step, the second one ends
# it. Code between two stages counts for the earlier one. Every layer of the CNN is a stage, and so are the LSTM and the head.
_BEFORE_CNN = (
    ("application", r"fsw::AttitudeInitApp::step\("),
    ("(end)", r"replay::ConsoleLink::publish\(tumblesight::hal::AttitudeReport"),
    ("target selection", r"gnc::select_target\("),
    ("depth image", r"::summarize_returns\("),
    ("space to depth", r"gnc::space_to_depth<"),
)
_BEFORE_LSTM = (
    ("hypotheses", r"gnc::decode_hypotheses<"),
    ("prediction", r"gnc::predict<"),
    ("LSTM input", r"gnc::fill_lstm_input<"),
)
_AFTER_HEAD = (
    ("fusion", r"gnc::advance<"),
    ("inlier ratios", r"gnc::inlier_ratios\("),
    ("registration", r"gnc::track_pose\("),
    ("telemetry", r"gnc::FrameGate::numbers_skipped\("),  # the first function after the estimator
)
TIME_LIMIT_S = 1200


def stages(with_registration=True):
    """Float32 attitudes are not registered."""
    after_head = [stage for stage in _AFTER_HEAD if with_registration or stage[0] != "registration"]
    cnn, lstm, head = ([layer for layer in layers() if layer.part == part] for part in ("cnn", "lstm", "head"))
    return (*_BEFORE_CNN, *((layer.name, function(layer)) for layer in cnn[:-1]), ("single-frame head", function(cnn[-1])),
            *_BEFORE_LSTM, ("LSTM", function(lstm[0])), ("recurrent head", function(head[0])), *after_head)


def build_plugin(folder):
    plugin = folder / "count_cycles.so"
    source = pathlib.Path(__file__).with_name("count_cycles.c")
    subprocess.run(["gcc", "-O2", "-shared", "-fPIC", str(source), "-o", str(plugin)], check=True)
    return plugin


def addresses(processor, program, wanted):
    """The addresses of the stages' functions, in the order of `wanted`."""
    listing = subprocess.run([processor.tool("nm"), "-C", str(program)], check=True, capture_output=True, text=True).stdout
    symbols = [line.split(" ", 2) for line in listing.splitlines() if re.match(r"[0-9a-f]+ [tTwW] ", line)]
    found = []
    for name, pattern in wanted:
        matches = [(int(address, 16), symbol) for address, _, symbol in symbols if re.search(pattern, symbol)]
        matches.sort(key=lambda match: "[clone" in match[1])  # the function itself before its clones
        if not matches:
            raise SystemExit(f"audit: {program}: no function for stage '{name}' ({pattern})")
        found.append(matches[0][0] & ~1 if processor.architecture == "arm" else matches[0][0])
    return found


def run_and_count(processor, model, program, plugin, folder, wanted):
    """([instructions per stage] of every step, [cycles per stage] of every step, lines of the console)"""
    inputs = {name: folder / f"{program.name}.{name}" for name in ("stages", "cycles", "model", "out")}
    lines = (f"{address:x} {name}\n" for address, (name, _) in zip(addresses(processor, program, wanted), wanted))
    inputs["stages"].write_text("".join(lines))
    instructions = pipeline.disassemble(processor.tool("objdump"), program)
    inputs["cycles"].write_text(pipeline.as_table(instructions, pipeline.static_cycles(instructions, model)))
    inputs["model"].write_text(pipeline.as_settings(model))
    inputs["out"].unlink(missing_ok=True)
    command = list(processor.emulator)
    at = -1 if command[-1] == "-kernel" else len(command)
    command[at:at] = ["-plugin", ",".join([str(plugin), *(f"{name}={path}" for name, path in inputs.items())])]
    run = subprocess.run(command + [str(program)], capture_output=True, text=True, timeout=TIME_LIMIT_S, stdin=subprocess.DEVNULL)
    console = (run.stdout + run.stderr).splitlines()
    if run.returncode != 0:
        raise SystemExit(f"audit: {program} on {processor.name} ended with status {run.returncode}:\n" + "\n".join(console[-5:]))
    numbers = [tuple(map(int, line.split())) for line in inputs["out"].read_text().splitlines()]
    half = len(wanted) - 1
    return [row[:half] for row in numbers], [row[half:] for row in numbers], console


# Verifies TS-NUM-070.
def count(processor, model, program, plugin, folder):
    """(names of the stages, [instructions per stage] of every step, [cycles per stage] of every step, lines of the console)"""
    wanted = stages(with_registration="float32" not in program.name)
    return ([name for name, _ in wanted if name != "(end)"], *run_and_count(processor, model, program, plugin, folder, wanted))


# A whole step of flight_worst_step, and the registration in it.
WHOLE_STEP = (("step", r"^tumblesight_step_begins"), ("(end)", r"^tumblesight_step_ended"), _AFTER_HEAD[-2], _AFTER_HEAD[-1])


# Verifies TS-TIM-100.
def count_longest_steps(processor, model, program, plugin, folder):
    """Four of {name of a step: the most of all steps with this name}, without the quiet ones: instructions, cycles, cycles of
    registration, and cycles beside it."""
    instructions, cycles, console = run_and_count(processor, model, program, plugin, folder, WHOLE_STEP)
    names = [line.split(" ", 1)[1] for line in console if line.startswith("step ")]
    if len(names) != len(cycles) or "all steps done" not in console:
        raise SystemExit(f"audit: {program} on {processor.name}: {len(names)} names for {len(cycles)} steps:\n" + "\n".join(console[-5:]))
    registration = [step[1] for step in cycles]  # after "step"
    whole = [sum(step) for step in cycles]
    return tuple({name: max(steps[i] for i in range(len(names)) if names[i] == name) for name in dict.fromkeys(names) if name != "quiet"}
                 for steps in ([sum(step) for step in instructions], whole, registration, [a - b for a, b in zip(whole, registration)]))
