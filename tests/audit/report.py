"""The audit's failures, its document (docs/audit.md), its data (docs/audit.json) and its table in README.md."""
import pathlib
import re

PERIOD_S = 2.7
GROWTH = 0.02
CFS_APP_LIMITS = {"text": 16 * 1024, "data": 512 * 1024}
BOOT = "boot"  # before the first step, so it has no limit
# The model whose cycles the budget of registration counts.
BUDGETED_MODEL = "LEON3, slow multiplier"
LEAST_SHARE_SEEN = 0.8  # of the budget, in the dearest step


def registration_budget():
    """The most that registration takes, in cycles of BUDGETED_MODEL: its budget and what it may exceed it by."""
    header = (pathlib.Path(__file__).resolve().parents[2] / "gnc/registration/work_budget.hpp").read_text()
    return sum(int(re.search(rf"{name} = ([\d']+);", header)[1].replace("'", "")) for name in ("kOfAFrame", "kMostBeyond"))


def bounds(results):
    """{title of a model: the bound of a step with a frame}: the most beside registration in any step, and the budget. Other
    models than BUDGETED_MODEL take it times their largest share of its cycles in the same step. Empty if it is not among the results."""
    fixed = [r for _, numerics, r in results if numerics == "fixed"]
    budgeted = next((r["registration_cycles"][BUDGETED_MODEL] for r in fixed if BUDGETED_MODEL in r["registration_cycles"]), {})
    found = {}
    for r in fixed:
        for title, registration in r["registration_cycles"].items():
            shares = {name: registration[name] / cycles for name, cycles in budgeted.items() if cycles}
            if shares:
                found[title] = max(r["cycles_beside"][title][name] for name in shares) + round(max(shares.values()) * registration_budget())
    return found


def _ms(processor, cycles):
    return cycles / processor.clock_mhz / 1e3


def _late(processor, limit, r, bound):
    """A phrase per step that takes a larger share of the period than its limit. `bound`: of bounds(), or None."""
    title = limit.model.title
    steps = [("a step", r["cycles"][title], limit.step)]
    steps += [(f"step '{name}'", cycles, limit.longest_step) for name, cycles in r["longest_cycles"][title].items() if name != BOOT]
    steps += [("the bound of a step", bound, limit.longest_step)] if bound else []
    for name, cycles, most in steps:
        share = _ms(processor, cycles) / 1e3 / PERIOD_S
        if share > most:
            yield f"{title}: {name}: {100 * share:.1f} % of the period, limit {100 * most:.0f} %"


# Verifies TS-TIM-050.
def failures(results, committed, budgets, macs):
    """One line per failure."""
    wrong = []
    bound = bounds(results)
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
            for limit in processor.limits:
                wrong += [f"{at}: {words}" for words in _late(processor, limit, r, bound.get(limit.model.title))]
            wrong += [f"{at}: step '{name}': registration takes {cycles} cycles, its budget is {registration_budget()}"
                      for name, cycles in r["registration_cycles"].get(BUDGETED_MODEL, {}).items() if cycles > registration_budget()]
            most = max(r["registration_cycles"].get(BUDGETED_MODEL, {"": registration_budget()}).values())
            if most < LEAST_SHARE_SEEN * registration_budget():
                wrong.append(f"{at}: registration takes {most} cycles in the dearest step of flight_worst_step, less than "
                             f"{100 * LEAST_SHARE_SEEN:.0f} % of its budget: the step is not the worst any more")
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
        keep = {k: r[k] for k in ("digest", "instructions", "cycles", "stages", "longest_steps", "longest_cycles", "text", "read_only", "ram", "stack", "cfs_app")}
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


def _times(processor, cycles):
    """"24 ms", or "TCM 493 ms, cached 526 ms" of several models of a processor."""
    if len(cycles) == 1:
        return f"{_ms(processor, *cycles.values()):.0f} ms"
    return ", ".join(f"{title.split(', ')[1]} {_ms(processor, of):.0f} ms" for title, of in cycles.items())


def as_summary(results, macs):
    """The table of README.md."""
    rows = [[f"{p.title}, {p.clock_mhz} MHz", f"{r['instructions'] / 1e6:.1f} M", f"{r['instructions'] / macs:.2f}",
             _times(p, r["cycles"]), f"{r['ram'] / 1e3:.0f} KB"]
            for p, numerics, r in results if numerics == "fixed" and p.name in OF_SUMMARY]
    return "\n".join(_table(["a step in fixed point", "instructions", "per multiply-accumulate",
                             "modelled time", "RAM without the model"], rows))


def as_document(results, macs, budgets, model, image_bytes, frames):
    fixed = [(p, r) for p, numerics, r in results if numerics == "fixed"]
    floats = [(p, r) for p, numerics, r in results if numerics == "float32"]
    return "\n".join(_introduction(model, frames) + _steps(fixed, macs) + _longest_steps(fixed) + _models(fixed) + _stages(fixed) + _memory(fixed, budgets, image_bytes)
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
        "**Modelled**: cycles, by the [models](#the-models) below. Time is cycles / clock. A step begins with the caches as the step",
        "before left them. The figures leave out interrupts, the executive and other users of the bus: an integrator adds the interrupts'",
        "and the executive's time per period, and multiplies the misses of the caches by what a miss costs when the bus is shared.",
        "",
        "Without registration the instruction count is the same for every frame without a gap before it that is not resampled, and for",
        "every one that is. Registration draws what the frame shows; the tables have the largest of the recorded frames.",
        "",
        "MACs are those of the network, including padding. The kernels skip the padding of the first and last rows where that costs",
        "nothing (3 to 5 % of all MACs).",
        "",
    ]


def _steps(fixed, macs):
    rows = [[p.title, r["set"], f"`{r['digest']}`", _thousands(r["instructions"]), f"{p.instructions_e6:g} M",
             f"{r['instructions'] / macs:.3f}"] for p, r in fixed]
    lines = ["## A step in fixed point", ""]
    lines += _table(["processor", "kernels", "digest", "instructions", "≤", f"per MAC of {macs / 1e6:.2f} M"], rows)
    lines += ["", "The digest covers every attitude, expected error and event, and the whole state after every frame. It is the same on",
              "the desktop (`tests/audit/golden.txt`).", ""]
    rows = []
    for p, r in fixed:
        for limit in p.limits:
            cycles = r["cycles"][limit.model.title]
            share = _ms(p, cycles) / 1e3 / PERIOD_S
            rows.append([p.name, limit.model.title, _thousands(cycles), f"{cycles / r['instructions']:.2f}", f"{p.clock_mhz} MHz, {p.part}",
                         f"{_ms(p, cycles):.0f} ms", f"{100 * share:.1f} %", f"{100 * limit.step:.0f} %"])
    lines += _table(["processor", "model", "cycles", "per instruction", "clock of", "time", "of 2.7 s", "≤"], rows)
    return lines + [""]


def _models(fixed):
    """The models, each once."""
    models = {limit.model.title: limit.model for p, _ in fixed for limit in p.limits}
    lines = ["## The models", "",
             "A pipeline starts instructions in the order of the program, up to as many in a cycle as its width. An instruction waits for",
             "the results that it reads, with the latency of their kind, and for its unit. That is worked out once, from the disassembly",
             "(`tests/audit/cycles/`). A plug-in of QEMU adds what depends on the run (`count_cycles.c`): taken and mispredicted branches, and",
             "misses of set-associative caches, of which the line used longest ago is replaced. Nothing overlaps with a miss.", ""]
    rows = []
    for model in models.values():
        rows.append([model.title, f"{model.issue_width}", *(_words(cache) for cache in (model.fetches, model.accesses)),
                     f"{model.branches.mispredicted}" if model.branches.predicted else "–", model.basis])
    lines += _table(["model", "width", "instruction cache", "data cache", "misprediction", "basis"], rows)
    return lines + ["", *COMPARED, ""]


def _words(cache):
    if cache is None:
        return "–"
    return f"{cache.size_bytes // 1024} KiB, {cache.ways} ways of {cache.line_bytes} B, {cache.miss_cycles} cycles a miss"


# By hand, and nothing of it is in this repository.
COMPARED = (
    "**Compared with an independent simulator.** SIS 2.30, which the RTEMS project maintains, runs the bare-metal `flight_replay` of",
    "LEON3 unmodified to the golden digest. With the latencies of SIS and without caches the model (`sparc.SIS`) gives 2 843.0 M cycles",
    "for boot and 20 frames, and SIS 2 843.2 M: 0.01 % apart. In the first step every stage agrees within 0.2 %; telemetry was not compared. (2026-11-30; `sis",
    "-leon3 -freq 100 -dumbio`, commands `+bp`, `run`, `perf`.)", "",
    "**Compared with the hardware's description.** GRLIB 2025.2 (`leon3s`; `v8=2`, `bp=0` and `v8=16#32#`, `bp=1`; `lddel=1`, no MMU), simulated",
    "with GHDL, and a memory of 9 wait states for the first word, none for the others and 3 for a write. About 90 short kernels, and 32",
    "slices of `flight_replay` of 34 to 70 thousand cycles from cold caches, from all parts of a step. With the slow multiplier the model takes",
    "between 0.987 and 1.025 of the simulated cycles of a slice and 1.003 of all, with the fast one 0.987 to 1.040 and 1.005. A data miss takes 14",
    "cycles as in the model; a fetch miss 18 after a branch and 12 in a row, in the model 17. Slower memories take longer: with 9 wait",
    "states for a write (a write buffer of 11 cycles) a recorded frame takes 125 M cycles with the slow multiplier and 95 M with the fast one.",
    "Not compared: LEON3FT, other bus masters, a second-level cache. (2026-11-30.)", "",
    "**U54, compared with a relative of it:** Rocket, from which it derives: the Verilog in `ucb-bar/fpga-zynq` (2016-09, RV64GC, caches of",
    "16 KiB), simulated with Verilator. Its multiplier is that of 2016. Changed by hand to that of 2017, with 16 bits a cycle as the U54's manual",
    "says, the model with the RTL's caches takes 0.994 of the simulated cycles of 36 slices of `flight_replay` (up to 250 thousand cycles",
    "each, many overlapping), 0.945 to 1.117 of one. Errors cancel in that: the model charges every missed store, which this RTL",
    "does not wait for (3 % of the cycles), and no wait for the register port that a multiplication needs. Of the RTL as",
    "published, with 8 bits a cycle and multiplications replayed, the model takes 0.902, and 0.652 of the worst slice. The caches and branch",
    "buffers of the U54 are others, and its L2 was not there. (2026-11-30.)", "",
    "The models of the other processors have been compared with nothing: their figures are estimates.",
)


def _longest_steps(fixed):
    lines = ["## Longest steps", "",
             "Modelled time in ms of whole steps (`flight_worst_step`), each with the receipt of the most deliveries that a cycle",
             "takes: 32 frames, copied by the sensor interface. The newest three have bad content, the next one is used, two have stuck",
             "rows and are compared in full, and the others show hardly anything, which takes the longest to see. From the third row on",
             "each has a full load of the most expensive commands, the largest scrubbing that SET_PARAMETER allows with a repair of every",
             "block, and a restored state, as far as its kind of step can have them. A step has a frame or one long task (docs/icd.md, 2.5), never both: recovery is spread over several steps.",
             "*boot* is the start, `init()`, before the first step; it has no limit.", "",
             "Two kicks of the watchdog are at most a period plus the longest step apart: its time-out is two periods (docs/porting.md).", ""]
    columns = [(p, limit, r["longest_cycles"][limit.model.title]) for p, r in fixed for limit in p.limits]
    rows = [[name, *(f"{_ms(p, cycles[name]):.0f}" for p, _, cycles in columns)] for name in fixed[0][1]["longest_steps"]]
    rows.append(["the longest, of 2.7 s", *(f"{100 * _ms(p, max(of for name, of in cycles.items() if name != BOOT)) / 1e3 / PERIOD_S:.0f} %"
                                            for p, _, cycles in columns)])
    bound = bounds([(p, "fixed", r) for p, r in fixed])
    if bound:
        rows.append(["the bound, of 2.7 s", *(f"{100 * _ms(p, bound[limit.model.title]) / 1e3 / PERIOD_S:.0f} %" for p, limit, _ in columns)])
    rows.append(["≤", *(f"{100 * limit.longest_step:.0f} %" for _, limit, _ in columns)])
    lines += _table(["step", *(limit.model.title if len(p.limits) > 1 else p.name for p, limit, _ in columns)], rows)
    if not bound:
        return lines + [""]
    budget, most = registration_budget(), max(next(r["registration_cycles"][BUDGETED_MODEL] for _, r in fixed
                                                   if BUDGETED_MODEL in r["registration_cycles"]).values())
    return lines + ["",
        "**The bound** is meant for every image that is accepted and every frame: the most that a step above takes beside registration, and the",
        f"most that registration may take, {budget / 1e6:.1f} M cycles of {BUDGETED_MODEL} (`gnc/registration/work_budget.hpp`; {most / 1e6:.1f} M in the",
        "dearest of these steps). Registration charges each part of its work before it is done. The prices are the least ones that cover the",
        "cycles of each of 133 frames, stage by stage, and 3 % more: 90 recorded frames of two targets with dark surfaces and hidden parts, and",
        "43 of `flight_worst_step`. They took 90 to 99 % of the prices before the 3 %, without the workarounds of GR712RC. No price was proven",
        "on its own. A search among surfaces made up to break the bound found a registration of 106.6 M cycles, so it holds for surfaces like",
        "those that ship, and others may take 4 % of the period more. On the other models the budget is scaled by their largest",
        "share of these cycles in any step above; there the bound is an estimate.", ""]


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
