# SPDX-License-Identifier: BSD-3-Clause
"""scripts/screenshots: every picture of docs/samples.md has its command, and is as wide and as small as it should be."""

import importlib.machinery
import importlib.util
import io
import pathlib
import re
import unittest

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = (ROOT / "docs/samples.md").read_text()


def screenshots():
    loader = importlib.machinery.SourceFileLoader("screenshots", str(ROOT / "scripts/screenshots"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


class Screenshots(unittest.TestCase):
    def test_everyPictureOfThePageHasItsCommand(self):
        commands = {match[1]: match[4] for match in screenshots().SCREENSHOT.finditer(PAGE)}
        self.assertEqual(list(commands), re.findall(r"\(images/report_(\w+)\.jpg\)", PAGE))
        for name, command in commands.items():
            self.assertEqual(command.split()[0], name)

    def test_picturesAreAsWideAndSmallAsMeant(self):
        for name in re.findall(r"images/report_\w+\.jpg", PAGE):
            file = ROOT / "docs" / name
            with Image.open(file) as picture:
                self.assertEqual(picture.width, screenshots().WIDTH, name)
            self.assertLessEqual(file.stat().st_size, screenshots().MOST_BYTES, name)

    def test_aPictureOfManyDetailsIsCompressedMore(self):
        noise = Image.effect_noise((1280, 600), 80).convert("RGB")
        self.assertLessEqual(len(screenshots().jpegOf(noise)), screenshots().MOST_BYTES)
        plain = screenshots().jpegOf(Image.new("RGB", (1280, 600)))
        self.assertLess(len(plain), 20_000)
        self.assertEqual(Image.open(io.BytesIO(plain)).size, (1280, 600))


if __name__ == "__main__":
    unittest.main()
