"""SiFive U54 (RV64GC)."""
import re
import sys

from cycles.pipeline import Branches, Cache, Model, Timing, read_and_written, split

_REGISTER = re.compile(r"\b(?:zero|ra|[sgt]p|f?[ast][0-9]+|ft[0-9]+|f[as][0-9]+)\b")


def writes_flags(_):
    return False


def operands(instruction, timing):
    parts = split(instruction.operands)
    return (*read_and_written(parts, timing.writes, lambda operand: [n for n in _REGISTER.findall(operand) if n != "zero"]),
            timing.occupies)


_RULES = (
    (r"l[dw]u?|fl[dw]", Timing(1, 2)),
    (r"l[bh]u?", Timing(1, 3)),
    (r"s[bhwd]|fs[wd]", Timing(writes="none")),
    (r"mul.*", Timing(1, 5, unit="multiply", busy=5)),
    (r"(div|rem).*", Timing(1, 34, unit="multiply", busy=34)),
    (r"j|jal|call|tail", Timing(branch="j", writes="none")),
    (r"jr|jalr|ret|mret", Timing(branch="r", writes="none")),
    (r"b[a-z]+", Timing(branch="c", writes="none")),
    (r"csr.*|fence.*|wfi|ecall|ebreak|unimp|nop", Timing(1, 3)),
    (r"(lr|sc|amo).*", Timing(4, 5)),
    (r"f.*", Timing(1, 4)),
    (r"[a-z0-9.]+", Timing()),
)
U54 = Model("U54", sys.modules[__name__], _RULES, fetches=Cache(32768, 8, 64, 20),
            accesses=Cache(32768, 8, 64, 20, store_miss_cycles=20), branches=Branches(mispredicted=3, predicted=True, indirect=1),
            basis="SiFive FU540-C000 Manual v1p0, chapter 4: loads of words and double words 2, others 3, multiply 5 and not pipelined, "
            "misprediction 3. Assumed: divide 34 (2 to 65 by its operands), the wait for the L2 20")
