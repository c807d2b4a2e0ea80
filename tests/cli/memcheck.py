#!/usr/bin/env python3
"""Runs every command once under Valgrind's memcheck. Fails on an invalid memory access, a jump that depends on an
uninitialised value, or a memory leak. The sanitizers detect more but need a separate build (scripts/nightly).
usage: memcheck.py AWMR"""
import concurrent.futures
import importlib.machinery
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
AWMR = str(pathlib.Path(sys.argv[1]).resolve())
MEMCHECK = ["valgrind", "-q", "--error-exitcode=99", "--leak-check=full", "--errors-for-leak-kinds=definite",
            f"--suppressions={ROOT}/tests/cli/memcheck.supp"]


def fuzz_commands():
    """Loads scripts/fuzz_commands, which has a small valid file of each kind and the command lines."""
    loader = importlib.machinery.SourceFileLoader("fuzz_commands", str(ROOT / "scripts/fuzz_commands"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("fuzz_commands", loader))
    sys.dont_write_bytecode = True
    loader.exec_module(module)
    return module


def commands(at, files):
    """{name: command line}; commands without mutated files in scripts/fuzz_commands are defined here."""
    words = {name: files.command_of(name, at, at / f"out_{name}") for name in files.READ}
    for name in ("identify-log", "live"):
        # These searches would take minutes, because memcheck slows them by a factor of fifty.
        words[name] += ["--time-limit", "1"]
    both = ["--model", f"{at}/model.json", "--gains", f"{at}/gains.json"]
    words.update({
        "init": ["init", f"{at}/rover"],
        "pil": ["pil", *both, "--scenario", f"{at}/short.json", "--mode", "combined", "-o", f"{at}/pil.json"],
        "explain": ["explain", "not-identifiable"],
        "schema": ["schema", "-o", f"{at}/schemas"],
        "completion": ["completion", "bash"],
        "man": ["man", "identify"],
    })
    return words


def names_of_help():
    told = subprocess.run([AWMR, "--help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^  ([a-z]+) {2,}", told, re.MULTILINE))


def judge(name, words):
    done = subprocess.run([*MEMCHECK, AWMR, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    return name, words, done.returncode, done.stderr


def main():
    files = fuzz_commands()
    with tempfile.TemporaryDirectory() as folder:
        at = pathlib.Path(folder)
        files.good_files(at, AWMR)
        short = (at / "scenario.json").read_text().replace('"duration_s": 2', '"duration_s": 0.2')
        (at / "short.json").write_text(short)
        todo = commands(at, files)
        forgotten = names_of_help() - {words[0] for words in todo.values()}
        if not pathlib.Path(AWMR).with_name("awmr-pil").exists():
            del todo["pil"]
        failures = [f"this test does not run awmr {name}; add it to commands()" for name in sorted(forgotten)]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            for name, words, code, said in pool.map(lambda item: judge(*item), todo.items()):
                if code not in (0, 1):
                    failures.append(f"{name}: exit code {code}: {' '.join(words)}\n{said[-3000:]}")
    print(*failures, f"{len(todo)} commands under memcheck: {len(failures)} failures", sep="\n")
    return 1 if failures else 0


sys.exit(main())
