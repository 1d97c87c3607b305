"""The package is clean under mypy --strict, and so is a program that uses it; a wrong one is not."""

import os
import subprocess
import sys
import tempfile
import unittest

GOOD = """
import wavecrest as wc

scene = wc.load("cornell-mirror", width=64, spp=4)
result: wc.Result = scene.render("vcm", time="1s", seed=1)
mean: float = float(result.image.mean())
for snapshot in scene.snapshots("bpt", times=[1, 2]):
    ssim: float = wc.compare(result, snapshot.image)["ssim"]
score: wc.Score = wc.metrics.hdrvdp2(result, result)
rows: wc.Table = wc.read_results("out").snapshots
"""
BAD = GOOD + "\nwrong: str = score\nscene.rendr()\nwide: str = scene.width\n"


class Types(unittest.TestCase):
    def mypy(self, *arguments):
        with tempfile.TemporaryDirectory() as cache:
            command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", cache, *arguments]
            environment = {**os.environ, "MYPYPATH": os.environ["PYTHONPATH"]}
            return subprocess.run(command, capture_output=True, text=True, env=environment, check=False)

    def check(self, text):
        with tempfile.NamedTemporaryFile("w", suffix=".py") as file:
            file.write(text)
            file.flush()
            return self.mypy(file.name)

    def test_the_package_is_clean(self):
        result = self.mypy("-p", "wavecrest")
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_programs_are_checked_against_it(self):
        good = self.check(GOOD)
        self.assertEqual(good.returncode, 0, good.stdout)
        self.assertIn("Found 3 errors", self.check(BAD).stdout)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
