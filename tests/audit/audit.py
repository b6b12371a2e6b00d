"""tests/audit/run: builds, runs and measures flight_replay on every processor. Options: --help."""
import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

import image
import processors
import report
import stack
import step_counts
from network_layers import macs

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT, DATA, README = ROOT / "docs/audit.md", ROOT / "docs/audit.json", ROOT / "README.md"
PROGRAMS = (("fixed", "flight_replay"), ("float32", "flight_replay_float32"))
IMAGE = ROOT / "fsw/models/near_shoemaker.tsm"
LONGEST_STEPS = "flight_worst_step"  # in fixed point
CFS_APP = "cfs_app"  # needs an operating system
# Verifies TS-MEM-030, TS-MEM-060.
BUDGETS = {"ram": 240 * 1024, "stack": 8 * 1024, "text": 288 * 1024, "read_only": 32 * 1024}


def programs(processor):
    return PROGRAMS if processor.float32 else PROGRAMS[:1]


def build(processor):
    targets = [name for _, name in programs(processor)] + [LONGEST_STEPS] + ([] if processor.bare_metal else [CFS_APP])
    for command in (["cmake", "--preset", processor.name],
                    ["cmake", "--build", f"build/{processor.name}", "--target", *targets]):
        run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        if run.returncode != 0:
            raise SystemExit(f"audit: {' '.join(command)} failed:\n{run.stdout[-3000:]}{run.stderr[-3000:]}")


# Verifies TS-NUM-030.
def golden():
    return {numerics: digest for _, numerics, digest in
            (line.split() for line in (ROOT / "tests/audit/golden.txt").read_text().splitlines())}


def resets(console):
    """The numbers of the steps, from 0 on, that reset the estimator: column `run` of flight_replay is 1, but not in the first step."""
    rows = [line.split() for line in console]
    runs = [int(row[1]) for row in rows if len(row) > 6 and row[0].isdigit() and row[1].isdigit()]
    return [number for number, run in enumerate(runs) if run == 1 and number > 0]


def largest(names, steps):
    """{stage: the most of all steps}; what sends telemetry counts for the application."""
    found = {name: max(step[i] for step in steps) for i, name in enumerate(names)}
    found["application"] += found.pop("telemetry")
    return found


def measure(processor, numerics, program, plugin, folder):
    models = [limit.model for limit in processor.limits[:None if numerics == "fixed" else 1]]
    by_model = {}  # {title: [cycles per stage] of every step}
    for model in models:
        names, steps, by_model[model.title], console = step_counts.count(processor, model, program, plugin, folder)
    digest = next((line.split()[-1] for line in console if line.startswith("digest ")), "none")
    heading = next(line for line in console if line.startswith("tumblesight, ")).split(", ")
    # The application's work depends on what happens in the step, and registration draws what the frame shows. All other counts must
    # be equal in steps of equal intervals: the first frame after the pause between the two recorded sequences resets the estimator.
    alike = [step for number, step in enumerate(steps) if number not in resets(console)]
    unequal = {name: sorted({step[i] for step in alike}) for i, name in enumerate(names)
               if name not in ("application", "telemetry", "registration") and len({step[i] for step in alike}) > 1}
    stages = largest(names, steps)
    stage_cycles = {title: largest(names, cycles) for title, cycles in by_model.items()}
    longest, longest_cycles, registration_cycles, cycles_beside = {}, {}, {}, {}
    for model in models if numerics == "fixed" else ():
        title = model.title
        longest, longest_cycles[title], registration_cycles[title], cycles_beside[title] = step_counts.count_longest_steps(
            processor, model, program.with_name(LONGEST_STEPS), plugin, folder)
    sizes = image.sizes(processor, program)
    stack_bytes, path = stack.worst_case(program.parents[1], numerics)
    return {"digest": digest, "digest_is_golden": digest == golden()[numerics], "set": heading[3], "frames": heading[4],
            "target": heading[1], "steps": len(steps), "stages": stages, "instructions": sum(stages.values()), "longest_steps": longest,
            "stage_cycles": stage_cycles, "cycles": {title: sum(of.values()) for title, of in stage_cycles.items()},
            "longest_cycles": longest_cycles, "registration_cycles": registration_cycles, "cycles_beside": cycles_beside,
            # Float32 arithmetic may branch on the data on some processors.
            "equal_counts": not unequal or numerics == "float32", "unequal": unequal,
            "text": sizes["text"], "read_only": sizes["read_only"], "ram": sizes["data"] + sizes["bss"] + stack_bytes,
            "stack": stack_bytes, "path": path, "forbidden": image.forbidden(processor, program.parents[1], program),
            "floating_point": image.floating_point(processor, program) if numerics == "fixed" else [],
            "cfs_app": {} if processor.bare_metal else image.sizes_of_cfs_app(processor, program.parents[1])}


def print_result(processor, numerics, r):
    print(f"  {processor.name:<11} {numerics:<8} {r['digest']}  {r['instructions'] / 1e6:8.2f} M instructions "
          f"{r['instructions'] / macs():6.3f} /MAC  {' '.join(f'{cycles / 1e6:7.2f}' for cycles in r['cycles'].values())} M cycles   text {r['text'] / 1024:5.1f}  RAM {r['ram'] / 1024:6.1f}  stack "
          f"{r['stack'] / 1024:4.1f} KiB", flush=True)


def write_documents(results):
    model = f"of {results[0][2]['target']}"
    DATA.write_text(json.dumps(report.as_data(results, macs()), indent=1) + "\n")
    DOCUMENT.write_text(report.as_document(results, macs(), BUDGETS, model, IMAGE.stat().st_size, results[0][2]["frames"]))
    README.write_text(report.with_table(README.read_text(), report.as_summary(results, macs())))
    print("\n  written: " + ", ".join(str(path.relative_to(ROOT)) for path in (DOCUMENT, DATA, README)))


def main():
    parser = argparse.ArgumentParser(prog="tests/audit/run", description=__doc__)
    parser.add_argument("--processor", metavar="NAME", action="append", help="only this processor, and those of further --processor")
    parser.add_argument("--write", action="store_true", help="renew the documents, also with figures that have grown")
    parser.add_argument("--list", action="store_true", help="print the names of the processors and exit")
    arguments = parser.parse_args()
    if arguments.list:
        print(*(processor.name for processor in processors.ALL))
        return 0
    if arguments.write and arguments.processor:
        parser.error("--write needs the figures of all processors: leave out --processor")
    wanted = [processors.by_name(name) for name in arguments.processor] if arguments.processor else processors.ALL
    folder = ROOT / "build/audit"
    folder.mkdir(parents=True, exist_ok=True)
    plugin = step_counts.build_plugin(folder)

    for processor in wanted:
        if sys.stdout.isatty():
            print(f"  {processor.name:<11} building", end="\r", flush=True)
        build(processor)
        (folder / processor.name).mkdir(exist_ok=True)

    # An emulator uses one core.
    runs = [(processor, numerics, ROOT / "build" / processor.name / "bin" / name)
            for processor in wanted for numerics, name in programs(processor)]
    results = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(measure, processor, numerics, program, plugin, folder / processor.name)
                for processor, numerics, program in runs]
        for (processor, numerics, _), job in zip(runs, jobs):
            results.append((processor, numerics, job.result()))
            print_result(*results[-1])

    # Renewed documents become the new reference, so that growth is not a failure then. All other limits hold.
    committed = {} if arguments.write else json.loads(DATA.read_text())["processors"]
    wrong = report.failures(results, committed, BUDGETS, macs())
    for line in wrong:
        print(f"  FAILED {line}")
    if arguments.write and not wrong:
        write_documents(results)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
