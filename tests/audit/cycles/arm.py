"""Cortex-A9, Cortex-R5F and Cortex-M7 (A32 and T32)."""
import dataclasses
import math
import re
import sys

from cycles.pipeline import Branches, Cache, Model, Timing, read_and_written, split

_REGISTER = re.compile(r"\b(?:r[0-9]+|[sdq][0-9]+|sp|lr|pc|ip|fp|sl|sb)\b")
_WHEN = r"(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)?(\.[nw])?"
_ALWAYS_WHEN = _WHEN.replace(")?(", ")(", 1)


_ACCUMULATES = r"[us]mlal|movt|bf[ic]|vmla|vmls|vaba|vpadal|vqdmla|vsra|vbi[ft]|vbsl"
# add r0, r1 is add r0, r0, r1.
_TWO_OPERANDS = r"(add|sub|adc|sbc|and|orr|eor|bic|orn|ls[lr]|asr|ror|mul|rsb)s?" + _WHEN + "$"


def names(operand):
    """A register of 128 bits as its two of 64 bits; of a list like {d16-d19} all of them."""
    found = []
    for first, last in re.findall(r"\b([dq][0-9]+)-([dq][0-9]+)\b", operand):
        found += [f"{first[0]}{i}" for i in range(int(first[1:]), int(last[1:]) + 1)]
    found += _REGISTER.findall(operand)
    return [half for name in found for half in ([f"d{2 * int(name[1:])}", f"d{2 * int(name[1:]) + 1}"] if name[0] == "q" else [name])]


def writes_flags(instruction):
    return bool(re.fullmatch(r"(cmp|cmn|tst|teq|[a-z]{3}s)" + _WHEN, instruction.mnemonic))


def operands(instruction, timing):
    parts = split(instruction.operands)
    if timing.writes == "all" and instruction.mnemonic.startswith(("ldm", "stm", "push", "pop")):
        listed = names(parts[-1])
        base = [] if len(parts) == 1 else names(parts[0])
        loads = instruction.mnemonic.startswith(("ldm", "pop"))
        return (base if loads else base + listed), (listed if loads else []), max(1, math.ceil(len(listed) / 2))
    read, written = read_and_written(parts, timing.writes, names)
    occupies = timing.occupies
    if timing.writes == "all":
        occupies = max(1, math.ceil(len(written) / 2))
    if re.match(_ACCUMULATES, instruction.mnemonic) or (len(parts) == 2 and re.match(_TWO_OPERANDS, instruction.mnemonic)):
        read = read + written
    return read, written, occupies


def _rules(load, small_load, multiply, multiply_long, multiply_halves, vector):
    """Each a Timing; of a vector instruction without load or store."""
    return (
        (r"(pop|ldm)[a-z.]* .*\bpc\b.*", Timing(load.occupies, load.latency, pairs=False, unit="load/store", branch="r", writes="all")),
        (r"ldm.*|pop" + _WHEN, Timing(load.occupies, load.latency, pairs=False, unit="load/store", writes="all")),
        (r"stm.*|push" + _WHEN, Timing(1, pairs=False, unit="load/store", writes="all")),
        (r"vld[1-4m].*|vpop", Timing(1, load.latency + 1, pairs=False, unit="load/store", writes="all")),
        (r"vst.*|vpush", Timing(1, pairs=False, unit="load/store", writes="none")),
        (r"vldr.*", Timing(1, load.latency + 1, unit="load/store")),
        (r"ldrd.*", Timing(load.occupies, load.latency + 1, unit="load/store", writes="two")),
        (r"ldrs?[bh].*", small_load),
        (r"ldr[a-z.]* pc, .*", Timing(load.occupies, load.latency, branch="r", writes="none")),
        (r"ldr.*|pld", load),
        (r"str.*", Timing(1, unit="load/store", writes="none")),
        (r"[us]m(ull|lal)s?" + _WHEN, dataclasses.replace(multiply_long, writes="two")),
        (r"sm(ul|la|lal)([bt][bt]|w[bt])" + _WHEN + r"|sm(lad|uad|lsd|usd|lald|lsld)x?" + _WHEN, multiply_halves),
        (r"(mul|mla|mls|smmul|smmla)s?r?" + _WHEN, multiply),
        (r"[us]div" + _WHEN, Timing(1, 12, pairs=False, unit="multiply", busy=12)),
        (r"v.*", vector),
        (r"(b|bl)(\.[nw])?", Timing(branch="j", writes="none")),
        (r"blx [0-9a-f]+", Timing(branch="j", writes="none")),
        (r"(bx|blx|bxj|tb[bh])" + _WHEN, Timing(branch="r", writes="none")),
        (r"(mov|add)[a-z.]* pc, .*", Timing(branch="r", writes="none")),
        (r"b" + _ALWAYS_WHEN + r"|cbn?z|bl" + _ALWAYS_WHEN, Timing(branch="c", writes="none")),
        (r"(cmp|cmn|tst|teq)" + _WHEN + r"|it[te]*|nop.*|bkpt|svc.*|cps.*|d[ms]b|isb|msr|mcr.*|udf.*|w?f[ie]", Timing(writes="none")),
        (r"[a-z0-9]+(\.[nw])?", Timing()),
    )


_SYNTAX = sys.modules[__name__]
_M7_RULES = _rules(Timing(1, 2, unit="load/store"), Timing(1, 2, unit="load/store"), Timing(1, 2, unit="multiply"),
                   Timing(1, 2, unit="multiply"), Timing(1, 2, unit="multiply"), Timing(1, 3, unit="vector"))
_M7_BRANCHES = Branches(mispredicted=8, predicted=True, indirect=2)
_M7_BASIS = ("Arm publishes no cycle timings. Load 2 and multiply 2 are LLVM 19's, which has 3 for loads of bytes. Assumed: one of each in a "
             "cycle, misprediction 8")
M7_TIGHTLY_COUPLED = Model("Cortex-M7, TCM", _SYNTAX, _M7_RULES, issue_width=2, branches=_M7_BRANCHES,
                           basis=_M7_BASIS + ". All code and data in tightly coupled memory: the least that a part can take")
M7_CACHED = Model("Cortex-M7, cached", _SYNTAX, _M7_RULES, issue_width=2, fetches=Cache(16384, 2, 32, 20),
                  accesses=Cache(16384, 4, 32, 20, store_miss_cycles=4), branches=_M7_BRANCHES,
                  basis="as before, with caches before flash and RAM; what a miss costs is assumed")
R5F = Model("Cortex-R5F", _SYNTAX,
            _rules(Timing(1, 2, unit="load/store"), Timing(1, 2, unit="load/store"), Timing(2, 3, pairs=False, unit="multiply"),
                   Timing(2, 3, pairs=False, unit="multiply"), Timing(1, 2, unit="multiply"), Timing(1, 3, unit="vector")),
            issue_width=2, fetches=Cache(32768, 4, 32, 30), accesses=Cache(32768, 4, 32, 30, store_miss_cycles=8),
            branches=Branches(mispredicted=7, predicted=True, indirect=2),
            basis="Cortex-R5 Technical Reference Manual (DDI 0460), appendix B: load 2, multiply 2 with latency 3, halfword multiplies 1 with "
            "latency 2, misprediction 7. Which pairs start together is simplified; what a miss costs is assumed")
A9 = Model("Cortex-A9", _SYNTAX,
           _rules(Timing(1, 3, unit="load/store"), Timing(2, 4, unit="load/store"), Timing(2, 4, unit="multiply"),
                  Timing(3, 5, unit="multiply"), Timing(1, 3, unit="multiply"), Timing(1, 5, unit="vector", busy=2)),
           issue_width=2, fetches=Cache(32768, 4, 32, 25), accesses=Cache(32768, 4, 32, 25, store_miss_cycles=6),
           branches=Branches(mispredicted=9, predicted=True, indirect=2),
           basis="Cortex-A9 Technical Reference Manual (DDI 0388), appendix B: load 3, of bytes and halfwords 2 with latency 4, multiply 2 with "
           "latency 4, long 3 with latency 5. In order, although the part reorders. Vector instructions, misses and misprediction 9 are "
           "assumed")
