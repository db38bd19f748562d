# SPDX-License-Identifier: BSD-3-Clause
"""scripts/figures: what is there with the same inputs is not made again, and stays in the page."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BUILD = pathlib.Path(sys.argv.pop())


class Figures(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.temporary.name) / "figures"

    def tearDown(self):
        self.temporary.cleanup()

    def make(self, *figures):
        script = [sys.executable, ROOT / "scripts/figures", "--quick", "--build", BUILD, self.out, *figures]
        return subprocess.run(script, capture_output=True, text=True)

    def test_isMadeOnceForTheSameInputs(self):
        first = self.make("3")
        self.assertEqual(first.returncode, 0, first.stderr)
        self.assertIn("propagation-clouds", first.stdout)
        page = (self.out / "index.html").read_text()
        picture = "pictures/3-clouds-propagation_clouds.png"
        self.assertIn(picture, page)
        self.assertIn("prefers-color-scheme:dark", page)
        for kind in (".png", ".svg", ".pdf"):
            self.assertTrue((self.out / picture).with_suffix(kind).exists())
        self.assertIn(f"<a href='{picture[:-4]}.pdf'>PDF</a>", page)
        self.assertNotIn("propagation-clouds", self.make("3").stdout)
        record = self.out / "records/clouds.json"
        record.write_text(json.dumps({**json.loads(record.read_text()), "inputs": "others"}))
        self.assertIn("propagation-clouds", self.make("3").stdout)

    def test_figuresOfEarlierCallsStayInThePage(self):
        self.assertEqual(self.make("10").returncode, 0)
        self.assertEqual(self.make("3").returncode, 0)
        page = (self.out / "index.html").read_text()
        self.assertLess(page.index("<h2>Figure 3</h2>"), page.index("<h2>Figure 10</h2>"))
        for picture in ("3-clouds-propagation_clouds.png", "10-stripes-0.1-trace.png"):
            self.assertIn(f"src='pictures/{picture}'", page)
            self.assertTrue((self.out / "pictures" / picture).exists())

    def test_thatThePaperHasNotIsRefused(self):
        unknown = self.make("3", "99")
        self.assertEqual(unknown.returncode, 2)
        self.assertIn("no figure 99", unknown.stderr)
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()
