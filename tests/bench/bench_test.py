"""Runs scripts/bench with small inputs and checks that it produces every row of README.md and SCENARIOS.md. The script exits with 1 if a row does other
work than awmr. Speed is not tested. usage: bench_test.py BUILD
"""
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
BENCH = HERE.parent.parent / "scripts/bench"


def rows_of(text):
    """First cell of every row; small inputs have other sizes."""
    return [re.sub(r"\d+", "N", line.split("|")[1].strip()) for line in text.split("\n") if line.startswith("| ")]


def main():
    done = subprocess.run([BENCH, "--quick", "--built", sys.argv[1]], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    tables = "".join((HERE / f"{page}.md").read_text().split("<!-- bench -->")[1] for page in ("README", "SCENARIOS"))
    printed, shown = rows_of(done.stdout), rows_of(tables)
    if printed != shown:
        sys.exit(f"scripts/bench --write was not run since its rows changed: {printed} are printed, the pages have {shown}")


if __name__ == "__main__":
    main()
