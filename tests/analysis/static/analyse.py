"""Runs compilers and analysers over the sources and prints their findings. Exit status 1 if there are any."""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = ROOT / "build/static"
FLIGHT = ("gnc/", "fsw/", "hal/")

# In addition to those of an ordinary build: -Wall -Wextra -Wshadow -Wconversion (cmake/compile_rules.cmake).
STRICT = ["-Wpedantic", "-Wcast-qual", "-Wdouble-promotion", "-Wextra-semi", "-Wfloat-conversion", "-Wformat=2",
          "-Wimplicit-fallthrough", "-Wmissing-declarations", "-Wnon-virtual-dtor", "-Wold-style-cast", "-Woverloaded-virtual",
          "-Wredundant-decls", "-Wswitch-enum", "-Wundef", "-Wvla", "-Wzero-as-null-pointer-constant"]
STRICT_GCC = ["-Walloca", "-Warith-conversion", "-Wdisabled-optimization", "-Wduplicated-branches", "-Wduplicated-cond",
              "-Wlogical-op", "-Wnull-dereference", "-Wstrict-overflow=2", "-Wstringop-overflow=4", "-Wsuggest-override",
              "-Wtrampolines"]
STRICT_CLANG = ["-Wcomma", "-Wconditional-uninitialized", "-Wloop-analysis", "-Wmissing-variable-declarations", "-Wshadow-all",
                "-Wunreachable-code"]
# No code runs before main(), except the constructors of a program's own objects (fsw/programs/).
LIBRARIES_CLANG = ["-Wexit-time-destructors", "-Wglobal-constructors"]
# Not for C, the apps of cFS: warnings about C++, and cFE finds a table by a variable that no header declares.
NOT_IN_C = ["-Wextra-semi", "-Wnon-virtual-dtor", "-Wold-style-cast", "-Woverloaded-virtual", "-Wsuggest-override",
            "-Wzero-as-null-pointer-constant", "-Wmissing-variable-declarations"]
# Not used:
#   -Wsign-conversion    indexes are int and the standard library's sizes are not; a cast at each would hide more than it shows
#   -Wuseless-cast       whether a cast to time_t or long is useless depends on the processor
#   -Wcast-align=strict  the activations' memory is aligned to cache lines, which its type (bytes) does not show
#   -Wswitch-default     a default label keeps -Wswitch-enum from naming the missing cases
#   -Wfloat-equal        the entries of a symmetric matrix are compared on purpose
#   of -Weverything      padding, templates instantiated elsewhere, vtables: not defects

CPPCHECK = ["cppcheck", "--enable=warning,performance,portability", "--inline-suppr", "--quiet", "--error-exitcode=1", "--template={file}:{line}: {message} [{id}]",
            "--suppress=*:/usr/*", "--suppress=*:*/build/static/*",
            "--suppress=shiftTooManyBitsSigned", "--suppress=shiftNegativeLHS"]  # right shifts are arithmetic, as gnc/numerics/fixed.hpp asserts


class Source:
    def __init__(self, path, arguments, folder):
        self.path, self.arguments, self.folder = path, arguments, folder

    def is_flight(self):
        return self.path.startswith(FLIGHT)

    def is_c(self):
        return self.path.endswith(".c")

    def strict(self, warnings):
        return [warning for warning in warnings if not (self.is_c() and warning in NOT_IN_C)]


def sources():
    """One compile command per source file of the project."""
    found = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        # The second compilation of the same sources, which shows that they need no floating point.
        again = "flight_in_integers" in entry["command"]
        if again or path.suffix not in (".cpp", ".c") or (ROOT / "build") in path.parents:
            continue
        arguments = shlex.split(entry["command"])
        output = arguments.index("-o")
        del arguments[output:output + 2]
        name = str(path.relative_to(ROOT))
        found.setdefault(name, Source(name, arguments, entry["directory"]))
    return list(found.values())


def gcc(source):
    # Optimized, since GCC checks null pointers and array bounds only then.
    return source.arguments + source.strict(STRICT + STRICT_GCC) + ["-O2", "-o", "/dev/null"]


def clang(source):
    strict = []
    if source.is_flight():
        strict = source.strict(STRICT + STRICT_CLANG) + ([] if source.path.startswith("fsw/programs/") else LIBRARIES_CLANG)
    return ["clang" if source.is_c() else "clang++"] + source.arguments[1:] + strict + ["-fsyntax-only", "-Wno-ignored-optimization-argument"]


def clang_tidy(source):
    return ["clang-tidy", "--quiet", "-p", str(BUILD / "flight"), str(ROOT / source.path)]


def cppcheck(source):
    language = ["--std=c99", "--language=c"] if source.is_c() else ["--std=c++17", "--language=c++"]
    return CPPCHECK + language + [a for a in source.arguments if a.startswith(("-I", "-D"))] + [str(ROOT / source.path)]


TOOLS = {"gcc": gcc, "clang": clang, "cppcheck": cppcheck, "clang-tidy": clang_tidy}
FOR_THE_REST = ("clang",)  # GCC compiles the rest with every build


def findings_of(text):
    """'FILE:LINE: MESSAGE' of every warning and error, without notes."""
    for line in text.splitlines():
        match = re.match(r"(\S+?):(\d+):(?:\d+:)? (?!note:)(?:(?:fatal )?(?:warning|error): )?(.+)", line)
        if match:
            yield f"{match[1].replace(f'{ROOT}/', '')}:{match[2]}: {match[3]}"


def run(task):
    """(findings of one tool on one source, seconds)"""
    tool, source = task
    started = time.monotonic()
    done = subprocess.run(TOOLS[tool](source), cwd=source.folder, capture_output=True, text=True)
    found = list(findings_of(done.stdout + done.stderr))
    if done.returncode != 0 and not found:
        found = [f"{source.path}:1: {tool} failed: {(done.stderr or done.stdout).strip()[-300:]}"]
    return found, time.monotonic() - started


def analyse(parts):
    """Runs every (tool, name, sources) and prints the findings, each once although many sources include its header. Returns
    the rows of the table: tool, name, number of files, findings and seconds, summed over the processes."""
    tasks = [(tool, source) for tool, _, chosen in parts for source in chosen]
    # One pool for all tools, the slowest one first, so that no processor waits for the last file of a tool.
    tasks.sort(key=lambda task: list(TOOLS).index(task[0]), reverse=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = {(tool, source.path): result for (tool, source), result in zip(tasks, pool.map(run, tasks))}
    rows = []
    for tool, name, chosen in parts:
        mine = [results[tool, source.path] for source in chosen]
        found = {line for lines, _ in mine for line in lines}
        for line in sorted(found):
            print(f"  {line}", flush=True)
        rows.append((tool, name, len(chosen), len(found), sum(seconds for _, seconds in mine)))
    return rows


def write_flight_commands(chosen):
    """For clang-tidy, which would otherwise analyse a file once for every command that compiles it."""
    (BUILD / "flight").mkdir(exist_ok=True)
    commands = [{"directory": s.folder, "file": str(ROOT / s.path), "arguments": s.arguments} for s in chosen]
    (BUILD / "flight/compile_commands.json").write_text(json.dumps(commands))


def main():
    parser = argparse.ArgumentParser(prog="tests/analysis/static/run")
    parser.add_argument("--flight", action="store_true")
    parser.add_argument("--tool", action="append", choices=TOOLS)
    parser.add_argument("paths", nargs="*")
    parser.add_argument("--check-arguments", action="store_true", help=argparse.SUPPRESS)  # and do nothing else
    options = parser.parse_args()
    for path in options.paths:
        if not (ROOT / path).exists():
            parser.error(f"there is no '{path}' in {ROOT}")
    if options.check_arguments:
        return 0

    everything = sources()
    flight = [s for s in everything if s.is_flight()]
    write_flight_commands(flight)
    rest = [] if options.flight else [s for s in everything if not s.is_flight()]
    parts = []
    for tool in options.tool or TOOLS:
        for name, part in (("flight", flight), ("rest", rest if tool in FOR_THE_REST else [])):
            part = [s for s in part if not options.paths or s.path.startswith(tuple(options.paths))]
            if part:
                parts.append((tool, name, part))
    rows = analyse(parts)
    print(f"  {'tool':12}{'sources':9}{'files':>6}{'findings':>10}{'time':>8}")
    for tool, name, files, found, seconds in rows:
        print(f"  {tool:12}{name:9}{files:6}{found:10}{seconds:6.0f} s")
    if not rows:
        print("  no source matches the given paths")
    return 0 if rows and all(row[3] == 0 for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
