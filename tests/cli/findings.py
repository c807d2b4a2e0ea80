#!/usr/bin/env python3
"""Checks that apps/awmr/FINDINGS.md lists exactly the codes of all findings.

usage: findings.py SOURCE
"""
import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
sources = [path for folder in ("lib/awmr", "apps/awmr", "apps/awmr-pil") for path in (SOURCE / folder).rglob("*")
           if path.suffix in (".cpp", ".h") and "assets" not in path.parts]
text = "\n".join(path.read_text(encoding="utf-8") for path in sources)
made = set(re.findall(r'Severity::k\w+\s*,\s*"([a-z]+(?:-[a-z]+)*)"', text))
assert len(made) > 40, made
told = set()
for line in (SOURCE / "apps/awmr/FINDINGS.md").read_text(encoding="utf-8").splitlines():
    if line.startswith("| `"):
        told.update(re.findall(r"`([a-z-]+)`", line.split("|")[1]))
assert not made - told, f"without a line in FINDINGS.md: {sorted(made - told)}"
gone = [code for code in told if f'"{code}"' not in text]
assert not gone, f"in FINDINGS.md, but no finding: {gone}"
print(f"{len(told)} codes")
