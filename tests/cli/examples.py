#!/usr/bin/env python3
"""Every `awmr` example of the README and of the commands' helps runs where `init --example` wrote their files, and the
JSON files that they write are valid by the program's schemas. usage: examples.py AWMR [RUN]
RUN: results of configs/paper/project.json, which is then not run again (pipeline_test.cpp)."""
import importlib.util
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
AWMR = str(Path(sys.argv[1]).resolve())
# Each after those whose files it uses. Completion's examples are of the shell.
COMMANDS = ("init", "check", "run", "identify", "live", "tune", "validate", "simulate", "compare", "merge", "emit",
            "export", "report", "suggest", "recover", "map", "compass", "schema", "man")


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
    """Whether the inputs of the paper's project in the folder are those of the source."""
    names = [path.relative_to(folder) for place in ("configs/paper", "datasets/paper") for path in (folder / place).rglob("*.*")]
    return names and all((folder / name).read_bytes() == (SOURCE / name).read_bytes() for name in names)


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
        paper_run = "awmr run configs/paper/project.json -o out"
        assert paper_run in lines
        if len(sys.argv) > 2:
            assert is_like_source(Path(folder))
            shutil.copytree(sys.argv[2], Path(folder, "out"))
            lines.remove(paper_run)
        fine &= all([runs(line, folder) for line in lines[1:]])
        print(f"{len(lines)} examples")
        if importlib.util.find_spec("jsonschema"):
            schemas = [sys.executable, Path(__file__).with_name("schemas.py"), AWMR, folder]
            fine &= subprocess.run(schemas).returncode == 0
    return 0 if fine else 1


sys.exit(main())
