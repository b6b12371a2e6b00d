"""PowerPC 750."""
import re
import sys

from cycles.pipeline import Branches, Cache, Model, Timing, read_and_written, split

_REGISTER = re.compile(r"\b[rf][0-9]+\b")


def writes_flags(instruction):
    return instruction.mnemonic.endswith(".") or instruction.mnemonic.startswith("cmp")


def operands(instruction, timing):
    read, written = read_and_written(split(instruction.operands), timing.writes, _REGISTER.findall)
    occupies = timing.occupies
    if instruction.mnemonic.startswith("rlwimi"):
        read = read + written
    if instruction.mnemonic in ("lmw", "stmw"):
        occupies += 32 - int(instruction.operands.split(",")[0][1:])
    return read, written, occupies


# Two units for integers; only the first one multiplies and divides. A branch is folded when it is predicted.
_RULES = (
    (r"lmw", Timing(2, 3, unit="load/store", pairs=False)),
    (r"stmw", Timing(2, unit="load/store", pairs=False, writes="none")),
    (r"l(bz|hz|ha|wz|f[sd]|hbr|wbr|warx|ve?x?|vs[lr]).*|lwbrx", Timing(1, 2, unit="load/store")),
    (r"st.*|dcb.*|icbi", Timing(1, unit="load/store", writes="none")),
    (r"mul(lw|hw|hwu|li)\.?", Timing(1, 5, unit="multiply", busy=5)),
    (r"divwu?\.?", Timing(1, 19, unit="multiply", busy=19)),
    (r"blr|bctrl?|bctr|b[a-z]*lr[+-]?", Timing(branch="r", writes="none")),
    (r"bl?|ba|bcl", Timing(branch="j", writes="none")),
    (r"b[a-z]+[+-]?", Timing(branch="c", writes="none")),
    (r"cmp.*", Timing(writes="none")),
    (r"mt.*", Timing(pairs=False, writes="none")),
    (r"mf.*|sc|.*sync|cr.*|eieio", Timing(pairs=False)),
    (r"[a-z0-9]+\.?", Timing()),
)
PPC750 = Model("PowerPC 750", sys.modules[__name__], _RULES, issue_width=2, flags_latency=1,
               fetches=Cache(32768, 8, 32, 30), accesses=Cache(32768, 8, 32, 30, store_miss_cycles=30),
               branches=Branches(mispredicted=4, predicted=True, indirect=2),
               basis="IBM 750GX User's Manual, chapter 6: load 2:1, branches folded, a multiplier that ends early for small operands. Assumed: "
               "multiply 5, divide 19, misprediction 4, a miss 30 without the L2. In order, although the part reorders")
