#!/usr/bin/env python3
"""Tests scripts/cluster on a Slurm of its own (Debian's slurm-wlm and munge): a controller and two nodes on the loopback interface, with
all files in a temporary directory. Runs a comparison and a recovery, kills a node and a task meanwhile, removes a part, and
checks that the merged results have the same bytes as a single run.

usage: slurm.py AWMR. The exit code is 77 if Slurm is not installed (scripts/setup all)."""
import getpass
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
AWMR = str(pathlib.Path(sys.argv[1]).resolve())
SUBMIT = str(ROOT / "scripts/cluster/submit")
NODES = ("one", "two")
DAEMONS = ("munged", "slurmctld", "slurmd")
SKIPPED = 77
LONGEST_S = 120  # maximum wait for any condition

# Replaces the program: part 2 of the first array blocks on its first two starts, so that its node, then its task, can be killed
# meanwhile.
SLOW_AWMR = """#!/usr/bin/env bash
set -euo pipefail
if [ "${SLURM_ARRAY_TASK_ID:-}" = 2 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 2 ] && [ ! -e "$QUICK" ]; then
  touch "$STARTED.${SLURM_RESTART_COUNT:-0}"
  sleep 600
fi
exec "$PROGRAM" "$@"
"""

# Slurm detects a lost node after SlurmdTimeout and starts a requeued task after cred_expire; both are short for the test. With
# select/linear each task has its own node.
CONFIGURATION = """\
ClusterName=awmr
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={at}/munge/socket,cred_expire=5
StateSaveLocation={at}/state
SlurmdSpoolDir={at}/spool-%n
SlurmctldPidFile={at}/slurmctld.pid
SlurmdPidFile={at}/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/linear
SlurmdParameters=config_overrides
SlurmdTimeout=6
ReturnToService=2
KillWait=1
NodeName=one NodeHostname=localhost NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1
NodeName=two NodeHostname=localhost NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1
PartitionName=all Nodes=ALL Default=YES MaxTime=10
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


def until(what, is_so):
    """Waits until the condition is true."""
    begun = time.monotonic()
    while not is_so():
        assert time.monotonic() < begun + LONGEST_S, f"not within {LONGEST_S} s: {what}"
        time.sleep(0.2)
    print(f"{time.monotonic() - begun:5.1f} s: {what}", flush=True)


class Slurm:
    """Context manager for the daemons and all processes that they start."""

    def __init__(self, at):
        self.at = at
        self.daemons = {}
        self.environment = dict(os.environ, SLURM_CONF=str(at / "slurm.conf"), PATH=f"{os.environ['PATH']}:/usr/sbin",
                                AWMR=str(at / "awmr"), PROGRAM=AWMR, STARTED=str(at / "started"), QUICK=str(at / "quick"))

    def __enter__(self):
        at = self.at
        at.chmod(0o755)  # munge's socket is for every user who may enter its directory
        for name in ("munge", "state", "log", *NODES):
            (at / name).mkdir(mode=0o755)
        key = at / "munge.key"
        key.touch(mode=0o600)
        key.write_bytes(os.urandom(1024))
        (at / "slurm.conf").write_text(CONFIGURATION.format(at=at, user=getpass.getuser(), ports=free_ports(3)))
        (at / "awmr").write_text(SLOW_AWMR)
        (at / "awmr").chmod(0o755)
        try:
            self.start("munged", "--foreground", f"--key-file={key}", *(
                f"--{name}-file={at}/munge/{name}" for name in ("pid", "log", "seed")), f"--socket={at}/munge/socket")
            until("munge answers", (at / "munge/socket").exists)
            self.start("slurmctld", "-D", "-i")
            for node in NODES:
                self.start_node(node)
            until("both nodes are idle", lambda: self.states() == ["idle", "idle"])
        except BaseException:
            self.__exit__()
            raise
        return self

    def start(self, daemon, *words, node=None):
        name = node or daemon
        with open(self.at / "log" / name, "ab") as log:
            self.daemons[name] = subprocess.Popen([daemon, *words], env=self.environment, cwd=self.at / (node or ""), stdout=log,
                                                  stderr=log, stdin=subprocess.DEVNULL)

    def start_node(self, node):
        self.start("slurmd", "-D", "-N", node, node=node)

    def __exit__(self, *_):
        end(list(self.processes()))
        for daemon in self.daemons.values():
            daemon.wait()

    def processes(self, node=None):
        """All processes of this Slurm, or of one node: daemons, the slurmstepd processes that they start (recognised by the daemon's
        directory, because they overwrite their environment), and tasks (recognised by their environment)."""
        directories = {str(self.at / name) for name in ([node] if node else NODES)}
        marks = [f"SLURM_CONF={self.at}/slurm.conf\0", *([f"SLURMD_NODENAME={node}\0"] if node else [])]
        daemons = {daemon.pid for name, daemon in self.daemons.items() if node in (None, name)}
        for path in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                environment = (path / "environ").read_bytes()
                is_step = (path / "cmdline").read_bytes().startswith(b"slurmstepd")
                directory = os.readlink(path / "cwd")
            except OSError:
                continue  # the process has ended or belongs to another user
            is_task = all(mark.encode() in environment for mark in marks)
            if int(path.name) in daemons or is_task or is_step and directory in directories:
                yield int(path.name)

    def lose(self, node):
        """Kills all processes of the node, as a power failure would."""
        end(list(self.processes(node)))
        self.daemons.pop(node).wait()

    def say(self, *words):
        done = subprocess.run(words, env=self.environment, cwd=self.at, capture_output=True, text=True)
        assert done.returncode == 0, f"{' '.join(words)}: exit code {done.returncode}: {done.stdout}{done.stderr}"
        return done.stdout

    def states(self):
        try:
            return self.say("sinfo", "-h", "-N", "-o", "%T").split()
        except AssertionError:
            return []  # the controller does not answer yet

    def tasks(self):
        """{array task or "merge": (its state, its node)} of all waiting or running jobs."""
        found = {}
        for line in self.say("squeue", "-h", "-r", "-o", "%K|%T|%N").splitlines():
            task, state, node = line.split("|")
            found["merge" if task == "N/A" else task] = (state, node)
        return found

    def submit(self, *words):
        return self.say(SUBMIT, *map(str, words))


def end(pids):
    """Kills all processes at the same time, so that none can report the end of another."""
    for what in (signal.SIGSTOP, signal.SIGKILL):
        for pid in pids:
            try:
                os.kill(pid, what)
            except ProcessLookupError:
                pass


def awmr(at, *words):
    subprocess.run([AWMR, *map(str, words)], cwd=at, check=True, capture_output=True)


def prepare(at):
    """Writes the files of a small comparison; returns the command lines of compare and recover."""
    tables = [word for kind in ("surge", "coastdown", "turning") for word in (f"--{kind}", ROOT / f"datasets/paper/{kind}.csv")]
    awmr(at, "identify", "--vehicle", ROOT / "configs/paper/vehicle.json", *tables, "-o", "model.json")
    (at / "gains.json").write_text(json.dumps({"heading": {"lambda": 3, "mu": 50, "epsilon": 12},
                                               "speed": {"mu": 5, "epsilon": 1.2}}))
    scenario = ROOT / "configs/paper/scenarios/c3_heading_steps.json"
    return (["compare", "--model", "model.json", "--gains", "gains.json", "--scenario", scenario, "--samples", "15"],
            ["recover", "--model", "model.json", "--runs", "20"])


def expect_same(at, merged, whole, names):
    for name in names:
        assert (at / merged / name).read_bytes() == (at / whole / name).read_bytes(), f"{merged}/{name} differs from a single run's"


def state_of(slurm, task):
    return slurm.tasks().get(task, ("", ""))[0]


def lose_node_and_task(slurm, compare):
    """Loses the node that runs part 2, later only the task of part 2; Slurm must requeue part 2 both times."""
    at = slurm.at
    print(slurm.submit(4, "merged", *compare), end="", flush=True)
    until("part 2 has started", (at / "started.0").exists)
    node = slurm.tasks()["2"][1]
    slurm.lose(node)
    until(f"node {node} is lost, part 2 has started again on the other one", (at / "started.1").exists)
    assert slurm.tasks()["2"][1] != node
    slurm.start_node(node)
    array = slurm.say("squeue", "-h", "-r", "-t", "running", "-o", "%i").split()
    second = next(job for job in array if job.endswith("_2"))
    slurm.say("scontrol", "requeue", second)
    until("part 2 is killed and requeued, all is merged", lambda: not slurm.tasks())
    expect_same(at, "merged", "whole", ("comparison.csv", "comparison.json"))


def lose_part_and_submit_again(slurm, compare):
    """Removes one of four existing parts; the next array must run only that part."""
    at = slurm.at
    (at / "quick").touch()
    parts = [at / f"merged/part-{i}/shard.json" for i in range(1, 5)]
    before = [part.stat().st_mtime_ns for part in parts]
    shutil.rmtree(at / "merged/part-3")
    for name in ("comparison.csv", "comparison.json"):
        (at / "merged" / name).unlink()
    slurm.submit(4, "merged", *compare)
    until("part 3 was lost, all is merged again", lambda: not slurm.tasks())
    expect_same(at, "merged", "whole", ("comparison.csv", "comparison.json"))
    changed = [i for i, part in enumerate(parts, 1) if part.stat().st_mtime_ns != before[i - 1]]
    assert changed == [3], f"run again: {changed}"


def recover(slurm, words):
    slurm.submit(3, "recovered", *words)
    until("the recovery is merged", lambda: not slurm.tasks())
    expect_same(slurm.at, "recovered", "whole", ("recover.json",))


def fail(slurm, compare):
    """Checks that a failing part cancels the merge and that its log has the reason."""
    slurm.submit(2, "failed", *compare, "--weight", "luck=1")
    until("the array has ended and the merge is cancelled", lambda: not slurm.tasks())
    assert "luck" in (slurm.at / "failed/log/part-2.log").read_text()
    assert not (slurm.at / "failed/comparison.json").exists()


def main():
    missing = [daemon for daemon in DAEMONS if not shutil.which(daemon, path=f"{os.environ['PATH']}:/usr/sbin")]
    if missing:
        print(f"not installed: {', '.join(missing)} (scripts/setup all)")
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix="awmr-slurm-") as folder:
        at = pathlib.Path(folder)
        compare, recovery = prepare(at)
        awmr(at, *compare, "-o", "whole")
        awmr(at, *recovery, "-o", "whole/recover.json")
        try:
            with Slurm(at) as slurm:
                lose_node_and_task(slurm, compare)
                lose_part_and_submit_again(slurm, compare)
                recover(slurm, recovery)
                fail(slurm, compare)
                left = list(slurm.processes())
            assert left, "the daemons ended before the test"
            assert not list(slurm.processes()), "processes remain after the test"
        except BaseException:
            for log in sorted(p for p in at.rglob("*") if p.parent.name == "log" and p.is_file()):
                print(f"--- {log.relative_to(at)}\n{log.read_text(errors='replace')[-3000:]}")
            raise
    print("passed: same bytes as a single run after a lost node, a requeued task and a lost part; a failing part cancels the merge")
    return 0


sys.exit(main())
