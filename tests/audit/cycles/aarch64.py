"""Cortex-A53 (A64)."""
import re
import sys

from cycles.pipeline import Branches, Cache, Model, Timing, read_and_written, split

_REGISTER = re.compile(r"\b([wxvqdshb])([0-9]+)\b|\b(sp|lr)\b")
_ACCUMULATES = r"[us]?ml[as]l?2?|[us]dot|[us]adalp|[us]r?sra|mov[kt]|bfi|bfxil|bif|bit|bsl|[a-z]*n2"


def names(operand):
    """Of a list like {v0.16b-v3.16b} all registers."""
    listed = re.match(r"\{v([0-9]+)\.[0-9a-z]+-v([0-9]+)", operand)
    if listed:
        return [f"v{number}" for number in range(int(listed[1]), int(listed[2]) + 1)]
    return [other or ("x" if kind in "wx" else "v") + number for kind, number, other in _REGISTER.findall(operand)]


def writes_flags(instruction):
    return instruction.mnemonic in ("cmp", "cmn", "tst", "subs", "adds", "ands", "ccmp", "ccmn", "bics", "negs", "fcmp")


def operands(instruction, timing):
    parts = split(instruction.operands)
    read, written = read_and_written(parts, timing.writes, names)
    occupies = timing.occupies
    wide = re.search(r"\.(16b|8h|4s|2d)\b|\bq[0-9]", instruction.operands)
    if timing.unit == "vector" and wide:
        occupies = 2  # of 64 bits each
    if timing.writes == "all":
        occupies = max(1, len(written))
    if re.fullmatch(_ACCUMULATES, instruction.mnemonic):
        read = read + written
    return read, written, occupies


_VECTOR = Timing(1, 4, unit="vector")
_RULES = (
    (r"(ldp|ldnp|ldpsw)", Timing(1, 3, unit="load/store", writes="two")),
    (r"ld[1-4]r?", Timing(1, 5, unit="load/store", writes="all")),
    (r"ld.* [qdvs][0-9].*", Timing(1, 4, unit="load/store")),
    (r"ld.*|prfm", Timing(1, 3, unit="load/store")),
    (r"st.*|dc|ic", Timing(1, unit="load/store", writes="none")),
    (r".* v[0-9]+\..*|.* [qdsh][0-9]+,.*", _VECTOR),
    (r"[us]?m(ul|add|sub|neg)[lh]?|[us]m(ull|addl|subl|negl)|[us]mulh", Timing(1, 3, unit="multiply")),
    (r"[us]div", Timing(1, 12, unit="multiply", busy=12)),
    (r"bl?", Timing(branch="j", writes="none")),
    (r"br|blr|ret", Timing(branch="r", writes="none")),
    (r"b\.[a-z]+|cbn?z|tbn?z", Timing(branch="c", writes="none")),
    (r"cmp|cmn|tst|ccm[pn]|nop|svc|d[ms]b|isb|msr|brk|udf|hint|bti|xpaclri|yield|fcmpe?|auti.*|paci.*", Timing(writes="none")),
    (r"[a-z0-9]+", Timing()),
)
A53 = Model("Cortex-A53", sys.modules[__name__], _RULES, issue_width=2, fetches=Cache(32768, 2, 64, 15),
            accesses=Cache(32768, 4, 64, 15, store_miss_cycles=4), branches=Branches(mispredicted=8, predicted=True, indirect=1),
            basis="Arm publishes no cycle timings, so these are assumptions: load 3, multiply 3, vector 4 and twice as long on 128 bits, "
            "misprediction 8, L2 15. LLVM 19 schedules with 4, 4 and 6, of which forwarding takes some off")
