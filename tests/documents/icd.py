#!/usr/bin/env python3
"""Generates the tables of docs/icd.md from the code, and compares the messages with the interface definition.

  tests/documents/icd.py             fails if a table differs from the code
  tests/documents/icd.py --messages  fails if a message in hal/messages and its topic in the IDL have different fields
  tests/documents/icd.py --write     writes the tables to docs/icd.md
"""
import collections
import pathlib
import re
import sys
import typing

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs/icd.md"
MESSAGES = "hal/messages/"
TELECOMMANDS = MESSAGES + "telecommands.inc"
IDL = "hal/dds/idl/tumblesight.idl"
BYTES = {"short": 2, "octet": 1, "unsigned short": 2, "long": 4, "unsigned long": 4, "float": 4, "long long": 8}


def source(path):
    return (ROOT / path).read_text()


def table(header, rows):
    return "\n".join(["| " + " | ".join(header) + " |", "|" + "---|" * len(header),
                      *("| " + " | ".join(str(cell) for cell in row) + " |" for row in rows)])


def upper(name):
    """kModelActivated -> MODEL_ACTIVATED"""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name.removeprefix("k")).upper()


_COMMENT = re.compile(r"//\s?(.*)$")


def documented(body):
    """[(statement, comment)] of a struct or enumeration. A comment is above its statement or behind it, and may be wrapped by
    clang-format; an empty line ends a comment that belongs to no statement."""
    found, statement, above, column = [], "", [], None
    for line in body.splitlines():
        code, comment = line.split("//", 1)[0].strip(), _COMMENT.search(line)
        if not code and comment and column == line.index("//"):  # continues the comment behind the previous statement
            found[-1][1].append(comment[1])
            continue
        column = None
        if not code:
            above = above + [comment[1]] if comment else []
            continue
        statement = f"{statement} {code}".strip()
        behind = [comment[1]] if comment else []
        if statement.endswith((",", ";")):
            found.append((statement, above + behind))
            statement, above, column = "", [], line.index("//") if comment else None
        else:
            above = above + behind
    return [(statement, " ".join(comment).strip()) for statement, comment in found]


def enum(path, name):
    """[(enumerator, value, comment)]"""
    body = re.search(rf"enum class {name} [^{{]*\{{(.*?)\}};", source(path), re.S)[1]
    if "events.inc" in body:
        return [(entry, number, comment) for entry, number, _, comment in event_rows()]
    values, value = [], -1
    for statement, comment in documented(body if "\n" in body else body.strip().replace(", ", ",\n") + ","):
        entry, number = re.fullmatch(r"(k\w+)(?: = (\d+))?,", statement).groups()
        value = int(number) if number else value + 1
        values.append((entry, value, comment))
    return values


def array_rows(path, name):
    """The rows of a constexpr table, each a list of its cells."""
    body = re.search(rf"{name}\{{\{{(.*?)\}}\}};", source(path), re.S)[1]
    return [[cell.strip() for cell in row.split(",")] for row in re.findall(r"\{([^{}]*)\}", body)]


def last(cell):
    return cell.rsplit("::", 1)[-1]


def transitions():
    return table(["from", "cause", "to"],
                 [[upper(last(a)), upper(last(b)), upper(last(c))] for a, b, c in array_rows("fsw/app/modes.hpp", "kTransitions")])


def causes():
    return table(["number", "cause", ""], [[value, upper(name), comment] for name, value, comment in enum(MESSAGES + "mode.hpp", "Cause")])


def reset_causes():
    return table(["number", "reset cause", ""], [[value, upper(name), comment] for name, value, comment in enum(MESSAGES + "reset_cause.hpp", "ResetCause")])


def store_statuses():
    return table(["number", "StoreStatus", ""],
                 [[value, upper(name), comment] for name, value, comment in enum(MESSAGES + "store_status.hpp", "StoreStatus")])


def store_health():
    return table(["number", "store_health", ""],
                 [[value, upper(name), comment] for name, value, comment in enum(MESSAGES + "store_status.hpp", "StoreHealth")])


def state_losses():
    return table(["bit's value", "StateLoss", "lost"],
                 [[value, upper(name), comment] for name, value, comment in enum(MESSAGES + "store_status.hpp", "StateLoss")])


class Argument(typing.NamedTuple):
    """One of a telecommand. bits: of a number; None: it is data of least to most bytes."""
    name: str
    bits: int | None
    enumeration: str | None
    least: int
    most: int
    meaning: str

    @property
    def text(self):
        if self.bits is None:
            kind = f"{self.name} {self.least if self.least == self.most else f'{self.least}...{self.most}'} bytes"
        else:
            kind = f"{self.enumeration or self.name} u{self.bits}"
        if not self.meaning or self.enumeration:
            return kind
        return kind + (" " if self.meaning.split()[0] in ("in", "at", "of") else ": ") + self.meaning


def arguments_of(text):
    """The arguments of a row of telecommands.inc."""
    found = []
    for kind, inside in re.findall(r'TUMBLESIGHT_(NUMBER|ENUMERATOR|BYTES)\(((?:[^"()]|"[^"]*")*)\)', text):
        *values, meaning = re.fullmatch(r'(.*), "(.*)"', inside).groups()
        values = values[0].split(", ")
        if kind == "NUMBER":
            found.append(Argument(values[0], 8 * int(values[1]), None, int(values[2]), int(values[3]), meaning))
        elif kind == "ENUMERATOR":
            found.append(Argument(values[0], 8, values[1], int(values[2]), int(values[3]), meaning))
        else:
            found.append(Argument(values[0], None, None, int(values[1]), int(values[2]), meaning))
    return found


def function_rows():
    """[(code, name, least argument bytes, most, arguments, modes)] of the telecommands."""
    rows = []
    for line in source(TELECOMMANDS).splitlines():
        if line.startswith("TUMBLESIGHT_TELECOMMAND("):
            code, name, modes, rest = re.fullmatch(r"TUMBLESIGHT_TELECOMMAND\((\d+), (\w+), ([\w |]+), (.*)\)", line).groups()
            arguments = arguments_of(rest)
            least, most = (sum(getattr(a, end) if a.bits is None else a.bits // 8 for a in arguments) for end in ("least", "most"))
            rows.append((int(code), upper("k" + name), least, most, arguments,
                         "any" if modes == "kAlways" else ", ".join(m.strip().removeprefix("kIn").upper() for m in modes.split("|"))))
    return rows


def functions():
    return table(["code", "function", "argument bytes", "arguments", "modes"],
                 [[code, name, least if least == most else f"{least}…{most}", ", ".join(a.text for a in arguments) or "-", modes]
                  for code, name, least, most, arguments, modes in function_rows()])


def refusals():
    events = {value: name for name, value, _, _ in event_rows()}
    return table(["number", "event", "refused because"],
                 [[value, event, f"{upper(name)}{': ' + comment if comment else ''}"]
                  for name, value, comment in enum(MESSAGES + "command_refusal.hpp", "CommandRefusal")
                  for event in [value + (60 if value < 10 else 90)] if event in events])


def validity():
    return table(["number", "validity", ""], [[value, upper(name), comment] for name, value, comment in enum(MESSAGES + "attitude_report.hpp", "Validity")])


PARAMETER = re.compile(r"TUMBLESIGHT_PARAMETER\((\w+?)(?:_([a-z]+))?, ([\d']+), ([\d']+), ([\d']+)\)  // (.+)")


def pose_doubts():
    bits = re.findall(r"((?:// .*\n)+)inline constexpr std::uint8_t kPoseDoubt(\w+) = (\d+);", source(MESSAGES + "attitude_report.hpp"))
    return table(["bit's value", "pose_doubts", ""],
                 [[value, upper(name), " ".join(line[3:] for line in comment.splitlines()).removesuffix(".")] for comment, name, value in bits])


def parameters():
    """[(field, name, unit, lowest, highest, initial, meaning)] of the rows."""
    rows = [line for line in source("fsw/config/parameters.inc").splitlines() if line.startswith("TUMBLESIGHT_PARAMETER")]
    wrong = [line for line in rows if not PARAMETER.fullmatch(line)]
    if wrong:
        raise SystemExit(f"fsw/config/parameters.inc: '{wrong[0]}' is not NAME, LOWEST, HIGHEST, INITIAL and a comment in the same line")
    return [(field, match[1] + (f"_{match[2]}" if match[2] else ""), match[2] or "-",
             *(match[i].replace("'", " ") for i in (3, 4, 5)), match[6])
            for field, match in enumerate(map(PARAMETER.fullmatch, rows))]


def parameter_rows():
    return table(["field", "parameter", "unit", "lowest", "highest", "at start", "meaning"], parameters())


def table_layout():
    """The table as it is uplinked."""
    first, rules = len(parameters()), len(array_rows("fsw/config/fault_rules.hpp", "kFaultRules"))
    fields = first + rules
    return table(["offset", "bits", "content"],
                 [[0, "unsigned 16", "format version, 1"], [2, "unsigned 16", f"number of fields, {fields}"],
                  [4, f"unsigned 32 × {first}", f"fields 0 to {first - 1}: the parameters, in the order of their table"],
                  [4 + 4 * first, f"unsigned 32 × {rules}", f"fields {first} to {fields - 1}: the rules of the faults (2.5), in their order: "
                   "cycles, window, good cycles, Response, one byte each"],
                  [4 + 4 * fields, "unsigned 32", "CRC-32 of everything before it"]]) + f"\n\n{8 + 4 * fields} bytes."


def table_status():
    return table(["number", "table_status", ""],
                 [[value, upper(name), comment] for name, value, comment in enum(MESSAGES + "table_status.hpp", "TableStatus")])


def dumped_memory():
    return table(["number", "memory of MEMORY_DUMP", ""],
                 [[value, upper(name), comment] for name, value, comment in enum(MESSAGES + "memory_dump.hpp", "DumpedMemory")])


def faults():
    meaning = {name: (value, comment) for name, value, comment in enum(MESSAGES + "fault.hpp", "Fault")}
    return table(["number", "fault", "is", "persists after cycles with it", "within", "over after cycles without it", "response",
                  "can be changed"],
                 [[meaning[last(name)][0], upper(last(name)), meaning[last(name)][1], cycles, window, good, upper(last(response)),
                   "yes" if disabled == "true" else "no"]
                  for name, cycles, window, good, response, disabled in array_rows("fsw/config/fault_rules.hpp", "kFaultRules")])


def responses():
    return table(["number", "response", "what is done"],
                 [[value, upper(name), comment] for name, value, comment in enum(MESSAGES + "fault.hpp", "Response")])


def event_rows():
    """[(name, number, severity, comment)]"""
    path = MESSAGES + "events.inc"
    rows = [line for line in source(path).splitlines() if line.startswith("TUMBLESIGHT_EVENT")]
    found = [re.fullmatch(r'TUMBLESIGHT_EVENT\((\w+), (\d+), (\w+), "[^"]+"\)(?:  // (.+))?', row) for row in rows]
    wrong = [row for row, match in zip(rows, found) if not match]
    if wrong:
        raise SystemExit(f"{path}: '{wrong[0]}' is not NAME, NUMBER, SEVERITY, \"TEXT\" and a comment in the same line")
    return [("k" + match[1], int(match[2]), match[3], match[4] or "") for match in found]


def events():
    rows = []
    for name, value, severity, comment in event_rows():
        arguments = re.search(r"\[(.*?)\]", comment)
        rows.append([value, severity.lower(), upper(name), arguments[1] if arguments else "as 60"])
    return table(["id", "severity", "event", "arguments"], rows)


def constants():
    return {name: int(value) for name, value in re.findall(r"const [\w ]+ (\w+) = (\d+);", source(IDL))}


# Topic: the message that its sample carries, besides run_id and k.
CARRIED = {"Attitude": ("attitude_report.hpp", "AttitudeReport"), "Telemetry": ("telemetry.hpp", "Telemetry"), "Event": ("event.hpp", "Event"),
           "MemoryDump": ("memory_dump.hpp", "MemoryDump")}


Field = collections.namedtuple("Field", "name bits signed count enum comment")  # count: None: not an array


def message_constant(text, scope=""):
    """The value of a number or of a constant of the messages, which `scope` or a header of theirs defines."""
    if text.isdigit():
        return int(text)
    for place in (scope, *(path.read_text() for path in sorted((ROOT / MESSAGES).glob("*.hpp")))):
        found = re.search(rf"constexpr [\w:]+ {text} = (\w+);", place)
        if found:
            return message_constant(found[1], place)
    raise SystemExit(f"{MESSAGES} has no constant {text}")


def message_layout(topic):
    """[Field] of the message that a topic carries, in its order."""
    path, name = CARRIED[topic]
    body = re.search(rf"struct {name} \{{\n(.*?)\n\}};", source(MESSAGES + path), re.S)[1]
    fields = []
    for statement, comment in documented(body):
        if statement.startswith("static "):
            continue
        kind, field = re.fullmatch(r"([\w:<>, ]+) (\w+)(?: = .*|\{.*\})?;", statement).groups()
        array = re.fullmatch(r"std::array<([\w:]+), (\w+)>", kind)
        element, count = (array[1], message_constant(array[2], body)) if array else (kind, None)
        is_enum = element[0].isupper()  # an enumeration with a table in this document
        number = underlying_type(element) if is_enum else element
        sign, bits = re.fullmatch(r"std::(u?)int(\d+)_t", number).groups()
        fields.append(Field(field, int(bits), not sign, count, element if is_enum else None,
                            " ".join(filter(None, (is_enum and element, comment.removesuffix("."))))))
    return fields


def enum_path(name):
    """The header of the messages that defines an enumeration."""
    for path in sorted((ROOT / MESSAGES).glob("*.hpp")):
        if f"enum class {name} :" in path.read_text():
            return MESSAGES + path.name
    raise SystemExit(f"{MESSAGES} has no enumeration {name}")


def underlying_type(name):
    return re.search(rf"enum class {name} : ([\w:]+) ", source(enum_path(name)))[1]


def message_fields(topic):
    """{field: comment} of the message that a topic carries, in its order."""
    return {field.name: field.comment for field in message_layout(topic)}


def sample_fields(topic):
    """[(type, field, count, comment)] of a topic's sample."""
    body = re.search(rf"@final struct {topic} \{{(.*?)\}};", source(IDL), re.S)[1]
    return [re.match(r"\s*(?:@key )?([\w ]+?) (\w+)(?:\[(\w+)\])?;\s*(?://\s*(.*))?", line).groups() for line in body.strip().splitlines()]


def check_messages():
    """The messages have the fields of their samples, in the same order."""
    for topic, (path, name) in CARRIED.items():
        sample = [field for _, field, _, _ in sample_fields(topic) if field not in ("run_id", "k")]
        message = list(message_fields(topic))
        if message != sample:
            at = next(i for i, pair in enumerate(zip(message + ["(end)"], sample + ["(end)"])) if pair[0] != pair[1])
            raise SystemExit(f"{MESSAGES}{path}: {name} has '{(message + ['(end)'])[at]}' where {topic} of {IDL} has "
                             f"'{(sample + ['(end)'])[at]}': both need the same fields in the same order")


def struct(name):
    """The fields of a topic with their places in the serialized sample (XCDR1, final)."""
    about, rows, offset = message_fields(name) if name in CARRIED else {}, [], 0
    for kind, label, count, comment in sample_fields(name):
        offset += -offset % BYTES[kind]
        items = constants().get(count) or int(count or 1)
        rows.append([offset, f"{kind}{f' × {items}' if items > 1 else ''}", f"`{label}`", comment or about.get(label, "")])
        offset += BYTES[kind] * items
    return table(["offset", "type", "field", ""], rows) + f"\n\n{offset} bytes."


# Packet field: bits is None for the part of variable size; value: None, or the only value it may have.
PacketField = collections.namedtuple("PacketField", "name bits value")


def packet_fields(path):
    """[PacketField] of the table `offset bytes field` in the comment at the head of a source file. A row is one field, or fields
    of a number of bits; 'name 5' and 'name, 5' have the value 5."""
    fields = []
    for size, text in re.findall(r"^//  +(?:\d+|\d+ \+ n)  +(\d+|n)  (.*)$", source(path), re.M):
        parts = re.findall(r"(?:, )?(.+?) \((\d+)(?: bits?)?\)", text)
        if not parts:
            text = text.removeprefix("trailer: ")
            name = re.fullmatch(r"[\w ]+, \d+", text) or re.split(r"[:,]| that ", text)
            parts = [(name[0] if not text.startswith("first ") else "authentication code", 8 * int(size) if size != "n" else None)]
        for name, bits in parts:
            name, value = re.fullmatch(r"(.+?)(?:,? (0x[0-9A-F]+|\d+))?", name).groups()
            fields.append(PacketField(name.strip().replace(" ", "_"), bits and int(bits), value and int(value, 0)))
    return fields


ENCODER = "hal/packets/telemetry_encoder.hpp"
COMMAND_PACKET = MESSAGES + "command_packet.hpp"


def packet_header_bits():
    fields = packet_fields(ENCODER)
    return sum(field.bits for field in fields[:[field.bits for field in fields].index(None)])


def apids():
    """{topic: default APID of its packet}"""
    body = re.search(r"struct PacketApids \{(.*?)\};", source(ENCODER), re.S)[1]
    numbers = {name: int(value, 16) for name, value in re.findall(r"(\w+) = (0x[0-9A-F]+);", body)}
    return {topic: numbers[upper(name).lower()] for topic, (_, name) in CARRIED.items()}


def packet_bytes(topic):
    fixed = sum(field.bits or 0 for field in packet_fields(ENCODER))
    return (fixed + sum(field.bits * (field.count or 1) for field in message_layout(topic))) // 8


def packets():
    return table(["packet", "APID", "bytes", "sent"],
                 [[CARRIED[topic][1], f"0x{apid:03X}", packet_bytes(topic),
                   {"Attitude": "each cycle", "Telemetry": "each cycle", "Event": "with each event", "MemoryDump": "after MEMORY_DUMP"}[topic]]
                  for topic, apid in apids().items()])


def packet(topic):
    rows, offset = [], packet_header_bits() // 8
    for field in message_layout(topic):
        kind = f"{'signed' if field.signed else 'unsigned'} {field.bits}{f' × {field.count}' if field.count else ''}"
        rows.append([offset, kind, f"`{field.name}`", field.comment])
        offset += field.bits * (field.count or 1) // 8
    return table(["offset", "bits", "field", ""], [*rows, [offset, "unsigned 16", "error control", ""]])


TABLES = {"transitions": transitions, "causes": causes, "reset causes": reset_causes, "store statuses": store_statuses, "store health": store_health, "state losses": state_losses, "functions": functions, "refusals": refusals, "validity": validity, "pose doubts": pose_doubts, "parameters": parameter_rows, "parameter table": table_layout, "table status": table_status, "faults": faults,
          "responses": responses, "dumped memory": dumped_memory, "events": events,
          "packets": packets, **{f"packet {CARRIED[topic][1]}": (lambda topic=topic: packet(topic)) for topic in CARRIED},
          **{f"topic {name}": (lambda name=name: struct(name))
             for name in ("Command", "Attitude", "Telemetry", "Event", "MemoryDump", "StepDone", "LidarFrame", "Navigation", "Step", "Hello")}}


def with_tables(text):
    missing = [name for name in TABLES if f"<!-- {name} -->" not in text]
    if missing:
        raise SystemExit(f"docs/icd.md has no place for: {', '.join(missing)}")
    for name, make in TABLES.items():
        text = re.sub(rf"<!-- {name} -->\n.*?<!-- end -->", lambda _: f"<!-- {name} -->\n{make()}\n<!-- end -->", text, flags=re.S)
    return text


def main():
    check_messages()
    if sys.argv[1:] == ["--messages"]:
        return 0
    text = DOCUMENT.read_text()
    wanted = with_tables(text)
    if sys.argv[1:] == ["--write"]:
        DOCUMENT.write_text(wanted)
        return 0
    for line, (is_now, should_be) in enumerate(zip(text.splitlines(), wanted.splitlines()), 1):
        if is_now != should_be:
            print(f"docs/icd.md:{line}: is '{is_now}', but the code gives '{should_be}'; run tests/documents/icd.py --write")
            return 1
    return 0 if text == wanted else 1


if __name__ == "__main__":
    sys.exit(main())
