#!/usr/bin/env python3
"""Records a run and holds the file against @mcap/core, the library of the format's authors (check.mjs, in Node).

    test_mcap_core.py TUMBLESIGHT FOLDER

FOLDER has the scripts and package.json; npm installs the packages there. Exits with 77 if the test cannot run here,
because Node, npm or the network is missing.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
INSTALL_S, RUN_S, CHECK_S = 120, 60, 60
INSTALL = ["npm", "install", "--no-audit", "--no-fund", "--no-package-lock", "--ignore-scripts", "--fetch-retries=1",
           "--fetch-retry-mintimeout=1000", "--prefix"]
# Errors of package.json rather than of the network.
WRONG_PACKAGES = re.compile(r"npm error code (ETARGET|EJSONPARSE|EOVERRIDE|ERESOLVE)")


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def install(folder):
    for program in ("node", "npm"):
        if shutil.which(program) is None:
            skip(f"{program} is not installed")
    try:
        npm = subprocess.run([*INSTALL, folder], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=INSTALL_S)
    except subprocess.TimeoutExpired:
        skip(f"npm did not install the packages of {folder}/package.json within {INSTALL_S} s; is there a network?")
    if WRONG_PACKAGES.search(npm.stderr):
        sys.exit(npm.stderr)
    if npm.returncode != 0:
        skip(f"npm could not install the packages of {folder}/package.json; is there a network?\n{npm.stderr}")


def record(tumblesight, folder):
    """Records a short run. Returns its number of steps, as the program prints it."""
    run = subprocess.run([tumblesight, "simulate", "--sequences", "2", "--mcap", folder / "run.mcap", "--report", folder / "run.html"],
                         stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=RUN_S)
    answered = re.search(r"^ *steps +(\d+) of \1 answered$", run.stdout, re.MULTILINE)
    if run.returncode != 0 or not answered:
        sys.exit(f"the run failed with {run.returncode}:\n{run.stdout}{run.stderr}")
    return answered[1]


def main():
    tumblesight, scripts = map(pathlib.Path, sys.argv[1:])
    install(scripts)
    with tempfile.TemporaryDirectory(prefix="tumblesight-mcap-") as name:
        folder = pathlib.Path(name)
        steps = record(tumblesight, folder)
        check = subprocess.run(["node", scripts / "check.mjs", folder / "run.mcap", steps], check=False, timeout=CHECK_S)
    sys.exit(check.returncode)


if __name__ == "__main__":
    main()
