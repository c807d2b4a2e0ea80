"""Checks the index of the paper's equations, lib/awmr/model/README.md, against the citations in lib/.

    equation_index_test.py           checks the sources; then checks that this test detects each kind of fault in a faulty copy of them
    equation_index_test.py --list    prints every citation with the declaration below it, for a new row
"""

import functools
import re
import shutil
import sys
import tempfile
import unittest
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INDEX = "lib/awmr/model/README.md"
LAST_EQUATION = 118

CITATION = re.compile(r"\[paper ([^\[\]]*)\]")
RANGE = r"\(\d+\)(?:-\(\d+\))?"
EQUATIONS = re.compile(rf"{RANGE}(?:, {RANGE})*(?:, corrected)?$")
PLACES = re.compile(r"(?:section )?\d+(?:\.\d+)*(?:, (?:section )?\d+(?:\.\d+)*)*$|App\. [A-Z]$")
ROW = re.compile(
    r"\| (?P<equations>\(\d[^|]*?) \| (?P<says>[^|]*?) \| \[(?P<file>[^\]]*)\]\((?P<link>[^)]*)\)"
    r" \| `(?P<function>\w+)` \| \[(?P<test>[^\]]*)\]\((?P<test_link>[^)]*)\)(?: by `(?P<by>\w+)`)? \|$"
)
NOTE = re.compile(r"\| (?P<equations>\(\d[^|]*?) \| [^|]+ \|$")
STATEMENTS = {"if", "for", "while", "switch", "return"}
NOT_A_DECLARATION = re.compile(r"\s*(//|#|template\b|(public|private|protected):|$)")


@dataclass(frozen=True)
class Citation:
    file: str
    line: int
    text: str
    names: frozenset  # of the declaration that it documents and of the enclosing scopes


def indent_of(line):
    return len(line) - len(line.lstrip())


def names_declared(lines, start):
    """The identifiers that the declaration beginning at lines[start] may declare."""
    text = ""
    for line in lines[start : start + 12]:
        text += " " + line.split("//")[0]
        if re.search(r"[;{]", text):
            break
    text = re.split(r"[;{]", text)[0]
    value = re.match(r"[^(]*?(\w+)(?:\[\])?\s*=", text)  # a constant or a field with a default
    if value:
        return [value[1]]
    typed = re.findall(r"\b(?:struct|class|enum class)\s+(\w+)", text)
    called = [name for name in re.findall(r"(\w+)\s*\(", text)[:1] if name not in STATEMENTS]
    return typed or called or re.findall(r"(\w+)\s*$", text)


def names_at(lines, at):
    names = set()
    if re.match(r"\s*//", lines[at]):
        below = at
        while below < len(lines) and NOT_A_DECLARATION.match(lines[below]):
            if not lines[below].strip():
                break
            below += 1
        names.update(names_declared(lines, below))
    else:
        names.update(names_declared(lines, at))
    indent = indent_of(lines[at])
    for above in range(at - 1, -1, -1):
        if indent == 0:
            break
        if indent_of(lines[above]) < indent and not NOT_A_DECLARATION.match(lines[above]):
            names.update(names_declared(lines, above))
            indent = indent_of(lines[above])
    return frozenset(names)


def sources(root):
    return sorted(p for p in (root / "lib").rglob("*") if p.suffix in (".h", ".cpp"))


def citations(root, faults):
    found = []
    for path in sources(root):
        file = path.relative_to(root).as_posix()
        text = path.read_text(encoding="utf-8")
        if "paper" not in text:
            continue
        lines = text.splitlines()
        for i, line in enumerate(lines):
            if "paper" not in line:
                continue
            place = f"{file}:{i + 1}"
            whole = CITATION.findall(line)
            if len(whole) != len(re.findall(r"\[paper\b", line)) or re.search(r"[\[(]paper\s*$", line):
                faults.append(f"{place}: a citation is broken over two lines; write it on one line")
            for text in whole:
                if EQUATIONS.match(text):
                    found.append(Citation(file, i + 1, text, names_at(lines, i)))
                elif not PLACES.match(text):
                    faults.append(f"{place}: [paper {text}] is neither equations, as in [paper (42), corrected], "
                                  "nor a section, as in [paper 5.2.2]")
    return found


def numbers(equations):
    covered = set()
    for first, last in re.findall(r"\((\d+)\)(?:-\((\d+)\))?", equations):
        covered.update(range(int(first), int(last or first) + 1))
    return covered


@functools.cache
def words_in(text):
    return frozenset(re.findall(r"\w+", text))


def mentions(path, name):
    return name in words_in(path.read_text(encoding="utf-8"))


def check(root):
    """Returns all faults of the sources as text, and the number of rows and citations."""
    faults = []
    cited = citations(root, faults)
    rows, covered = [], set()
    library = None
    for i, line in enumerate((root / INDEX).read_text(encoding="utf-8").splitlines()):
        place = f"{INDEX}:{i + 1}"
        row = ROW.match(line)
        if not row:
            if NOTE.match(line):
                covered |= numbers(NOTE.match(line)["equations"])
            elif line.startswith("| ("):
                faults.append(f"{place}: the row has neither the columns of the index nor those of the notes")
            continue
        rows.append(row)
        covered |= numbers(row["equations"])
        here = [c for c in cited if (c.file, c.text) == (row["file"], row["equations"])]
        if not here:
            faults.append(f"{place}: {row['file']} does not cite [paper {row['equations']}]")
        elif not any(row["function"] in c.names for c in here):
            faults.append(f"{place}: in {row['file']}, [paper {row['equations']}] is not cited at {row['function']}")
        for name, link in ((row["file"], row["link"]), (row["test"], row["test_link"])):
            if (root / INDEX).parent.joinpath(link).resolve() != (root / name).resolve():
                faults.append(f"{place}: the link {link} does not lead to {name}")
        test = root / row["test"]
        called = row["by"] or row["function"]
        if not row["test"].startswith("tests/") or not test.is_file():
            faults.append(f"{place}: there is no test {row['test']}")
        elif not mentions(test, called):
            faults.append(f"{place}: {row['test']} does not mention {called}")
        if row["by"]:
            library = library or frozenset().union(*(words_in(p.read_text(encoding="utf-8")) for p in sources(root)))
            if row["by"] not in library:
                faults.append(f"{place}: lib/ has no name {row['by']}")
    for c in cited:
        if not any((r["file"], r["equations"]) == (c.file, c.text) and r["function"] in c.names for r in rows):
            faults.append(f"{c.file}:{c.line}: [paper {c.text}] at {', '.join(sorted(c.names))} is not in {INDEX}")
    for number in sorted(set(range(1, LAST_EQUATION + 1)) - covered):
        faults.append(f"{INDEX}: has no row for equation ({number})")
    return faults, len(rows), len(cited)


class EquationIndex(unittest.TestCase):
    def test_agrees_with_the_citations(self):
        faults, rows, cited = check(ROOT)
        print(f"{rows} rows for {cited} citations")
        self.assertEqual([], faults, "\n" + "\n".join(faults))


class Faults(unittest.TestCase):
    """Checks that check() detects each kind of fault, in a copy of the sources."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = Path(folder.name)
        for part in ("lib", "tests"):
            shutil.copytree(ROOT / part, cls.root / part,
                            ignore=lambda _, names: [n for n in names if Path(n).suffix in (".csv", ".json")])
        lines = (ROOT / INDEX).read_text(encoding="utf-8").splitlines()
        cls.row = next(line for line in lines if ROW.match(line) and not ROW.match(line)["by"])
        cls.before = check(cls.root)[0]

    def write(self, file, text):
        """Replaces the text of a file until the end of the test."""
        path = self.root / file
        self.addCleanup(path.write_text, path.read_text(encoding="utf-8"), encoding="utf-8")
        path.write_text(text, encoding="utf-8")

    def edit(self, file, old, new):
        text = (self.root / file).read_text(encoding="utf-8")
        self.assertIn(old, text)
        self.write(file, text.replace(old, new, 1))

    def expect(self, text):
        new = [fault for fault in check(self.root)[0] if fault not in self.before]
        self.assertTrue(any(text in fault for fault in new), new)

    def test_a_citation_broken_over_two_lines(self):
        row = ROW.match(self.row)
        self.edit(row["file"], f"[paper {row['equations']}]", f"[paper\n/// {row['equations']}]")
        self.expect("broken over two lines")

    def test_an_equation_that_the_index_lacks(self):
        self.edit(INDEX, self.row + "\n", "")
        self.expect(f"is not in {INDEX}")

    def test_a_row_for_another_file(self):
        row = ROW.match(self.row)
        self.edit(INDEX, self.row, self.row.replace(row["file"], "lib/awmr/core/units.h"))
        self.expect("lib/awmr/core/units.h does not cite")

    def test_a_row_for_another_function(self):
        row = ROW.match(self.row)
        self.edit(INDEX, self.row, self.row.replace(f"`{row['function']}`", "`other_function`"))
        self.expect("is not cited at other_function")

    def test_a_test_that_does_not_exist(self):
        row = ROW.match(self.row)
        self.edit(INDEX, self.row, self.row.replace(row["test"], "tests/model/no_test.cpp"))
        self.expect("there is no test tests/model/no_test.cpp")

    def test_a_test_that_does_not_mention_the_function(self):
        row = ROW.match(self.row)
        self.write(row["test"], "// nothing\n")
        self.expect(f"{row['test']} does not mention {row['function']}")

    def test_an_equation_of_the_paper_that_is_passed_over(self):
        text = (self.root / INDEX).read_text(encoding="utf-8")
        kept = [l for l in text.splitlines() if not (l.startswith("| (") and 103 in numbers(l.split(" | ")[0]))]
        self.write(INDEX, "\n".join(kept) + "\n")
        self.expect("has no row for equation (103)")


if __name__ == "__main__":
    if sys.argv[1:] == ["--list"]:
        problems = []
        for c in citations(ROOT, problems):
            print(f"{c.file}:{c.line}: {c.text}: {', '.join(sorted(c.names))}")
        print("\n".join(problems))
    else:
        unittest.main()
