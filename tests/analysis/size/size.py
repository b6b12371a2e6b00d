#!/usr/bin/env python3
"""Lines and files of each folder, and how they have grown since the last release (release.csv; until the first one, since
November 2026).

  tests/analysis/size/size.py            the table
  tests/analysis/size/size.py --total    two lines: product and tests
  tests/analysis/size/size.py --write    makes the present sizes those of the release: with each release

Lines are those of code: sources, scripts, build files, pages. Files are all that git keeps.
"""
import csv
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
RELEASE = HERE / "release.csv"
CODE = re.compile(r"\.(c|h|cpp|hpp|inc|S|ld|idl|cmake|py|sh|js|mjs|html|css|toml|in)$|(^|/)(CMakeLists\.txt|run|adopt|publish)$")
TESTS = "tests"


def folder_of(path):
    """The first two folders of a path: gnc/nn; "." for the files of the root."""
    return "/".join(path.split("/")[:-1][:2]) or "."


def sizes(root):
    """Files and lines of code by folder, of the files that git keeps."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=root, capture_output=True, text=True, check=True).stdout
    found = {}
    for path in filter(None, listed.split("\0")):
        if not (root / path).is_file():
            continue  # deleted, and not committed yet
        files, lines = found.get(folder_of(path), (0, 0))
        code = (root / path).read_bytes().count(b"\n") if CODE.search(path) else 0
        found[folder_of(path)] = (files + 1, lines + code)
    return found


def read_release(path=RELEASE):
    with open(path, newline="") as file:
        return {row["folder"]: (int(row["files"]), int(row["lines"])) for row in csv.DictReader(file)}


def totals(found):
    """Of the product and of the tests."""
    made = {"product": (0, 0), TESTS: (0, 0)}
    for folder, (files, lines) in found.items():
        part = TESTS if folder.split("/")[0] == TESTS else "product"
        made[part] = (made[part][0] + files, made[part][1] + lines)
    return made


def line(name, now, before):
    return f"  {name:<24} {now[1]:>7,} lines {now[1] - before[1]:>+7,}   {now[0]:>5,} files {now[0] - before[0]:>+5,}"


def table(now, before):
    return [line(name, now.get(name, (0, 0)), before.get(name, (0, 0))) for name in sorted(now.keys() | before.keys())]


def main(arguments):
    if arguments not in ([], ["--total"], ["--write"]):
        sys.exit(__doc__)
    now = sizes(ROOT)
    if arguments == ["--write"]:
        rows = "".join(f"{folder},{files},{lines}\n" for folder, (files, lines) in sorted(now.items()))
        RELEASE.write_text("folder,files,lines\n" + rows)
        return
    before = read_release()
    if arguments == []:
        print("\n".join(table(now, before)) + "\n")
    print("\n".join(table(totals(now), totals(before))))


if __name__ == "__main__":
    main(sys.argv[1:])
