"""Checks that every cell of the example notebook runs in a folder filled by `awmr init --example .`."""
import contextlib
import io
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

NOTEBOOK = Path(os.environ["SOURCE"]) / "apps/python/example.ipynb"


class Notebook(unittest.TestCase):
    def test_every_cell_runs(self):
        notebook = json.loads(NOTEBOOK.read_text())
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.environ["AWMR"], "init", "--quiet", "--example", folder], check=True)
            names, told = {}, io.StringIO()
            try:
                os.chdir(folder)
                with contextlib.redirect_stdout(told):
                    for number, cell in enumerate(notebook["cells"]):
                        if cell["cell_type"] != "code":
                            continue
                        self.assertEqual(cell["outputs"], [], "committed without outputs")
                        exec(compile("".join(cell["source"]), f"cell {number}", "exec"), names)
            finally:
                os.chdir(before)
        for words in ("surge.alpha", "of the law", "heading ", "combined", "turning.csv:"):
            self.assertIn(words, told.getvalue())


if __name__ == "__main__":
    unittest.main()
