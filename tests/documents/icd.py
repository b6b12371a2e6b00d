#!/usr/bin/env python3
"""The tables of docs/icd.md, out of the code that they describe.

  tests/documents/icd.py           fails where the document and the code differ
  tests/documents/icd.py --write   writes the tables into the document
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs/icd.md"
BYTES = {"octet": 1, "unsigned short": 2, "long": 4, "unsigned long": 4, "float": 4, "long long": 8}


def source(path):
    return (ROOT / path).read_text()


def table(header, rows):
    return "\n".join(["| " + " | ".join(header) + " |", "|" + "---|" * len(header),
                      *("| " + " | ".join(str(cell) for cell in row) + " |" for row in rows)])


def upper(name):
    """kModelActivated -> MODEL_ACTIVATED"""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name.removeprefix("k")).upper()


def enum(path, name):
    """[(enumerator, value, comment)]"""
    body = re.search(rf"enum class {name} [^{{]*\{{(.*?)\}};", source(path), re.S)[1]
    values, value = [], -1
    for entry, number, comment in re.findall(r"^\s*(k\w+)(?: = (\d+))?,?[ \t]*(?://[ \t]*(.*))?$", body, re.M):
        value = int(number) if number else value + 1
        values.append((entry, value, comment.strip()))
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
    return table(["number", "cause", ""], [[value, upper(name), comment] for name, value, comment in enum("fsw/app/modes.hpp", "Cause")])


def functions():
    codes = {name: (value, comment) for name, value, comment in enum("fsw/app/telecommand.hpp", "FunctionCode")}
    limits = {"kMaxCommandArgumentBytes": "1028"}
    rows = []
    for function, least, most, modes in array_rows("fsw/app/command_gate.hpp", "kCommandRules"):
        value, comment = codes[last(function)]
        most = limits.get(most, most)
        rows.append([value, upper(last(function)), least if least == most else f"{least}…{most}", comment or "-",
                     "any" if modes == "kAlways" else ", ".join(m.strip().removeprefix("kIn").upper() for m in modes.split("|"))])
    return table(["code", "function", "argument bytes", "arguments", "modes"], rows)


def refusals():
    events = {value: name for name, value, _ in enum("fsw/app/events.hpp", "EventId")}
    return table(["number", "event", "refused because"],
                 [[value, 60 + value, f"{upper(name)}{': ' + comment if comment else ''}"]
                  for name, value, comment in enum("fsw/app/telecommand.hpp", "CommandRefusal") if 60 + value in events])


def limits():
    meaning = {name: (value, comment) for name, value, comment in enum("fsw/config/limits.hpp", "Limit")}
    return table(["number", "limit", "lowest", "highest", "at start", "meaning"],
                 [[meaning[last(name)][0], last(name)[1:], *(number.replace("'", " ") for number in numbers), meaning[last(name)][1]]
                  for name, *numbers in array_rows("fsw/config/limits.hpp", "kLimitRules")])


def faults():
    meaning = {name: (value, comment) for name, value, comment in enum("fsw/config/fault_rules.hpp", "Fault")}
    return table(["number", "fault", "is", "cycles", "response", "can be disabled"],
                 [[meaning[last(name)][0], upper(last(name)), meaning[last(name)][1], cycles, upper(last(response)),
                   "yes" if disabled == "true" else "no"]
                  for name, cycles, response, disabled in array_rows("fsw/config/fault_rules.hpp", "kFaultRules")])


def responses():
    return table(["number", "response", "what is done"],
                 [[value, upper(name), comment] for name, value, comment in enum("fsw/config/fault_rules.hpp", "Response")])


def events():
    ids = {name: (value, comment) for name, value, comment in enum("fsw/app/events.hpp", "EventId")}
    rows = []
    for name, severity in array_rows("fsw/app/events.hpp", "kEventRules"):
        value, comment = ids[last(name)]
        arguments = re.search(r"\[(.*?)\]", comment)
        rows.append([value, last(severity)[1:].lower(), upper(last(name)), arguments[1] if arguments else "as 60"])
    return table(["id", "severity", "event", "arguments"], rows)


def constants():
    return {name: int(value) for name, value in re.findall(r"const [\w ]+ (\w+) = (\d+);", source("hal/dds/idl/tumblesight.idl"))}


def housekeeping_comments():
    return dict(re.findall(r"^  std::\S+ (\w+)(?: = 0|\{\});\s*// (.*)$", source("hal/link.hpp"), re.M))


def struct(name):
    """The fields of a topic with their places in the serialised sample (XCDR1, final)."""
    body = re.search(rf"@final struct {name} \{{(.*?)\}};", source("hal/dds/idl/tumblesight.idl"), re.S)[1]
    about, rows, offset = housekeeping_comments() if name == "Telemetry" else {}, [], 0
    for line in body.strip().splitlines():
        field = re.match(r"\s*(?:@key )?([\w ]+?) (\w+)(?:\[(\w+)\])?;\s*(?://\s*(.*))?", line)
        kind, label, count, comment = field.groups()
        offset += -offset % BYTES[kind]
        items = constants().get(count) or int(count or 1)
        rows.append([offset, f"{kind}{f' × {items}' if items > 1 else ''}", f"`{label}`", comment or about.get(label, "")])
        offset += BYTES[kind] * items
    return table(["offset", "type", "field", ""], rows) + f"\n\n{offset} bytes."


TABLES = {"transitions": transitions, "causes": causes, "functions": functions, "refusals": refusals, "limits": limits, "faults": faults,
          "responses": responses, "events": events,
          **{f"topic {name}": (lambda name=name: struct(name))
             for name in ("Command", "Attitude", "Telemetry", "Event", "ModelDump", "StepDone", "LidarFrame", "Step", "Hello")}}


def with_tables(text):
    missing = [name for name in TABLES if f"<!-- {name} -->" not in text]
    if missing:
        raise SystemExit(f"docs/icd.md has no place for: {', '.join(missing)}")
    for name, make in TABLES.items():
        text = re.sub(rf"<!-- {name} -->\n.*?<!-- end -->", lambda _: f"<!-- {name} -->\n{make()}\n<!-- end -->", text, flags=re.S)
    return text


def main():
    text = DOCUMENT.read_text()
    wanted = with_tables(text)
    if sys.argv[1:] == ["--write"]:
        DOCUMENT.write_text(wanted)
        return 0
    for line, (is_now, should_be) in enumerate(zip(text.splitlines(), wanted.splitlines()), 1):
        if is_now != should_be:
            print(f"docs/icd.md:{line}: '{is_now}' should be '{should_be}' as the code has it; tests/documents/icd.py --write")
            return 1
    return 0 if text == wanted else 1


if __name__ == "__main__":
    sys.exit(main())
