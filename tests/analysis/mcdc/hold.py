#!/usr/bin/env python3
"""Forces each condition of docs/mcdc.md to its other value and checks that the tests in which it decides fail.

  tests/analysis/mcdc/hold.py [--build FOLDER] [--rows gnc/estimation]     takes some minutes; needs CMake and Ninja
"""
import argparse
import concurrent.futures
import os
import pathlib
import subprocess
import sys

from check import NONE, ROOT, TESTS, rows_of, sources, tests_in
from decisions import decisions_in

HELD = """#pragma once
#include <cstdlib>
namespace tumblesight {
inline bool held(int condition, bool value) {
  static const char* const which = std::getenv("MCDC_CONDITION");
  static const int wanted = which != nullptr ? std::atoi(which) : -1;
  static const bool instead = std::getenv("MCDC_VALUE") != nullptr && *std::getenv("MCDC_VALUE") == '1';
  return condition == wanted ? instead : value;
}
}  // namespace tumblesight
"""


def write(path, data):
    """Writes changed files only, so that only these are rebuilt."""
    if not path.exists() or path.read_bytes() != data:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def copy_with_handles(folder):
    """Copies the tree and wraps each condition in held(). Returns {(path, function, decision, condition): its number}."""
    numbers = {}
    write(folder / "held.hpp", HELD.encode())
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in listed.split("\0"):
        if (ROOT / name).is_file() and ROOT / name not in sources(ROOT):
            write(folder / name, (ROOT / name).read_bytes())
    for path in sources(ROOT):
        text, name = path.read_text(encoding="utf-8"), path.relative_to(ROOT).as_posix()
        found = [(condition, one) for one in decisions_in(text) for condition in one.conditions]
        for condition, one in sorted(found, key=lambda pair: -pair[0].begin):
            number = numbers[name, one.function, one.text, condition.text] = len(numbers)
            original = text[condition.begin:condition.end]
            text = f"{text[:condition.begin]}::tumblesight::held({number}, ({original})){text[condition.end:]}"
        for function in {one.function for _, one in found}:
            text = text.replace(f"constexpr bool {function}(", f"inline bool {function}(")
        write(folder / name, text.encode())
    return numbers


# The program of each folder of tests.
PROGRAMS = dict(zip(TESTS, ("test_fsw_app", "test_gnc_estimation", "test_gnc_registration")))


def passes(program, test, number=-1, value=False, timeout_s=120):
    environment = {**os.environ, "MCDC_CONDITION": str(number), "MCDC_VALUE": "1" if value else "0"}
    try:
        return subprocess.run([program, f"--gtest_filter={test}"], env=environment, timeout=timeout_s,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode == 0
    except subprocess.TimeoutExpired:
        return False


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/mcdc", help="build folder")
    parser.add_argument("--rows", default="", metavar="PATH", help="only rows of files whose path begins so [all]")
    arguments = parser.parse_args()
    folder = arguments.build.resolve()
    numbers = copy_with_handles(folder / "tree")
    subprocess.run(["cmake", "-S", folder / "tree", "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
                    "-DTUMBLESIGHT_SIL=OFF", "-DTUMBLESIGHT_TESTS=ON",
                    f"-DCMAKE_CXX_FLAGS=-include {folder}/tree/held.hpp"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["ninja", "-C", folder, *PROGRAMS.values()], check=True)
    # A filter that names no test of a program would pass.
    program_of = {test: folder / "bin" / program for tests, program in PROGRAMS.items() for test in tests_in(ROOT / tests)}
    if not all(passes(program, "*", timeout_s=1200) for program in sorted(set(program_of.values()))):
        sys.exit("the tests fail with no condition forced")
    rows = [row for row in rows_of(ROOT, []) if row.path.startswith(arguments.rows)]
    cases = [(row, test, value) for row in rows for test, value in ((row.true, False), (row.false, True)) if test != NONE]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        passed = list(pool.map(lambda case: passes(program_of[case[1]], case[1], numbers[case[0][1:5]], case[2]), cases))
    blind = [case for case, one in zip(cases, passed) if one]
    for row, test, value in blind:
        print(f"docs/mcdc.md:{row.line}: {test} passes although `{row.condition}` is forced to {str(value).lower()}")
    print(f"{len(cases)} cases, {len(blind)} of them independent of their condition")
    return 1 if blind else 0


if __name__ == "__main__":
    sys.exit(main())
