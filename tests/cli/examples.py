#!/usr/bin/env python3
"""Runs every `awmr` example of the README, of COMMANDS.md and of the help texts in a directory filled by `awmr init --example`, and
validates the JSON files that they write against the program's schemas.

usage: examples.py AWMR [RUN]
  RUN  directory with existing results of configs/paper/project.json (pipeline_test.cpp). With RUN that project is not run again, other
       searches for gains are short, and the paper's claims are not checked."""
import importlib.util
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
AWMR = str(Path(sys.argv[1]).resolve())
# Commands in an order in which each follows those whose files it uses. The examples of `completion` are for the shell.
COMMANDS = ("init", "check", "run", "identify", "live", "tune", "validate", "simulate", "compare", "merge", "emit",
            "export", "report", "suggest", "recover", "map", "compass", "explain", "schema", "man")


def examples_of_readme():
    for page in ("README.md", "apps/awmr/COMMANDS.md"):
        inside = False
        for line in (SOURCE / page).read_text().splitlines():
            if line.startswith("```"):
                inside = line == "```sh"
            elif inside and line.startswith("awmr "):
                yield line


def examples_of_help(command):
    text = subprocess.run([AWMR, command, "--help"], capture_output=True, text=True, check=True).stdout
    examples = [line[2:].split("|")[0].strip() for line in text.splitlines() if line.startswith("  awmr ")]
    assert examples, f"awmr {command} --help has no example"
    return examples


def runs(line, folder):
    done = subprocess.run(f"'{AWMR}'{line.removeprefix('awmr')}", shell=True, cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"{line}: exit code {done.returncode}\n{done.stderr}")
    return done.returncode == 0


def is_like_source(folder):
    """True if the folder has the inputs of the paper's project and they equal those in the source tree."""
    names = [path.relative_to(folder) for place in ("configs/paper", "datasets/paper") for path in (folder / place).rglob("*.*")]
    return names and all((folder / name).read_bytes() == (SOURCE / name).read_bytes() for name in names)


def shortened(lines, folder, paper_run):
    """Returns the examples changed to use the results of RUN and short searches, without the paper's claims."""
    assert is_like_source(folder)
    shutil.copytree(paper_run, folder / "out")
    search = {"global_evaluations": 20, "local_evaluations": 5, "draws": 2, "judged_draws": 4, "mode": "combined"}
    (folder / "tune_short.json").write_text(json.dumps(search))
    project = json.loads((folder / "configs/synthetic/project.json").read_text())
    (folder / "configs/synthetic/project_short.json").write_text(json.dumps(
        {**project, "identify": {"family": ["power"]}, "tune": "../../tune_short.json"}))
    changed = {"awmr run configs/paper/project.json -o out": None,
               "awmr run configs/synthetic/project.json -o driven": "awmr run configs/synthetic/project_short.json -o driven",
               "awmr tune --model model.json -o gains.json": "awmr tune --model model.json --config tune_short.json -o gains.json",
               "awmr validate --model model.json --claims -o claims.json": None}
    assert set(changed) <= set(lines)
    return [changed.get(line, line) for line in lines if changed.get(line, line)]


def main():
    readme = list(examples_of_readme())
    assert len(readme) >= 7, readme
    lines = dict.fromkeys(readme)  # each example once, in this order
    for command in COMMANDS:
        lines.update(dict.fromkeys(examples_of_help(command)))
    with tempfile.TemporaryDirectory() as folder:
        first = "awmr init --example ."
        assert first in lines
        lines = [first, *(line for line in lines if line != first)]
        fine = runs(first, folder)
        if len(sys.argv) > 2:
            lines = shortened(lines, Path(folder), sys.argv[2])
        fine &= all([runs(line, folder) for line in lines[1:]])
        print(f"{len(lines)} examples")
        if importlib.util.find_spec("jsonschema"):
            schemas = [sys.executable, Path(__file__).with_name("schemas.py"), AWMR, folder]
            fine &= subprocess.run(schemas).returncode == 0
    return 0 if fine else 1


sys.exit(main())
