#!/usr/bin/env python3
"""Runs an example of docs/onnx.md and compares the attitudes that it prints with the truth.

    run_step_example.py TRUTH.csv PROGRAM EXAMPLE PREFIX FRAMES.tslr

Exits with 3 if the example cannot run here, because the program, ONNX Runtime or numpy is missing. Without the last two
the program has read the example nevertheless, so that an error of syntax is found.
"""
import csv
import math
import re
import subprocess
import sys

SKIPPED = 3
LARGEST_ERROR_DEG = 5  # from the second frame on; the network's error is 1 to 2 degrees
MISSING = re.compile(r"Cannot find package '(onnxruntime-node)'|No module named '(numpy|onnxruntime)'")
PRINTED = re.compile(r"^([\d.]+) s  q_lrf_trf (-?[\d.]+) (-?[\d.]+) (-?[\d.]+) (-?[\d.]+)  error ([\d.]+) rad$")


def skip(reason):
    print(f"skipped: {reason}. For Node: `npm install --prefix build --ignore-scripts onnxruntime-node`; for Python: "
          "`pip install numpy onnxruntime`")
    sys.exit(SKIPPED)


def angle_deg(p, q):
    cosine = abs(sum(a * b for a, b in zip(p, q))) / math.hypot(*p) / math.hypot(*q)
    return math.degrees(2 * math.acos(min(1.0, cosine)))


def main():
    truth_path, *command = sys.argv[1:]
    try:
        run = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        skip(f"{command[0]} is not installed")
    missing = MISSING.search(run.stderr)
    if run.returncode != 0 and missing:
        skip(f"{command[0]} has no {missing[1] or missing[2]}")
    print(run.stdout, run.stderr)
    if run.returncode != 0:
        sys.exit(f"the example failed with {run.returncode}")

    with open(truth_path, encoding="ascii") as file:
        truth = list(csv.DictReader(file))
    lines = [PRINTED.match(line) for line in run.stdout.splitlines()]
    if len(lines) != len(truth) or not all(lines):
        sys.exit(f"{len(truth)} frames, but these lines: {run.stdout}")
    for number, (line, row) in enumerate(zip(lines, truth)):
        time_s, *q = (float(text) for text in line.groups()[:5])
        error_deg = angle_deg(q, [float(row[f"q_lrf_trf_{part}"]) for part in "wxyz"])
        print(f"{time_s:.2f} s: {error_deg:.2f} degrees")
        if abs(time_s - int(row["exposure_time_ns"]) / 1e9) > 0.006:
            sys.exit("the time is not that of the frame")
        if number > 0 and error_deg > LARGEST_ERROR_DEG:
            sys.exit(f"the attitude is wrong by more than {LARGEST_ERROR_DEG} degrees")


if __name__ == "__main__":
    main()
