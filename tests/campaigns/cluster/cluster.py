"""A campaign of 16 tasks, of which one is killed, has the figures of one process, byte for byte.

On Slurm the command is interrupted, too, and started again: it follows the jobs that it has submitted.

  cluster.py --on local|mpi --program TUMBLESIGHT
  with_slurm cluster.py --on slurm --program TUMBLESIGHT

Exit status 77 if mpirun is not installed (Debian: openmpi-bin).
"""
import argparse
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

CONDITIONS = ["nominal", "degraded"]
SEQUENCES = 320  # of each run, 8 tasks of 40: each takes about a second
LIMIT_S = 150
SKIPPED = 77
STOPPED = 3
# OpenMPI as root, and more processes than cores, as in a container; its traffic on loopback.
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
       "OMPI_MCA_oob_tcp_if_include": "lo", "OMPI_MCA_btl": "self,vader", "OMPI_MCA_plm_rsh_agent": "false"}


def run(words, **more):
    """As subprocess.run, but a program that takes too long is asked to end, so that it can end what it started."""
    process = subprocess.Popen(words, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more)
    try:
        output, errors = process.communicate(timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        process.terminate()
        output, errors = process.communicate(timeout=30)
        errors += f"\ntook longer than {LIMIT_S} s"
    return subprocess.CompletedProcess(words, process.returncode, output, errors)


def expect(holds, message, outcome=None):
    if holds:
        return
    if outcome is not None:
        message += f"\nstatus {outcome.returncode}\n{outcome.stdout}\n{outcome.stderr}"
    sys.exit("cluster.py: " + message)


def words_of(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().decode().split("\0")
    except OSError:  # it has ended
        return []


def processes_of(out):
    """What works on a campaign: its words name the folder."""
    return [int(pid) for pid in filter(str.isdigit, os.listdir("/proc")) if str(out) in words_of(pid)]


def until(holds, seconds):
    end = time.monotonic() + seconds
    while not holds() and time.monotonic() < end:
        time.sleep(0.05)
    return holds()


def workers_of(program, out):
    for pid in processes_of(out):
        if words_of(pid)[:3] == [program, "campaign", "work"]:
            yield pid


def expect_nothing_left_after_kill(words, program, out, environment):
    """The workers, and mpirun, end with the program that has started them."""
    process = subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    started = until(lambda: list(workers_of(program, out)), 30)
    process.kill()
    process.wait()
    expect(started, "no worker was started before the kill")
    expect(until(lambda: not processes_of(out), 20), f"processes {processes_of(out)} go on without their starter")


class Killer(threading.Thread):
    """Kills one worker of the campaign while it runs a task: the first that has written a part of its file."""

    def __init__(self, program, out):
        super().__init__(daemon=True)
        self.program, self.out, self.killed = program, out, None

    def run(self):
        end = time.monotonic() + LIMIT_S
        while time.monotonic() < end:
            begun = [path for path in self.out.glob("*/*.shard") if path.stat().st_size > 10_000]
            workers = list(workers_of(self.program, self.out))
            if begun and workers:
                os.kill(workers[0], signal.SIGKILL)
                self.killed = workers[0]
                return
            time.sleep(0.01)


class Watcher(threading.Thread):
    """Sees which tasks Slurm has requeued: they wait for a time, and not for a place."""

    def __init__(self):
        super().__init__(daemon=True)
        self.requeued = []

    def run(self):
        while True:
            for line in run(["squeue", "-h", "-t", "PENDING", "-o", "%i %r"]).stdout.splitlines():
                job, reason = line.split(" ", 1)
                if "BeginTime" in reason:
                    self.requeued.append(job)
            time.sleep(0.5)


def write_campaign(folder):
    path = folder / "killed.toml"
    path.write_text(f'seed = 3\nsequences_per_task = {SEQUENCES // 8}\n[[run]]\ntarget = "near_shoemaker"\n'
                    f"condition = {CONDITIONS}\nsequences = {SEQUENCES}\n".replace("'", '"'))
    return path


def figures_of_one_process(program, folder):
    path = folder / "one.json"
    outcome = run([program, "evaluate", "--target", "near_shoemaker", "--condition", ",".join(CONDITIONS), "--sequences",
                   str(SEQUENCES), "--seed", "3", "--no-baseline", "--json", str(path)])
    expect(outcome.returncode == 0, "the evaluation in one process failed", outcome)
    return path.read_bytes()


def command_of(way, program, campaign):
    words = [program, "campaign", "run", str(campaign), "--on", way]
    return words if way == "slurm" else words + ["--jobs", "2"]


def interrupted(words, environment):
    """Starts the campaign as a user does who presses Ctrl-C as soon as the jobs are submitted."""
    process = subprocess.Popen(words, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    for line in process.stdout:
        if "Ctrl-C" in line:
            process.send_signal(signal.SIGINT)
    expect(process.wait(timeout=30) == STOPPED, "Ctrl-C does not end the command")


def check(way, program, folder):
    campaign = write_campaign(folder)
    out = campaign.with_suffix("")
    environment = {**os.environ, **MPI}
    if way != "slurm":
        expect_nothing_left_after_kill(command_of(way, program, campaign), program, out, environment)
    killer = Killer(program, out)
    killer.start()
    watcher = Watcher()
    if way == "slurm":
        watcher.start()
        interrupted(command_of(way, program, campaign), environment)
    outcome = run(command_of(way, program, campaign), env=environment)
    killer.join(1)
    expect(killer.killed, "no worker was killed, so that the test says nothing", outcome)
    if way == "slurm":
        expect("of an earlier call" in outcome.stdout, "the jobs that were submitted are not followed", outcome)
        expect(watcher.requeued, "Slurm has not requeued the task that was killed", outcome)
    if way == "mpi":  # mpirun ends all workers when one dies
        expect(outcome.returncode == 1 and "The same command goes on where it stopped" in outcome.stderr,
               "the campaign does not say that it is not done", outcome)
        outcome = run(command_of(way, program, campaign), env=environment)
    expect(outcome.returncode == 0, "the campaign failed", outcome)
    expect((out / "results.json").read_bytes() == figures_of_one_process(program, folder),
           "the figures differ from those of one process")
    print(f"{way}: 16 tasks, one killed (process {killer.killed}), figures of one process")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--on", choices=["local", "mpi", "slurm"], required=True)
    parser.add_argument("--program", required=True)
    arguments = parser.parse_args()
    if arguments.on == "mpi" and shutil.which("mpirun") is None:
        print("cluster.py: mpirun is missing; on Debian install openmpi-bin")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        return check(arguments.on, arguments.program, pathlib.Path(folder))


if __name__ == "__main__":
    sys.exit(main())
