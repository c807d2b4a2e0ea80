#!/usr/bin/env python3
"""Checks that each option named by a message is an option of a command that prints the message, and that each key of project.json
or tune.json in apps/awmr/project_options.cpp exists.

usage: options.py SOURCE AWMR
"""
import json
import pathlib
import re
import subprocess
import sys

SOURCE, AWMR = pathlib.Path(sys.argv[1]), sys.argv[2]

# The commands that print the messages of a folder of the library.
COMMANDS = {"identify/compass": ["compass"], "identify/planning": ["suggest", "recover"], "identify": ["identify", "live"],
            "trials": ["identify", "live", "validate"], "tune": ["tune"], "validate": ["validate"], "compare": ["compare"],
            "emit": ["emit", "export"], "simulate": ["simulate", "compare", "tune", "validate"],
            "model": ["identify", "emit"], "report": ["report"]}


def awmr(*words):
    return subprocess.run([AWMR, *words], capture_output=True, text=True, check=True).stdout


def options_of(command, known={}):
    if command not in known:
        known[command] = set(re.findall(r"--([a-z][a-z-]*)", awmr(command, "--help")))
    return known[command]


every = set(re.findall(r"^  ([a-z]+) ", awmr("--help").split("Subcommands:")[-1].split("Examples:")[0], re.M))
assert {"run", "tune", "compare"} <= every, every


def commands_of(path):
    """The commands that print the messages of a source file; all commands if the file is shared."""
    name = path.relative_to(SOURCE).as_posix()
    own = re.fullmatch(r"apps/awmr/(\w+?)_\w+\.cpp", name)
    if own and own[1] in every:
        return [own[1]]
    for folder, commands in COMMANDS.items():
        if name.startswith(f"lib/awmr/{folder}/"):
            return commands
    return sorted(every)


MARKED = re.compile(r'option_text\("([a-z_-]+)')
NAMED = re.compile(r"\bawmr ([a-z]+) --([a-z-]+)")
named, wrong = 0, []
for path in sorted([*(SOURCE / "lib/awmr").rglob("*.cpp"), *(SOURCE / "apps/awmr").glob("*.cpp")]):
    text = path.read_text(encoding="utf-8")
    for option in (one.replace("_", "-") for one in MARKED.findall(text)):
        named += 1
        if not any(option in options_of(command) for command in commands_of(path)):
            wrong.append(f"{path.name}: none of {commands_of(path)} has --{option}")
    for command, option in NAMED.findall(text):
        if command in every and option not in options_of(command):
            wrong.append(f"{path.name}: {command} has no --{option}")
assert named > 60, named

def has_key(schema, names):
    if "$ref" in schema:
        return True
    branches = [schema, *schema.get("allOf", []), *schema.get("anyOf", []), *schema.get("oneOf", [])]
    for branch in branches:
        inner = branch.get("properties", {}).get(names[0])
        if inner is not None and (len(names) == 1 or has_key(inner, names[1:])):
            return True
    return False


rows = re.findall(r'\{"([a-z]+)", "([a-z-]+)", "([a-z_/]+)"\}', (SOURCE / "apps/awmr/project_options.cpp").read_text())
assert len(rows) > 20, rows
schemas = {name: json.loads(awmr("schema", name)) for name in ("project", "tune")}
for command, option, key in rows:
    if option not in options_of(command):
        wrong.append(f"project_options.cpp: {command} has no --{option}")
    if not has_key(schemas["tune" if command == "tune" else "project"], key.split("/")):
        wrong.append(f"project_options.cpp: no key {key}")
assert not wrong, "\n".join(wrong)
