#!/usr/bin/env python3
"""Compares docs/mcdc.md with the decisions of the folders and files in SCOPE and with their unit tests. Run by ctest."""
import argparse
import collections
import pathlib
import re
import sys

from decisions import decisions_in

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCOPE = ("fsw/app", "fsw/config", "gnc/estimation", "gnc/registration/pose_choice.cpp", "gnc/registration/pose_evidence.cpp",
         "gnc/registration/pose_evidence.hpp", "gnc/registration/pose_tracker.cpp")
TESTS = ("tests/unit/fsw/app", "tests/unit/gnc/estimation", "tests/unit/gnc/registration")
_TEST = re.compile(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", re.M)
_CASE = re.compile(r"(\w+\.\w+|none)(?: \([^()]+\))?")
NONE = "none"

# A row of the page. `true`, `false`: the tests in which the condition has this value and determines the decision, or NONE.
Row = collections.namedtuple("Row", "line path function decision condition true false")


def sources(root):
    return [path for one in SCOPE for path in ([root / one] if (root / one).is_file() else sorted((root / one).glob("*.[ch]pp")))]


def rows_of(root, wrong):
    rows, path, function, decision = [], "", "", ""
    for number, line in enumerate((root / "docs/mcdc.md").read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("## "):
            path = line[3:]
        if not line.startswith("| ") or line.startswith("| function "):
            continue
        cells = [cell.strip().strip("`").replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        cases = [_CASE.fullmatch(cell) for cell in cells[3:]]
        if len(cells) != 5 or not all(cases) or NONE in cells[3:]:
            wrong.append(f"docs/mcdc.md:{number}: a row needs five cells, and the last two a test each: "
                         "Suite.Name, Suite.Name (row) or none (reason)")
            continue
        function, decision = cells[0] or function, cells[1] or decision
        rows.append(Row(number, path, function, decision, cells[2], cases[0][1], cases[1][1]))
    return rows


def tests_in(folder):
    return {".".join(names) for path in folder.glob("*.cpp") for names in _TEST.findall(path.read_text(encoding="utf-8"))}


def check(root):
    """Returns the problems, one line each."""
    wrong = []
    rows = rows_of(root, wrong)
    tests = set().union(*(tests_in(root / folder) for folder in TESTS))
    for row in rows:
        wrong += [f"docs/mcdc.md:{row.line}: there is no test {test}" for test in {row.true, row.false} - tests - {NONE}]
    wanted = [(path.relative_to(root).as_posix(), one.function, one.text, condition.text) for path in sources(root)
              for one in decisions_in(path.read_text(encoding="utf-8")) for condition in one.conditions]
    there = [row[1:5] for row in rows]
    for one in wanted:
        path, function, decision, condition = one
        if wanted.count(one) > there.count(one):
            wrong.append(f"{path}: {function}(): docs/mcdc.md lacks `{condition}` of `{decision}`")
    for row in rows:
        if there.count(row[1:5]) > wanted.count(row[1:5]):
            wrong.append(f"docs/mcdc.md:{row.line}: {row.path} has no `{row.condition}` of `{row.decision}` in {row.function}()")
    decisions = len({row[1:4] for row in rows})
    if f"{decisions} of them with {len(rows)} conditions" not in (root / "docs/mcdc.md").read_text(encoding="utf-8"):
        wrong.append(f"docs/mcdc.md: there are {decisions} decisions with {len(rows)} conditions")
    return wrong


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT, help="root of the source tree to check [this one]")
    wrong = check(parser.parse_args(arguments).root)
    for line in wrong:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
