"""The audit's failures, its document (docs/audit.md), its data (docs/audit.json) and its table in README.md."""
from processors import CYCLES_PER_INSTRUCTION

PERIOD_S = 2.7
GROWTH = 0.02
SHARE_OF_LONGEST_STEP = 0.75
CFS_APP_LIMITS = {"text": 16 * 1024, "data": 512 * 1024}
BOOT = "boot"  # before the first step, so it has no limit


def _estimate_ms(processor, instructions):
    return instructions * CYCLES_PER_INSTRUCTION / processor.clock_mhz / 1e3


# Verifies TS-TIM-050.
def failures(results, committed, budgets, macs):
    """One line per failure."""
    wrong = []
    for processor, numerics, r in results:
        at = f"{processor.name}, {numerics}"
        if not r["digest_is_golden"]:
            wrong.append(f"{at}: digest {r['digest']}, expected the one in tests/audit/golden.txt")
        if not r["equal_counts"]:
            wrong.append(f"{at}: the number of instructions depends on the frame: {r['unequal']}")
        for kind, names in r["forbidden"].items():
            wrong.append(f"{at}: {kind} in the flight code: {', '.join(names)}")
        if numerics == "fixed":
            if r["floating_point"]:
                wrong.append(f"{at}: floating point in {', '.join(r['floating_point'])}")
            if r["instructions"] > 1e6 * processor.instructions_e6:
                wrong.append(f"{at}: {r['instructions'] / 1e6:.2f} M instructions per step, limit {processor.instructions_e6:g} M")
            share = _estimate_ms(processor, r["instructions"]) / 1e3 / PERIOD_S
            if share > processor.share_of_period:
                wrong.append(f"{at}: {100 * share:.1f} % of the period, limit {100 * processor.share_of_period:.0f} %")
            for name, instructions in r["longest_steps"].items():
                share = _estimate_ms(processor, instructions) / 1e3 / PERIOD_S
                if name != BOOT and share > SHARE_OF_LONGEST_STEP:
                    wrong.append(f"{at}: step '{name}': {100 * share:.1f} % of the period, limit {100 * SHARE_OF_LONGEST_STEP:.0f} %")
            for name, limit in budgets.items():
                if r[name] > limit:
                    wrong.append(f"{at}: {name} {r[name]} bytes, limit {limit}")
            for name, limit in CFS_APP_LIMITS.items():
                if r["cfs_app"].get(name, 0) > limit:
                    wrong.append(f"{at}: {name} of the cFS app {r['cfs_app'][name]} bytes, limit {limit}")
        for name, instructions in committed.get(processor.name, {}).get(numerics, {}).get("longest_steps", {}).items():
            now = r["longest_steps"].get(name, 0)
            if now > instructions * (1 + GROWTH):
                wrong.append(f"{at}: step '{name}' has grown from {instructions} to {now} instructions, by more than "
                             f"{100 * GROWTH:.0f} % (tests/audit/run --write accepts it)")
        before = committed.get(processor.name, {}).get(numerics)
        if before:
            for name in ("instructions", "text", "read_only", "ram", "stack"):
                if r[name] > before[name] * (1 + GROWTH):
                    wrong.append(f"{at}: {name} has grown from {before[name]} to {r[name]}, by more than {100 * GROWTH:.0f} % "
                                 "(tests/audit/run --write accepts it)")
    return wrong


def as_data(results, macs):
    data = {"macs": macs, "processors": {}}
    for processor, numerics, r in results:
        keep = {k: r[k] for k in ("digest", "instructions", "stages", "longest_steps", "text", "read_only", "ram", "stack", "cfs_app")}
        data["processors"].setdefault(processor.name, {})[numerics] = keep
    return data


def _thousands(number):
    return f"{number:,}".replace(",", " ")


def _table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


BEGIN, END = "<!-- tests/audit/run --write: begin -->", "<!-- tests/audit/run --write: end -->"


def with_table(text, table):
    """The document with `table` between its marks BEGIN and END."""
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(END) < text.index(BEGIN):
        raise SystemExit(f"audit: README.md: the marks '{BEGIN}' and '{END}' must be there once, in this order")
    return text[:text.index(BEGIN) + len(BEGIN)] + "\n" + table + "\n" + text[text.index(END):]


# With an operating system, without one, and the slowest.
OF_SUMMARY = ("cortex-a53", "cortex-m7", "leon3")


def as_summary(results, macs):
    """The table of README.md."""
    rows = [[f"{p.title}, {p.clock_mhz} MHz", f"{r['instructions'] / 1e6:.1f} M", f"{r['instructions'] / macs:.2f}",
             f"{_estimate_ms(p, r['instructions']):.0f} ms", f"{r['ram'] / 1e3:.0f} KB"]
            for p, numerics, r in results if numerics == "fixed" and p.name in OF_SUMMARY]
    return "\n".join(_table(["a step in fixed point", "instructions", "per multiply-accumulate",
                             f"time at an assumed {CYCLES_PER_INSTRUCTION:g} cycles per instruction", "RAM without the model"], rows))


def as_document(results, macs, budgets, model, image_bytes, frames):
    fixed = [(p, r) for p, numerics, r in results if numerics == "fixed"]
    floats = [(p, r) for p, numerics, r in results if numerics == "float32"]
    return "\n".join(_introduction(model, frames) + _steps(fixed, macs) + _longest_steps(fixed) + _stages(fixed) + _memory(fixed, budgets, image_bytes)
                     + _cfs_app(fixed) + _float32(floats, macs)) + "\n"


def _introduction(model, frames):
    return [
        "# Audit",
        "",
        "Written by `tests/audit/run --write`. The audit builds the flight application for every processor and runs it in QEMU on",
        f"recorded frames (`flight_replay`: {frames}; model image {model}). It fails when a figure exceeds its limit, grows by more",
        f"than {100 * GROWTH:.0f} %, or when a bit differs. Without `--write` it checks and prints, and leaves this file unchanged.",
        "",
        "**Measured**: digests, instruction counts, sizes.",
        "",
        f"**Estimated**: time = instructions × {CYCLES_PER_INSTRUCTION:g} cycles / clock. The number of cycles per instruction is an assumption, the same for",
        "all parts. It is neither measured nor from a data sheet: QEMU does not model caches, buses or pipelines. An estimate is not",
        "a worst-case execution time. Without registration the instruction count is the same for every frame without a gap before it that is not",
        "resampled, and for every one that is. Registration draws what the frame shows; the table has the largest of the recorded frames.",
        "",
        "MACs are those of the network, including padding. The kernels skip the padding of the first and last rows where that costs",
        "nothing (3 to 5 % of all MACs).",
        "",
    ]


def _steps(fixed, macs):
    rows = []
    for p, r in fixed:
        time_ms = _estimate_ms(p, r["instructions"])
        rows.append([p.title, r["set"], f"`{r['digest']}`", _thousands(r["instructions"]),
                     f"{p.instructions_e6:g} M", f"{r['instructions'] / macs:.3f}", f"{p.clock_mhz} MHz", f"{time_ms:.0f} ms",
                     f"{100 * time_ms / 1e3 / PERIOD_S:.1f} %", f"{100 * p.share_of_period:.0f} %"])
    lines = ["## A step in fixed point", ""]
    lines += _table(["processor", "kernels", "digest", "instructions", "≤", f"per MAC of {macs / 1e6:.2f} M", "clock", "time",
                     "of 2.7 s", "≤"], rows)
    lines += ["", "The digest covers every attitude, expected error and event, and the whole state after every frame. It is the same on",
              "the desktop (`tests/audit/golden.txt`).", ""]
    lines += _table(["processor", "clock of"], [[p.title, p.part] for p, _ in fixed])
    per_mac = next((r["instructions"] / macs for p, r in fixed if p.name == "cortex-m7"), None)
    if per_mac is not None:
        lines += ["", "For comparison: CMSIS-NN's 8-bit convolutions are published at about 1.7 cycles per MAC on a Cortex-M7. This component takes",
                  f"{per_mac:.2f} instructions per MAC there for a whole step; the core starts up to two instructions per cycle. Cycles and",
                  "instructions are different quantities, so that only their order of magnitude can be compared."]
    return lines + [""]


def _longest_steps(fixed):
    lines = ["## Longest steps", "",
             "Estimated time in ms of whole steps (`flight_worst_step`), each with the receipt of the most deliveries that a cycle",
             "takes: 32 frames, copied by the sensor interface. The newest three have bad content, the next one is used, two have stuck",
             "rows and are compared in full, and the others show hardly anything, which takes the longest to see. From the third row on",
             "each has a full load of the most expensive commands, the largest scrubbing that SET_PARAMETER allows with a repair of every",
             "block, and a restored state, as far as its kind of step can have them. A step has a frame or one long task (docs/icd.md, 2.5), never both: recovery is spread over several steps.",
             f"The audit fails when a step takes more than {100 * SHARE_OF_LONGEST_STEP:.0f} % of the period "
             f"({1e3 * SHARE_OF_LONGEST_STEP * PERIOD_S:.0f} ms). *boot* is the start, `init()`, before the first step.", "",
             "Two kicks of the watchdog are at most a period plus the longest step apart: its time-out is two periods (docs/porting.md).", ""]
    lines += _table(["step", *(p.name for p, _ in fixed)],
                    [[name, *(f"{_estimate_ms(p, r['longest_steps'][name]):.0f}" for p, r in fixed)] for name in fixed[0][1]["longest_steps"]])
    return lines + [""]


def _stages(fixed):
    names = list(fixed[0][1]["stages"])
    lines = ["## Instructions per stage", "",
             "In thousands, for a step in fixed point, in the order of execution. Except for registration the counts do not depend",
             "on what a frame shows. A target that covers few of the frame's rays is resampled (docs/numerics.md): its depth image has another",
             "count, which is the same for every such frame and is part of the longest step after a coast. The recorded frames are not",
             "resampled.", ""]
    lines += _table(["stage", *(p.name for p, _ in fixed)],
                    [[name, *(f"{r['stages'][name] / 1e3:.0f}" for _, r in fixed)] for name in names[1:] + names[:1]])
    return lines + ["", "*application*: checks of frames, events, telemetry. Its work depends on what happens in the step; the table shows the",
                    "largest count.", ""]


def _memory(fixed, budgets, image_bytes):
    lines = ["## Memory", "",
             f"Bytes of the project's own code and data in the program. The model image ({_thousands(image_bytes)} bytes, read in place) and the recording",
             "are not included. RAM: the application with the network's working memory, two frames, telemetry, and the worst-case stack of",
             "a step from the compiler's call graph (a call through a pointer counts as the deepest function that it can reach).", ""]
    lines += _table(["processor", "text", "read-only", "data + bss", "stack of a step", "RAM", "≤"],
                    [[p.title, _thousands(r["text"]), _thousands(r["read_only"]), _thousands(r["ram"] - r["stack"]),
                      _thousands(r["stack"]), _thousands(r["ram"]), _thousands(budgets["ram"])] for p, r in fixed])
    return lines + ["", "The flight libraries need no symbol of the heap, exceptions, stdio or libm's transcendental functions, and a bare-metal",
                    "program contains none. No function of the fixed-point program uses floating-point arithmetic (disassembly).", ""]


def _cfs_app(fixed):
    rows = [[p.title, _thousands(r["cfs_app"]["text"]), _thousands(CFS_APP_LIMITS["text"]), _thousands(r["cfs_app"]["data"]),
             _thousands(CFS_APP_LIMITS["data"]), _thousands(r["cfs_app"]["banks"])] for p, r in fixed if r["cfs_app"]]
    return ["## The cFS app", "",
            "What the app of [cfs.md](cfs.md) adds to the text above. Its data is static: the flight application's whole state with the",
            "largest `TUMBLESIGHT_MEMORY_BYTES`, three frame buffers of 32 KiB, waiting commands and outputs. The model banks are apart.", "",
            *_table(["processor", "text", "≤", "data + bss", "≤", "two model banks"], rows), ""]


def _float32(floats, macs):
    lines = ["## A step in float32", "",
             "The reference. Its weights take 3.4 MB; a Cortex-M7 does not have the memory for them.", ""]
    return lines + _table(["processor", "kernels", "digest", "instructions", "per MAC"],
                          [[p.title, r["set"], f"`{r['digest']}`", _thousands(r["instructions"]), f"{r['instructions'] / macs:.3f}"]
                           for p, r in floats])
