#!/usr/bin/env python3
"""Compares packets, decoded by the XTCE database alone, with what was put into them.

  compare_packets.py TELEMETRY.bin TELEMETRY.json [--all] [--commands COMMANDS.bin COMMANDS.json]

TELEMETRY.json has a message per line: {"packet": name, "fields": {field: value, ...}} (tests/support/print_message.hpp).
--all: every kind of packet that the database knows must occur, and every field must have had different values.
"""
import argparse
import collections
import json
import pathlib
import sys

import xtce
import xtce_decoder


def fail(text):
    raise SystemExit(f"compare_packets.py: {text}")


def same(decoded, written):
    """Bytes are hexadecimal digits in one and a list in the other."""
    return (list(bytes.fromhex(decoded)) if isinstance(decoded, str) else decoded) == written


def check_header(values, counts, number):
    apid, count = values["packet_apid"], values["packet_sequence_count"]
    expected = {"packet_version": 0, "packet_type": 0, "packet_secondary_header_flag": 1, "packet_sequence_flags": 3,
                "packet_sequence_count": counts[apid] % 2**14}
    for name, value in expected.items():
        if values[name] != value:
            fail(f"packet {number}: {name} is {values[name]} instead of {value}")
    counts[apid] = count + 1


def check_time(values, time_ns, number):
    time = values["packet_time"]
    limit = 0 if time_ns < 0 else 2**64 - 1 if time_ns // 10**9 >= 2**32 else None
    nanoseconds = (2 * time * 10**9 + 2**32) // 2**33
    if time != limit if limit is not None else nanoseconds != time_ns:
        fail(f"packet {number}: the time {time / 2**32} s does not show {time_ns} ns")


def compare_telemetry(database, packets, lines):
    seen = collections.defaultdict(lambda: collections.defaultdict(set))
    counts = collections.Counter()
    if len(packets) != len(lines):
        fail(f"{len(packets)} packets of {len(lines)} messages")
    for number, (packet, line) in enumerate(zip(packets, lines)):
        name, values = database.telemetry(packet)
        if name != line["packet"]:
            fail(f"packet {number}: {name} instead of {line['packet']}")
        check_header(values, counts, number)
        check_time(values, line["fields"]["time_ns"], number)
        fields = {key.removeprefix(name + "_"): value for key, value in values.items() if key.startswith(name + "_")}
        if list(fields) != list(line["fields"]):
            fail(f"packet {number}: {name}: fields {list(fields)} instead of {list(line['fields'])}")
        for field, value in fields.items():
            if not same(value, line["fields"][field]):
                fail(f"packet {number}: {name}: {field} is {value} instead of {line['fields'][field]}")
            seen[name][field].add(str(value))
    return seen


def check_all(database, seen):
    kinds = {name for name, container in database.containers.items()
             if xtce_decoder.tag(container) == "SequenceContainer" and container.get("abstract") != "true"}
    if kinds != set(seen):
        fail(f"packets of {sorted(seen)} instead of {sorted(kinds)}")
    for name, fields in seen.items():
        for field, values in fields.items():
            if len(values) < 5:
                fail(f"{name}: {field} had {len(values)} values only")


def compare_commands(database, data, lines):
    for line in lines:
        packet, data = data[:line["size"]], data[line["size"]:]
        name, values = database.command(packet)
        code = database.commands[name].find(f".//{xtce_decoder.XTCE}FixedValueEntry[@name='command_function_code']").get("binaryValue")
        read = b""
        for argument in database.commands[name].iter(xtce_decoder.XTCE + "Argument"):
            value = values[argument.get("name")]
            encoding = database.types[argument.get("argumentTypeRef")].find(xtce_decoder.XTCE + "IntegerDataEncoding")
            read += bytes.fromhex(value) if isinstance(value, str) else value.to_bytes(int(encoding.get("sizeInBits")) // 8, "big")
        if (int(code, 16), values["command_counter"], list(read)) != (line["function"], line["counter"], line["arguments"]):
            fail(f"{name}: {values} instead of {line}")
    if data:
        fail(f"{len(data)} bytes behind the last telecommand")


def lines_of(path):
    return [json.loads(line) for line in pathlib.Path(path).read_text().splitlines()]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("packets")
    parser.add_argument("messages")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--commands", nargs=2)
    options = parser.parse_args()
    database = xtce_decoder.Database(xtce.document())
    packets = list(xtce_decoder.packets(pathlib.Path(options.packets).read_bytes()))
    seen = compare_telemetry(database, packets, lines_of(options.messages))
    if options.all:
        check_all(database, seen)
    if options.commands:
        compare_commands(database, pathlib.Path(options.commands[0]).read_bytes(), lines_of(options.commands[1]))
    print(f"{len(packets)} packets hold what was written: {', '.join(f'{name}: {len(fields)} fields' for name, fields in seen.items())}")


if __name__ == "__main__":
    sys.exit(main())
