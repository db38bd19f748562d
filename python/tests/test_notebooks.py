# SPDX-License-Identifier: BSD-3-Clause
"""Runs the notebooks, by nbconvert where it is installed, else cell by cell."""
import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

NOTEBOOKS = sorted((pathlib.Path(__file__).parent.parent / "notebooks").glob("*.ipynb"))

needs_matplotlib = unittest.skipIf(importlib.util.find_spec("matplotlib") is None, "matplotlib is not installed")


class Notebooks(unittest.TestCase):
    def test_there_are_two(self):
        self.assertEqual(len(NOTEBOOKS), 2)

    @needs_matplotlib
    def test_their_cells_run(self):
        for notebook in NOTEBOOKS:
            with self.subTest(notebook.name):
                cells = json.loads(notebook.read_text())["cells"]
                code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
                run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, run.stderr)

    @needs_matplotlib
    def test_nbconvert_executes_them(self):
        if shutil.which("jupyter-nbconvert") is None:
            self.skipTest("jupyter-nbconvert is not installed")
        for notebook in NOTEBOOKS:
            with self.subTest(notebook.name), tempfile.TemporaryDirectory() as folder:
                run = subprocess.run(
                    ["jupyter-nbconvert", "--to", "notebook", "--execute", "--output-dir", folder, str(notebook)],
                    capture_output=True,
                    text=True,
                )
                self.assertEqual(run.returncode, 0, run.stderr)


if __name__ == "__main__":
    unittest.main()
