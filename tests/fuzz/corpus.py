#!/usr/bin/env python3
"""Lists, unpacks and extends the inputs of a fuzz target.

  corpus.py list ARCHIVE                  prints the inputs that have a meaningful name, with their sizes in bytes
  corpus.py unpack ARCHIVE FOLDER         writes every input of the archive into FOLDER, one file each
  corpus.py add ARCHIVE FOLDER            adds the files of FOLDER whose contents the archive does not have
  corpus.py add ARCHIVE FILE --name NAME  adds an input written by hand, or replaces the input of that name

An archive (corpus/<target>.inputs) is a sequence of inputs, sorted by name. Each is a line "SIZE NAME", the SIZE bytes of
the input, and a line feed. tests/fuzz/replay.cpp reads the same format. An input that was not named by hand is named by the
SHA-1 of its content, as libFuzzer names it.
"""
import argparse
import hashlib
import pathlib
import re
import sys

_NAME = re.compile(r"[A-Za-z0-9_.-]{1,64}")
_SHA1 = re.compile(r"[0-9a-f]{40}")


def read_archive(path):
    """{name: bytes}; ValueError names the file, the offset and the fault."""
    data, at, inputs = path.read_bytes(), 0, {}
    while at < len(data):
        header, found, _ = data[at:at + 128].partition(b"\n")
        match = re.fullmatch(rb"(\d{1,9}) ([A-Za-z0-9_.-]{1,64})", header) if found else None
        if not match:
            raise ValueError(f"{path}: byte {at}: expected a line 'SIZE NAME'")
        size, name, start = int(match[1]), match[2].decode(), at + len(header) + 1
        if data[start + size:start + size + 1] != b"\n":
            raise ValueError(f"{path}: byte {start}: the {size} bytes of input '{name}' do not end with a line feed")
        if name in inputs:
            raise ValueError(f"{path}: byte {at}: input '{name}' is in the archive twice")
        inputs[name] = data[start:start + size]
        at = start + size + 1
    return inputs


def write_archive(path, inputs):
    for name in inputs:
        if not _NAME.fullmatch(name):
            raise ValueError(f"{path}: '{name}' is not a valid name: 1 to 64 letters, digits and _ . -")
    data = b"".join(b"%d %s\n%s\n" % (len(inputs[name]), name.encode(), inputs[name]) for name in sorted(inputs))
    path.write_bytes(data)


def unpack(archive, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in read_archive(archive).items():
        (folder / name).write_bytes(content)


def named(archive):
    """{name: bytes} of the inputs that were named by hand."""
    return {name: content for name, content in read_archive(archive).items() if not _SHA1.fullmatch(name)}


def add_named(archive, file, name):
    inputs = read_archive(archive) if archive.exists() else {}
    inputs[name] = file.read_bytes()
    write_archive(archive, inputs)


def add(archive, folder):
    """Number of inputs added."""
    inputs = read_archive(archive) if archive.exists() else {}
    contents = set(inputs.values())
    before = len(inputs)
    for path in sorted(folder.iterdir()):
        content = path.read_bytes()
        if content not in contents:
            contents.add(content)
            inputs[hashlib.sha1(content).hexdigest()] = content
    if len(inputs) > before:
        write_archive(archive, inputs)
    return len(inputs) - before


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    actions = parser.add_subparsers(dest="action", required=True)
    for action in ("list", "unpack", "add"):
        actions.add_parser(action).add_argument("archive", type=pathlib.Path)
    actions.choices["unpack"].add_argument("folder", type=pathlib.Path)
    actions.choices["add"].add_argument("path", type=pathlib.Path)
    actions.choices["add"].add_argument("--name")
    options = parser.parse_args(arguments)
    try:
        if options.action == "list":
            for name, content in named(options.archive).items():
                print(f"{len(content):8} {name}")
        elif options.action == "unpack":
            unpack(options.archive, options.folder)
        elif options.name is not None:
            add_named(options.archive, options.path, options.name)
        else:
            print(f"{add(options.archive, options.path)} inputs added to {options.archive.name}")
    except (OSError, ValueError) as error:
        print(f"corpus.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
