"""The audit as a document for a reviewer (docs/audit.md) and as data (docs/audit.json)."""
from processors import CYCLES_PER_INSTRUCTION

PERIOD_S = 2.7
GROWTH = 0.02


def _estimate_ms(processor, instructions):
    return instructions * CYCLES_PER_INSTRUCTION / processor.clock_mhz / 1e3


# Verifies TS-TIM-050.
def failures(results, committed, budgets, macs):
    """What is wrong, a line each."""
    wrong = []
    for processor, numerics, r in results:
        at = f"{processor.name}, {numerics}"
        if not r["digest_is_golden"]:
            wrong.append(f"{at}: digest {r['digest']}, not the golden one")
        if not r["equal_counts"]:
            wrong.append(f"{at}: the number of instructions depends on the frame: {r['unequal']}")
        for kind, names in r["forbidden"].items():
            wrong.append(f"{at}: {kind} in the flight code: {', '.join(names)}")
        if numerics == "fixed":
            if r["floating_point"]:
                wrong.append(f"{at}: floating point in {', '.join(r['floating_point'])}")
            per_mac = r["instructions"] / macs
            if per_mac > processor.instructions_per_mac:
                wrong.append(f"{at}: {per_mac:.3f} instructions per MAC, at most {processor.instructions_per_mac}")
            share = _estimate_ms(processor, r["instructions"]) / 1e3 / PERIOD_S
            if share > processor.share_of_period:
                wrong.append(f"{at}: {100 * share:.1f} % of the period, at most {100 * processor.share_of_period:.0f} %")
            for name, limit in budgets.items():
                if r[name] > limit:
                    wrong.append(f"{at}: {name} {r[name]} bytes, at most {limit}")
        before = committed.get(processor.name, {}).get(numerics)
        if before:
            for name in ("instructions", "text", "read_only", "ram", "stack"):
                if r[name] > before[name] * (1 + GROWTH):
                    wrong.append(f"{at}: {name} has grown from {before[name]} to {r[name]}, more than {100 * GROWTH:.0f} %")
    return wrong


def as_data(results, macs):
    data = {"macs": macs, "processors": {}}
    for processor, numerics, r in results:
        keep = {k: r[k] for k in ("digest", "instructions", "stages", "text", "read_only", "ram", "stack")}
        data["processors"].setdefault(processor.name, {})[numerics] = keep
    return data


def _thousands(number):
    return f"{number:,}".replace(",", " ")


def _table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


def as_document(results, macs, budgets, model, frames):
    fixed = [(p, r) for p, numerics, r in results if numerics == "fixed"]
    floats = {p.name: r for p, numerics, r in results if numerics == "float32"}
    lines = [
        "# Audit",
        "",
        "Written by `tests/audit/run`, which builds the flight application for every processor, flies it in QEMU on recorded frames",
        f"(`flight_replay`: {frames}; model image {model}) and fails when a figure is over its budget, grows by more than "
        f"{100 * GROWTH:.0f} %, or a bit differs.",
        "",
        f"**Measured**: digests, instruction counts, sizes. **Estimated**: time = instructions × {CYCLES_PER_INSTRUCTION:g} cycles / clock, the cycles being",
        "an assumption for all parts alike, no measurement and no data sheet's; QEMU knows no caches, buses or pipelines. Neither is a proof of a worst-case execution time; that the",
        "count is the same for every frame is what makes measuring one on the part worthwhile. MACs are the network's, padding included;",
        "the first and last rows are spared theirs where that is free (3 to 5 % of all).",
        "",
        "## A step in fixed point",
        "",
    ]
    rows = []
    for p, r in fixed:
        time_ms = _estimate_ms(p, r["instructions"])
        rows.append([p.title, r["set"], f"`{r['digest']}`", _thousands(r["instructions"]), f"{r['instructions'] / macs:.3f}",
                     f"{p.instructions_per_mac:g}", f"{p.clock_mhz} MHz", f"{time_ms:.0f} ms",
                     f"{100 * time_ms / 1e3 / PERIOD_S:.1f} %", f"{100 * p.share_of_period:.0f} %"])
    lines += _table(["processor", "kernels", "digest", "instructions", f"per MAC of {macs / 1e6:.2f} M", "≤", "clock", "time",
                     "of 2.7 s", "≤"], rows)
    lines += ["", "The digest covers every attitude, expected error, event and the whole state after every frame; it is the same on",
              "the desktop (`tests/audit/golden.txt`). Whose clock: "
              + "; ".join(f"{p.title.split(',')[0]}, {p.part}" for p, _ in fixed) + ".", "",
              "CMSIS-NN's 8-bit convolutions are published at about 1.7 cycles a MAC on a Cortex-M7. Ours take "
              f"{next(r['instructions'] for p, r in fixed if p.name == 'cortex-m7') / macs:.2f} instructions a MAC, all of a step included, on a",
              "core that can begin two a cycle. These are different quantities, so no more is said than that they are of one kind." if
              any(p.name == "cortex-m7" for p, _ in fixed) else "", "", "## Where the instructions go", "",
              "Thousands, of a step in fixed point, in the order in which a step passes them; the numbers are the same for every frame.", ""]
    names = list(fixed[0][1]["stages"])
    lines += _table(["stage", *(p.name for p, _ in fixed)],
                    [[name, *(f"{r['stages'][name] / 1e3:.0f}" for _, r in fixed)] for name in names[1:] + names[:1]])
    lines += ["", "*application*: gates, events, time stamps. What it does depends on what happens; the table gives the largest.", "",
              "## Memory", "",
              "Bytes of the project's own code and data in the program; model image (1 178 496, read in place) and recording beside it. RAM:",
              "application with the network's working memory, two frames, telemetry, and the worst-case stack of a step from the compiler's",
              "call graph (calls through pointers count as the deepest of what they may reach).", ""]
    lines += _table(["processor", "text", "read-only", "data + bss", "stack of a step", "RAM", "≤"],
                    [[p.title, _thousands(r["text"]), _thousands(r["read_only"]), _thousands(r["ram"] - r["stack"]),
                      _thousands(r["stack"]), _thousands(r["ram"]), _thousands(budgets["ram"])] for p, r in fixed])
    lines += ["", "No heap, exceptions, stdio or transcendental of libm: the flight libraries ask for none of their symbols, and a bare-metal",
              "program holds none. No function of the fixed-point program computes in floating point (disassembly).", "",
              "## The same in float32", "", "The reference; what its weights take (4.6 MB) a Cortex-M7 does not have.", ""]
    rows = []
    for p, r in fixed:
        f = floats.get(p.name)
        if f:
            rows.append([p.title, f["set"], f"`{f['digest']}`", _thousands(f["instructions"]), f"{f['instructions'] / macs:.3f}"])
    lines += _table(["processor", "kernels", "digest", "instructions", "per MAC"], rows)
    return "\n".join(lines) + "\n"
