#!/usr/bin/env python3
"""Checks that no two types, and no two inline functions or templates with the same signature, have the same name in a namespace.

If the compiler does not inline two such definitions, the linker silently keeps only one of them for the whole program. Code
then uses the wrong one and can crash. usage: one_definition_test.py
"""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAMESPACE = re.compile(r"namespace\s*([\w:]*)\s*\{")
TYPE = re.compile(r"(?:template\s*<.*>\s*)?(?:struct|class|enum class|union)\s+(\w+)\s*(?:final\s*)?(?::[^:{][^{]*)?\{")
FUNCTION = re.compile(r"(?:template\s*<|inline\b|constexpr\b|AWMR_\w+)[^=;{]*?\b(\w+\([^{;]*\))[^;]*\{")


def code_of(path):
    """Returns the text without comments, strings and preprocessor lines, with the head of each definition on one line."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/|^\s*#[^\n]*", "", path.read_text(errors="replace"), flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r'R"(\w*)\(.*?\)\1"', '""', text, flags=re.DOTALL)
    text = re.sub(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', '""', text)
    return re.sub(r"\s+", " ", text)


def definitions(path):
    """(namespace, definition) of all types and inline functions outside of anonymous namespaces."""
    code = code_of(path)
    depth, open_at, names, start = 0, [], [], 0
    for m in re.finditer(r"[{};]", code):
        head = code[start:m.end()].strip()
        start = m.end()
        if m[0] == "}":
            depth -= 1
            if open_at and open_at[-1] == depth:
                open_at.pop()
                names.pop()
        elif m[0] == "{":
            space = NAMESPACE.search(head)
            if space and depth == len(open_at):
                open_at.append(depth)
                names.append(space[1] or "anonymous")
            elif depth == len(open_at) and "anonymous" not in names:
                defined = TYPE.match(head) or FUNCTION.match(head)
                if defined:
                    yield "::".join(names), re.sub(r"\s+", " ", defined[1])
            depth += 1


def main():
    where = collections.defaultdict(set)
    files = [p for folder in ("lib", "apps") for p in (ROOT / folder).rglob("*")
             if p.suffix in (".h", ".cpp") and "assets" not in p.parts]
    for path in files:
        for name in definitions(path):
            where[name].add(str(path.relative_to(ROOT)))
    twice = {name: places for name, places in where.items() if len(places) > 1}
    for (space, name), places in sorted(twice.items()):
        print(f"{space}::{name} is defined in {', '.join(sorted(places))}")
    print(f"{len(where)} definitions in {len(files)} files, {len(twice)} names defined more than once")
    return 1 if twice or len(where) < 500 else 0


sys.exit(main())
