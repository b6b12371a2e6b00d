"""How many cycles the instructions of a program keep a processor's pipeline busy, as far as the program's text tells.

A pipeline starts instructions in the order of the text, up to `issue_width` in one cycle. An instruction waits until the registers
that it reads are ready and its unit is free. What depends on the run, taken branches and caches, is counted by count_cycles.c."""
import dataclasses
import re
import subprocess


@dataclasses.dataclass(frozen=True)
class Timing:
    """Of a kind of instruction."""
    occupies: int = 1  # cycles until the next instruction may start
    latency: int = 1  # cycles from the start until another may use the result
    pairs: bool = True  # may start in the same cycle as another one, where the pipeline starts two
    unit: str = ""  # one of a unit starts in a cycle, and the next one when it is free again
    busy: int = 1  # cycles from the start until the unit is free again
    branch: str = "-"  # 'c' conditional, 'a' the same with a delay slot that is annulled if it is not taken, 'j' jump or call, 'r' return
    # or call through a register
    writes: str = "first"  # the operand that is written: first, last, two (the first two), all (of a list), none


@dataclasses.dataclass(frozen=True)
class Cache:
    """Set-associative; the line used longest ago is replaced."""
    size_bytes: int
    ways: int
    line_bytes: int
    miss_cycles: int
    store_miss_cycles: int = 0
    allocates_on_store: bool = True

    @property
    def sets(self):
        return self.size_bytes // (self.ways * self.line_bytes)


@dataclasses.dataclass(frozen=True)
class WriteBuffer:
    """Of one store: cycles until it is empty again, after a store and after a double store."""
    cycles: int
    double_cycles: int


@dataclasses.dataclass(frozen=True)
class Branches:
    """Cycles beyond those of the instruction. `predicted`: by a table of two-bit counters; otherwise a taken branch costs `taken`."""
    taken: int = 0
    mispredicted: int = 0
    indirect: int = 0
    predicted: bool = False


@dataclasses.dataclass(frozen=True)
class Model:
    """Of a processor."""
    title: str
    syntax: object  # the module of its instruction set, with operands() and writes_flags()
    rules: tuple  # (regular expression of mnemonics, Timing), the first that matches counts
    issue_width: int = 1
    flags_latency: int = 1  # from an instruction that writes the condition codes to a conditional branch
    predicts_taken: bool = False  # a branch waits for the condition codes only if it is not taken
    fetches: Cache = None
    accesses: Cache = None
    write_buffer: WriteBuffer = None
    branches: Branches = Branches()
    basis: str = ""  # where the figures are from, and what is not known


@dataclasses.dataclass(frozen=True)
class Instruction:
    address: int
    mnemonic: str
    operands: str


def disassemble(objdump, program):
    """The instructions of a program's text, in the order of their addresses."""
    listing = subprocess.run([objdump, "-d", "--no-show-raw-insn", str(program)], check=True, capture_output=True, text=True).stdout
    found = []
    for line in listing.splitlines():
        match = re.match(r"^\s*([0-9a-f]+):\t([a-z]\S*)\s*(.*)$", line)
        if match:
            found.append(Instruction(int(match[1], 16), match[2], re.split(r"\s+[;<@!]|//|\s# ", match[3])[0].strip()))
    return found


def split(operands):
    """The operands, separated at the commas that are in no brackets."""
    found, depth, start = [], 0, 0
    for i, letter in enumerate(operands):
        depth += letter in "[{("
        depth -= letter in "]})"
        if letter == "," and depth == 0:
            found.append(operands[start:i].strip())
            start = i + 1
    return [*found, operands[start:].strip()] if operands else []


def read_and_written(operands, writes, names):
    """(registers read, registers written). names(operand): the registers in an operand. What is in brackets is read, except that
    `writes` is "all": then a list in braces is written."""
    count = {"first": 1, "two": 2, "none": 0, "last": 0, "all": 0}[writes]
    written = [index for index in range(min(count, len(operands))) if operands[index][0] not in "[("]
    if writes == "last" and operands and operands[-1][0] not in "[(":
        written = [len(operands) - 1]
    if writes == "all":
        written = [index for index, operand in enumerate(operands) if operand[0] == "{"] or ([0] if operands else [])
    return ([name for index, operand in enumerate(operands) if index not in written for name in names(operand)],
            list(dict.fromkeys(name for index in written for name in names(operands[index]))))


def rule_of(rules, instruction):
    """Of a pattern with a space the whole line has to match, of another one the mnemonic."""
    for pattern, timing in rules:
        if re.fullmatch(pattern, f"{instruction.mnemonic} {instruction.operands}" if " " in pattern else instruction.mnemonic):
            return timing
    raise ValueError(f"no timing for the instruction '{instruction.mnemonic} {instruction.operands}'")


@dataclasses.dataclass
class Cycles:
    """Of one instruction."""
    cycles: int  # that the pipeline is busy with it
    branch: str
    not_taken_cycles: int  # more if it is a branch that is not taken


def static_cycles(instructions, model):
    """Cycles per instruction, each after the one before it in the text."""
    found, ready, free = [], {}, {}
    frontier, started, may_pair = 0, 0, False  # the next cycle; instructions that start in the one before; whether the last one pairs
    for instruction in instructions:
        timing = rule_of(model.rules, instruction)
        read, written, occupies = model.syntax.operands(instruction, timing)
        earliest = max((ready.get(name, 0) for name in read), default=0)
        if timing.unit:
            earliest = max(earliest, free.get(timing.unit, 0))
        flags = ready.get("flags", 0) if timing.branch in "ca" else 0
        if not model.predicts_taken:
            earliest, flags = max(earliest, flags), 0
        if may_pair and timing.pairs and started < model.issue_width and earliest <= frontier - 1:
            start, started = frontier - 1, started + 1
        else:
            start, started = max(earliest, frontier), 1
        end = max(frontier, start + occupies)
        for name in written:
            ready[name] = start + timing.latency + (occupies - timing.occupies)
        if model.syntax.writes_flags(instruction):
            ready["flags"] = start + model.flags_latency
        if timing.unit:
            free[timing.unit] = start + max(timing.busy, occupies)
        may_pair = timing.pairs and occupies == 1
        found.append(Cycles(end - frontier, timing.branch, max(0, flags - start)))
        frontier = end
    return found


def as_table(instructions, cycles):
    """What count_cycles.c reads: a line per instruction."""
    return "".join(f"{instruction.address:x} {spent.cycles} {spent.branch} {spent.not_taken_cycles}\n"
                   for instruction, spent in zip(instructions, cycles))


def as_settings(model):
    """What count_cycles.c reads: the rest of the processor."""
    values = {"has_predictor": int(model.branches.predicted), "taken_cycles": model.branches.taken,
              "mispredicted_cycles": model.branches.mispredicted, "indirect_cycles": model.branches.indirect}
    for name, cache in (("fetch", model.fetches), ("data", model.accesses)):
        if cache:
            values.update({f"{name}_line_bytes": cache.line_bytes, f"{name}_sets": cache.sets, f"{name}_ways": cache.ways,
                           f"{name}_miss_cycles": cache.miss_cycles})
    if model.accesses:
        values.update(data_store_miss_cycles=model.accesses.store_miss_cycles,
                      data_allocates_on_store=int(model.accesses.allocates_on_store))
    if model.write_buffer:
        values.update(buffer_cycles=model.write_buffer.cycles, double_buffer_cycles=model.write_buffer.double_cycles)
    return "".join(f"{name} {value}\n" for name, value in values.items())
