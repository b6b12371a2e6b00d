"""Prints lines, branches and conditions executed, per file, from the JSON of llvm-cov, and names what no test shows. Exit status 1
below the required share of branches, or of conditions that are shown to decide alone (masking MC/DC).

A template's branches and conditions are those of all instances together."""
import bisect
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]

# Kernels that run only on processors with the instruction set, by its name in /proc/cpuinfo. Kernels of other processor
# families are not compiled here; the audit tests them in emulators.
NEEDS = {
    "gnc/lidar/depth_loops_avx2.cpp": "avx2",
    "gnc/lidar/depth_loops_avx512.cpp": "avx512bw",
    "gnc/nn/kernels/avx2.cpp": "avx2",
    "gnc/nn/kernels/avx_vnni.cpp": "avx_vnni",
    "gnc/nn/kernels/avx512.cpp": "avx512bw",
    "gnc/nn/kernels/avx512_vnni.cpp": "avx512_vnni",
}


MCDC_BRANCH = 6  # kind of a region: the branch of a condition


class Count:
    def __init__(self, taken=0, total=0):
        self.taken, self.total = taken, total

    def __add__(self, other):
        return Count(self.taken + other.taken, self.total + other.total)

    def percent(self):
        return 100.0 * self.taken / self.total if self.total else 100.0

    def __str__(self):
        return f"{self.taken:5}/{self.total:<5} {self.percent():5.1f} %" if self.total else f"{'-':>7}"


class File:
    """What llvm-cov exports of one file. A place is (line, column, last line, last column)."""

    def __init__(self, name, export, source):
        self.name, self.source = name, source.splitlines()
        self.lines = Count(export["summary"]["lines"]["covered"], export["summary"]["lines"]["count"])
        self.outcomes = {}  # place: [times true, times false]
        self.conditions_at = set()  # places of the conditions of decisions
        for *place, true, false, _, _, kind in export["branches"]:
            outcome = self.outcomes.setdefault(tuple(place), [0, 0])
            outcome[0] += true
            outcome[1] += false
            if kind == MCDC_BRANCH:
                self.conditions_at.add(tuple(place))
        executed = self.executed(export["segments"])
        # Without a count in code that runs: the compiler knows its value.
        self.known = {place for place, outcome in self.outcomes.items() if outcome == [0, 0] and executed(place[:2])}
        self.decisions = {}  # place: [whether each condition decides]
        for *numbers, decides in export["mcdc_records"]:
            place = tuple(numbers[:4])
            known = self.decisions.setdefault(place, [False] * len(decides))
            self.decisions[place] = [a or b for a, b in zip(known, decides)]

    @staticmethod
    def executed(segments):
        """A function that tells whether the code at (line, column) ran. A segment is (line, column, count, has count, ...)."""
        starts = [tuple(one[:2]) for one in segments]

        def at(place):
            index = bisect.bisect_right(starts, place) - 1
            return index >= 0 and segments[index][3] and segments[index][2] > 0
        return at

    def branches(self):
        counted = [outcome for place, outcome in self.outcomes.items() if place not in self.known]
        return Count(sum((true > 0) + (false > 0) for true, false in counted), 2 * len(counted))

    def conditions(self):
        shown = [decides for _, _, decides in self.all_conditions()]
        return Count(sum(shown), len(shown))

    def text(self, place):
        line, column, last_line, last_column = place
        rows = self.source[line - 1:last_line]
        rows[-1] = rows[-1][:last_column - 1]
        rows[0] = rows[0][column - 1:]
        return " ".join(" ".join(rows).split())

    def never_taken(self):
        for (line, *rest), (true, false) in sorted(self.outcomes.items()):
            if (true == 0 or false == 0) and (line, *rest) not in self.known:
                never = "true or false" if true == false else "true" if true == 0 else "false"
                yield f"{self.name}:{line}: `{self.text((line, *rest))}` is never {never}"

    def conditions_in(self, decision):
        return [one for one in sorted(self.conditions_at) if decision[:2] <= one[:2] and one[2:] <= decision[2:]]

    def all_conditions(self):
        """(place of the decision, place of the condition, whether some executions show that it alone decides)"""
        for place, decides in sorted(self.decisions.items()):
            inside = self.conditions_in(place)
            if len(inside) != len(decides):  # some are in another place: the decision is a macro, or an argument of one
                continue
            for one, shown in zip(inside, decides):
                if one not in self.known:
                    yield place, one, shown

    def in_macros(self):
        """(line, decision) of those whose conditions are not counted."""
        for place, decides in sorted(self.decisions.items()):
            if len(self.conditions_in(place)) != len(decides):
                yield place[0], self.text(place)

    def undecided(self):
        """(line, decision, condition) of each condition that is not shown to decide."""
        for decision, condition, shown in self.all_conditions():
            if not shown:
                yield decision[0], self.text(decision), self.text(condition)


def read(export, root=ROOT):
    files = []
    for one in json.loads(export)["data"][0]["files"]:
        path = pathlib.Path(one["filename"]).resolve()
        files.append(File(path.relative_to(root).as_posix(), one, path.read_text(encoding="utf-8")))
    return sorted(files, key=lambda file: file.name)


def print_table(files):
    width = max(len(file.name) for file in files)
    print(f"  {'':{width}}  {'lines':^19}  {'branches':^19}  {'conditions':^19}")
    folders = {}
    for file in files:
        counts = (file.lines, file.branches(), file.conditions())
        print(f"  {file.name:{width}}  {str(counts[0]):19}  {str(counts[1]):19}  {counts[2]}")
        folder = file.name.split("/")[0] + "/"
        folders[folder] = tuple(a + b for a, b in zip(folders.get(folder, (Count(), Count(), Count())), counts))
    for folder, counts in folders.items():
        print(f"  {folder:{width}}  {str(counts[0]):19}  {str(counts[1]):19}  {counts[2]}")
    return tuple(sum((counts[i] for counts in folders.values()), Count()) for i in range(3))


def report(files, least, least_conditions):
    for file in files:
        for line, decision in file.in_macros():
            print(f"  {file.name}:{line}: not counted, since a macro is part of it: the conditions of `{decision}`")
        for words in file.never_taken():
            print(f"  {words}")
        for line, decision, condition in file.undecided():
            print(f"  {file.name}:{line}: no test shows that `{condition}` alone decides `{decision}`")
    _, branches, conditions = print_table(files)
    passed = True
    for count, required, what in ((branches, least, "branches are taken"), (conditions, least_conditions, "conditions decide alone")):
        enough = count.total > 0 and count.percent() >= required
        print(f"  {count.percent():.1f} % of {count.total} {what}, {required:g} % required: {'passed' if enough else 'FAILED'}")
        passed = passed and enough
    return passed


def main(path, least, least_conditions):
    flags = set(pathlib.Path("/proc/cpuinfo").read_text().split())
    lacking = [file for file, flag in NEEDS.items() if flag not in flags]
    for file in lacking:
        print(f"  not counted: {file}, since this processor has no {NEEDS[file]}")
    files = [file for file in read(pathlib.Path(path).read_text()) if file.name not in lacking]
    return 0 if files and report(files, float(least), float(least_conditions)) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
