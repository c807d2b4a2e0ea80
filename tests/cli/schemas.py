#!/usr/bin/env python3
"""Validates JSON against the program's own JSON Schemas: every file that the program writes, every file of configs/, and the output of
--json. Also checks that the schemas refuse the malformed files that the program refuses.

usage: schemas.py AWMR [FOLDER]
  FOLDER  validates only the JSON files in this folder"""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import jsonschema

SOURCE = Path(__file__).resolve().parents[2]
AWMR = str(Path(sys.argv[1]).resolve())

# Error codes of faults that depend on one key only. A schema can detect the cases of malformed.txt with these codes.
BY_ONE_KEY = ("missing", "wrong-type", "out-of-range", "unknown-name")
# Cases that no schema detects. Rules between two keys: a line goes from_m to_m unless it has points_m, and a scenario has a speed_mps unless its
# headings have a tau_speed.
# Also: the order of two numbers, sizes of lists that depend on others, names of parameters, trials
# and laws.
BEYOND_SCHEMA = {(kind, f":/{place}", code) for kind, place, code in (
    ("vehicle", "steering/max_deg", "out-of-range"), ("vehicle", "surge_beta_range", "wrong-type"),
    ("vehicle", "surge_beta_range", "out-of-range"), ("vehicle", "yaw_beta_range", "out-of-range"),
    ("scenario", "guidance/points_m", "wrong-type"), ("scenario", "guidance/points_m", "out-of-range"),
    ("scenario", "guidance/from_m", "wrong-type"), ("scenario", "guidance/amplitude_m", "wrong-type"),
    ("scenario", "corner/surge.alfa", "unknown-name"), ("gains", "observer/bandwidth_radps", "out-of-range"),
    ("gains", "modes/steering/observer/bandwidth_radps", "out-of-range"),
    ("model", "surge/alpha/ci95", "wrong-type"), ("model", "yaw_scrub/yaw_rate_radps", "wrong-type"),
    ("model", "covariance/parameters", "unknown-name"), ("model", "covariance/matrix", "wrong-type"),
    ("model", "covariance/matrix", "out-of-range"), ("model", "estimates/0/parameters/0/name", "unknown-name"),
    ("project", "trials", "missing"), ("project", "identify/family", "unknown-name"),
    ("project", "identify/fit", "unknown-name"), ("project", "compare/scenarios", "missing"),
    ("project", "compare/heading_rate_limit", "out-of-range"))}
BETWEEN_KEYS = ['scenario | /guidance = {"type": "line", "from_m": [0, 0], "delta_deg": 60, "width_m": 5} '
                '| :/guidance/to_m | missing',
                'scenario | /speed_mps gone | :/speed_mps | missing']


def awmr(words, folder, codes=(0,)):
    run = subprocess.run([AWMR] + words.split(), cwd=folder, capture_output=True, text=True)
    assert run.returncode in codes, f"{words}: {run.returncode}\n{run.stderr}"
    return run


def schemas_of(folder):
    awmr(f"schema -o {folder}/schemas", folder)
    found = {}
    for path in sorted(Path(folder, "schemas").iterdir()):
        schema = json.loads(path.read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        name = path.name.removesuffix(".schema.json")
        found[name] = jsonschema.Draft202012Validator(schema)
        assert awmr(f"schema {name}", folder).stdout == path.read_text()
    return found


def kind_of(document, path):
    if "schema" in document:
        return document["schema"].split(".")[1].split("/")[0]
    return "scenario" if path.parent.name == "scenarios" else path.stem.split("_")[0]


def check(validators, document, where, kind):
    faults = list(validators[kind].iter_errors(document))
    for fault in faults[:5]:
        pointer = "/".join(map(str, fault.absolute_path))
        print(f"{where}: does not match {kind}.schema.json: /{pointer}: {fault.message[:200]}")
    return not faults


def pipeline(folder):
    """Runs every command that writes a JSON file; returns the files of every format."""
    for name in ("configs", "datasets"):
        os.symlink(SOURCE / name, Path(folder, name))
    c3 = "configs/paper/scenarios/c3_heading_steps.json"
    loop = "--model out/model.json --gains out/gains.json"
    turn = json.loads(Path(folder, c3).read_text())
    Path(folder, "scenario_turn.json").write_text(json.dumps({**turn, "duration_s": 8, "guidance": {"type": "heading", "steps": [{"t_s": 0, "psi_deg": 30}]}}))
    short = {"global_evaluations": 20, "local_evaluations": 5, "draws": 2, "judged_draws": 4, "scenarios": ["scenario_turn.json"]}
    goals = {"goals": [{"at_most": {"settling_time_s": 6}}, {"at_most": {"overshoot_deg": 1}, "soft": True}], **short,
             "observer": {"bandwidth_radps": [0.5, 5]},
             "open": {"mass_factors": [1, 1.2], "wheel_forces": [{"min": -1, "max": 1}]}}
    Path(folder, "striving.json").write_text(json.dumps({"schema": "awmr.tune/1", **goals}))
    Path(folder, "short.json").write_text(json.dumps({"schema": "awmr.tune/1", **short}))
    project = json.loads(Path(folder, "configs/paper/project.json").read_text())
    project["vehicle"] = "configs/paper/vehicle.json"
    project["trials"] = {name: path.removeprefix("../../") for name, path in project["trials"].items()}
    project["compare"]["scenarios"] = [c3]
    Path(folder, "project.json").write_text(json.dumps({**project, "tune": "striving.json"}))
    prints = [
        awmr("run project.json -o out --json", folder),
        awmr("identify --vehicle configs/paper/vehicle.json --log datasets/synthetic/drive_1.csv "
             "-o driven.json --json", folder),
        awmr("validate --model driven.json --log datasets/synthetic/drive_2.csv -o logs.json --json", folder),
        awmr("tune --nominal --mode combined --config short.json --model out/model.json -o nominal.json --json", folder),
        awmr("suggest --model out/model.json -o suggest.json --json", folder),
        awmr("recover --model out/model.json --runs 5 -o recover.json --json", folder),
        awmr("map datasets/synthetic/drive_1.csv -o map.json --json", folder),
        awmr(f"simulate {loop} --scenario {c3} --mode combined -o run.csv --json", folder),
        awmr(f"simulate {loop} --scenario configs/scenarios/gps_dropout.json --mode combined -o gps_run.csv --json", folder),
        awmr(f"compare {loop} --scenario {c3} --samples 2 --shard 1/2 -o part1 --json", folder),
        awmr(f"compare {loop} --scenario {c3} --samples 2 --shard 2/2 -o part2 --json", folder),
        awmr("merge part1 part2 -o merged --json", folder),
        awmr("recover --model out/model.json --runs 5 --shard 1/2 -o recovered1 --json", folder),
        awmr("recover --model out/model.json --runs 5 --shard 2/2 -o recovered2 --json", folder),
        awmr("merge recovered1 recovered2 -o recovered --json", folder),
        awmr(f"emit {loop} -o firmware --json", folder),
        awmr("init rover --json", folder),
        awmr("check rover --json", folder, (1,)),
    ]
    errors = [awmr("tune --model nowhere.json -o x --json", folder, (2,)), awmr("run --json", folder, (2,))]
    if Path(AWMR).with_name("awmr-pil").exists():
        prints.append(awmr(f"pil {loop} --scenario {c3} --mode combined -o pil.json --json", folder))
    return [json.loads(run.stdout) for run in prints] + [json.loads(run.stderr) for run in errors]


def edited(document, edit):
    """The document with an edit of malformed.txt, as in malformed_test.cpp; None if the edit is not one of a JSON document."""
    if edit.startswith("text"):
        return None
    document = json.loads(json.dumps(document))
    pointer, value = (edit[:-5], None) if edit.endswith(" gone") else edit.split(" = ", 1)
    keys = pointer.split("/")[1:]
    place = document
    for key in keys[:-1]:
        place = place[int(key)] if isinstance(place, list) else place.setdefault(key, {})
    last = int(keys[-1]) if isinstance(place, list) else keys[-1]
    if value is None:
        del place[last]
    else:
        place[last] = json.loads(value)
    return document


def malformed(validators, good):
    """Checks that the schemas refuse the cases of malformed.txt that they can detect; returns the number checked."""
    seen, passed = 0, []
    for line in (SOURCE / "tests/cli/malformed.txt").read_text().splitlines():
        fields = line.split(" | ")
        if len(fields) < 4 or fields[0] not in good or fields[3] not in BY_ONE_KEY:
            continue
        document = edited(good[fields[0]], fields[1])
        if document is None or not fields[2]:
            continue
        seen += 1
        if validators[fields[0]].is_valid(document):
            passed.append(line)
    passed = [line for line in passed if line not in BETWEEN_KEYS and
              (line.split(" | ")[0], *line.split(" | ")[2:4]) not in BEYOND_SCHEMA]
    for line in passed:
        print("the schema accepts, but the program refuses:", line)
    return seen, not passed


def files_are_valid(validators, files, kinds):
    fine = True
    for path in files:
        document = json.loads(path.read_text())
        kinds.add(kind_of(document, path))
        fine &= check(validators, document, path, kind_of(document, path))
    return fine


def files_of(folder):
    """The JSON files in the folder, without those of `init` that contain null and without PlatformIO's library.json."""
    return sorted(p for p in Path(folder).rglob("*.json")
                  if not {"schemas", "rover", "my_rover"} & set(p.parts) and p.name != "library.json")


def main():
    with tempfile.TemporaryDirectory() as folder:
        validators = schemas_of(folder)
        kinds = set()
        if len(sys.argv) > 2:
            files = files_of(sys.argv[2])
            fine = files_are_valid(validators, files, kinds)
            print(f"{len(files)} files of {len(kinds)} formats: {', '.join(sorted(kinds))}")
            return 0 if fine and len(kinds) >= 15 else 1
        fine = all([check(validators, document, document.get("command", "an error"), kind_of(document, Path()))
                    for document in pipeline(folder)])
        files = files_of(folder) + sorted((SOURCE / "configs").rglob("*.json"))
        fine &= files_are_valid(validators, files, kinds)
        good = {"vehicle": SOURCE / "configs/paper/vehicle.json",
                "scenario": SOURCE / "configs/paper/scenarios/c3_heading_steps.json",
                "project": SOURCE / "configs/paper/project.json",
                "model": Path(folder, "out/model.json"), "gains": Path(folder, "out/gains.json")}
        seen, refused = malformed(validators, {k: json.loads(p.read_text()) for k, p in good.items()})
        print(f"{len(files)} files of {len(kinds)} formats; {seen} malformed ones")
        return 0 if fine and refused and seen > 100 and len(kinds) >= 10 else 1


sys.exit(main())
