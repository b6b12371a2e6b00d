"""Prints the lines and branches executed, per file, from gcovr's JSON. Exit status 1 below the required share of branches."""
import json
import pathlib
import sys

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


class Count:
    def __init__(self, taken=0, total=0):
        self.taken, self.total = taken, total

    def __add__(self, other):
        return Count(self.taken + other.taken, self.total + other.total)

    def percent(self):
        return 100.0 * self.taken / self.total if self.total else 100.0

    def __str__(self):
        return f"{self.taken:5}/{self.total:<5} {self.percent():5.1f} %" if self.total else f"{'-':>7}"


def counted_lines(file):
    return [line for line in file["lines"] if not line["gcovr/noncode"] and not line["gcovr/excluded"]]


def lines_of(file):
    lines = counted_lines(file)
    return Count(sum(line["count"] > 0 for line in lines), len(lines))


def branches_of(line):
    return Count(sum(branch["count"] > 0 for branch in line["branches"]), len(line["branches"]))


def all_branches_of(file):
    return sum((branches_of(line) for line in counted_lines(file)), Count())


def missing(file):
    """"FILE:LINE: N of M branches" for each line with branches never taken. A template's branches are those of all instances."""
    for line in counted_lines(file):
        branches = branches_of(line)
        if branches.taken < branches.total:
            yield f"{file['file']}:{line['line_number']}: {branches.total - branches.taken} of {branches.total} branches"


def report(files, least):
    width = max(len(file["file"]) for file in files)
    print(f"  {'':{width}}  {'lines':^19}  {'branches':^19}")
    for file in files:
        print(f"  {file['file']:{width}}  {str(lines_of(file)):19}  {all_branches_of(file)}")
    for file in files:
        for words in missing(file):
            print(f"  never taken: {words}")
    folders = {}
    for file in files:
        folder = file["file"].split("/")[0] + "/"
        lines, branches = folders.get(folder, (Count(), Count()))
        folders[folder] = (lines + lines_of(file), branches + all_branches_of(file))
    for folder, (lines, branches) in folders.items():
        print(f"  {folder:{width}}  {str(lines):19}  {branches}")
    total = sum((branches for _, branches in folders.values()), Count())
    passed = total.total > 0 and total.percent() >= least
    print(f"  {total.percent():.1f} % of {total.total} branches taken, {least:g} % required: {'passed' if passed else 'FAILED'}")
    return passed


def main(path, least):
    flags = set(pathlib.Path("/proc/cpuinfo").read_text().split())
    lacking = [file for file, flag in NEEDS.items() if flag not in flags]
    for file in lacking:
        print(f"  not counted: {file}, since this processor has no {NEEDS[file]}")
    files = [file for file in json.loads(pathlib.Path(path).read_text())["files"] if file["file"] not in lacking]
    return 0 if files and report(files, float(least)) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
