"""Runs scripts/bench with small inputs and checks that it prints every row of the tables in README.md and SCENARIOS.md, and that
every program gets the same results as awmr (otherwise scripts/bench fails). Speed is not tested.

usage: bench_test.py BUILD
  BUILD  the build folder with the programs
"""
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
BENCH = HERE.parent.parent / "scripts/bench"


def rows_of(text):
    """First cell of every row, with numbers replaced by N, because the sizes of small inputs differ from those of the pages."""
    return [re.sub(r"\d+", "N", line.split("|")[1].strip()) for line in text.split("\n") if line.startswith("| ")]


def main():
    done = subprocess.run([BENCH, "--quick", "--built", sys.argv[1]], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    tables = "".join((HERE / f"{page}.md").read_text().split("<!-- bench -->")[1] for page in ("README", "SCENARIOS"))
    printed, shown = rows_of(done.stdout), rows_of(tables)
    if printed != shown:
        sys.exit(f"the tables of README.md and SCENARIOS.md are out of date; run scripts/bench --write. Rows printed: {printed}; "
                 f"rows of the pages: {shown}")


if __name__ == "__main__":
    main()
