#!/usr/bin/env python3
"""Checks that apps/awmr/FINDINGS.md lists exactly the codes of all findings and errors, each with its severities.

usage: findings.py SOURCE
"""
import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
sources = [path for folder in ("lib/awmr", "apps/awmr", "apps/awmr-pil") for path in (SOURCE / folder).rglob("*")
           if path.suffix in (".cpp", ".h") and "assets" not in path.parts]
text = "\n".join(path.read_text(encoding="utf-8") for path in sources)
CODE = r'"([a-z]+(?:-[a-z]+)*)"'
# `Severity::kNote, "code"`, where each of the two may be a conditional expression: `is_bad ? ... : ...`.
MADE = re.compile(r"Severity::k(\w+)\s*(?::\s*Severity::k(\w+)\s*)?,\s*(?:[^\";{}]*\?\s*" + CODE + r"\s*:\s*)?" + CODE)
made = {}
for first, second, other, code in MADE.findall(text):
    for name in filter(None, (other, code)):
        made.setdefault(name, set()).update(severity.lower() for severity in (first, second) if severity)
assert len(made) > 80, made
errors = re.findall(CODE + r", ErrorCode::k", text)
assert len(errors) > 30, errors
for name in errors:
    made.setdefault(name, set()).add("error")
told = {}
for line in (SOURCE / "apps/awmr/FINDINGS.md").read_text(encoding="utf-8").splitlines():
    if not line.startswith("| `"):
        continue
    cells = line.split("|")
    codes = re.findall(r"`([a-z-]+)`", cells[1])
    severities = [set(cell.split(" or ")) for cell in cells[2].strip().split(", ")]
    assert len(severities) in (1, len(codes)), f"needs one severity, or one for each code: {line}"
    for code, severity in zip(codes, severities if len(severities) > 1 else severities * len(codes)):
        assert severity <= {"note", "warning", "error"}, line
        told.setdefault(code, set()).update(severity)
assert not made.keys() - told, f"codes without a line in FINDINGS.md: {sorted(made.keys() - told)}"
gone = [code for code in told if f'"{code}"' not in text]
assert not gone, f"codes in FINDINGS.md that no source has: {gone}"
wrong = {code: sorted(severity) for code, severity in made.items() if not severity <= told[code]}
assert not wrong, f"severities in the sources that FINDINGS.md does not list: {wrong}"
print(f"{len(told)} codes")
