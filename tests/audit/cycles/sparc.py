"""LEON3 and LEON4 (SPARC V8)."""
import re
import sys

from cycles.pipeline import Cache, Model, Timing, WriteBuffer, read_and_written, split

_REGISTER = re.compile(r"%(?:[goli][0-7]|sp|fp|f[0-9]+|y)")


def writes_flags(instruction):
    return instruction.mnemonic.endswith("cc") or instruction.mnemonic in ("cmp", "tst", "btst", "inccc", "deccc")


def operands(instruction, timing):
    """(registers read, registers written, cycles that it occupies the pipeline)"""
    parts = split(instruction.operands)
    if instruction.mnemonic.startswith("clr") and not instruction.operands.startswith("["):
        return [], parts, 1  # of a register, not of memory
    read, written = read_and_written(parts, timing.writes, _REGISTER.findall)
    if instruction.mnemonic in ("inc", "dec", "neg", "not", "inccc", "deccc"):
        read = read + written
    if instruction.mnemonic.startswith("ldd") and written and written[0][1] in "goli":
        written = [written[0][:2] + str(int(written[0][2]) + 1)]  # the register with the odd number is ready last
    if instruction.mnemonic.startswith("st") and not parts[0].startswith("["):
        read = _REGISTER.findall(parts[-1])  # what is stored is read later than the address
    return read, written, timing.occupies


def rules(load, load_latency, double_load, store, double_store, multiply, multiply_latency, jump, divide=36):
    return (
        (r"ldstub.*|swap.*|casx?a?", Timing(store + 1, store + 2, writes="last")),
        (r"ldd.*", Timing(double_load, double_load + load_latency - load, writes="last")),
        (r"ld.*", Timing(load, load_latency, writes="last")),
        (r"std.*", Timing(double_store, writes="none")),
        (r"st.*|clr[bh]?", Timing(store, writes="none")),
        (r"[us]mul(cc)?", Timing(multiply, multiply_latency, writes="last")),
        (r"[us]div(cc)?", Timing(divide, divide, writes="last")),
        (r"jmpl?|rett?|retl", Timing(jump, branch="r", writes="none")),
        (r"cmp|tst|btst|t[a-z]{1,3}|unimp|illtrap|flush|nop", Timing(writes="none")),
        (r"call %.*", Timing(jump, branch="r", writes="none")),
        (r"call|ba?", Timing(branch="j", writes="none")),
        (r"ba?,a.*", Timing(2, branch="j", writes="none")),  # with its delay slot, which is annulled
        (r"f?b[a-z]+,a.*", Timing(branch="a", writes="none")),
        (r"f?b[a-z]+(,.*)?", Timing(branch="c", writes="none")),
        (r"[a-z0-9]+", Timing(writes="last")),
    )


_SYNTAX = sys.modules[__name__]
_FETCHES = Cache(16384, 4, 32, 17)
_ACCESSES = Cache(16384, 4, 16, 14, allocates_on_store=False)
_WRITES = WriteBuffer(5, 9)
_MANUAL = ("GRLIB IP Core User's Manual, LEON3, *Instruction timing*, and GRLIB 2025.2 in simulation: load 1 and a wait of 1 when used at once, "
           "double load 2, store 2, double store 3, divide 36, JMPL 3, a branch within 2 cycles of its condition waits; a write buffer of one "
           "store. Assumed is a fast static RAM: 14 cycles a miss, and 5 until a store is written, 9 for a double one")
SLOW = Model("LEON3, slow multiplier", _SYNTAX, rules(1, 2, 2, 2, 3, 5, 6, 3), flags_latency=3, fetches=_FETCHES, accesses=_ACCESSES,
             write_buffer=_WRITES,
             basis=_MANUAL + "; the multiplier of 16 × 16 bits with pipeline registers: 5 cycles, latency 6 (4 and 5 without them); no branch "
             "prediction")
FAST = Model("LEON3, fast multiplier", _SYNTAX, rules(1, 2, 2, 2, 3, 1, 2, 3), flags_latency=3, predicts_taken=True, fetches=_FETCHES,
             accesses=_ACCESSES, write_buffer=_WRITES,
             basis="as before, with the pipelined multiplier of 32 × 32 bits (1, latency 2) and static branch prediction, "
             "as in GR740 (GR740 User's Manual, 6.2)")
# To compare the model with SIS 2.30, for no processor: the latencies of SIS, which are an ERC32's, without caches.
SIS = Model("SIS 2.30", _SYNTAX, rules(2, 3, 3, 3, 4, 5, 5, 2, divide=35))
