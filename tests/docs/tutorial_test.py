"""The tutorial as a newcomer follows it: its scene is saved under the name that it says, its commands are run in order in an
empty folder, and what it speaks of is there afterwards. No step may be missing from the page."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

TUTORIAL = pathlib.Path(__file__).resolve().parents[2] / "docs/tutorial.md"
PROGRAM = pathlib.Path(os.environ["WAVECREST"])


class Tutorial(unittest.TestCase):
    def test_every_command_works_as_it_is_written(self):
        text = TUTORIAL.read_text()
        blocks = re.findall(r"^```(xml|sh)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        scene = [body for kind, body in blocks if kind == "xml"]
        commands = [line for kind, body in blocks if kind == "sh" for line in body.splitlines()]
        self.assertEqual(len(scene), 1)
        self.assertGreater(len(commands), 5)
        environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"}
        with tempfile.TemporaryDirectory() as folder:
            here = pathlib.Path(folder)
            (here / re.search(r"Save this as `([^`]+)`", text)[1]).write_text(scene[0])
            for command in commands:
                with self.subTest(command):
                    done = subprocess.run(["bash", "-c", command], cwd=here, env=environment, capture_output=True, text=True)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            for made in ["room.exr", "room.png", "references/room.exr", "out/room/report.html", "others/report.html"]:
                self.assertTrue((here / made).is_file(), made)

    def test_options_that_the_text_names_exist(self):
        text = TUTORIAL.read_text()
        commands = sorted(set(re.findall(r"^wavecrest ([a-z]+)", text, re.MULTILINE)))
        options = re.findall(r"`(--[a-z-]+)", text)
        self.assertTrue(options)
        known = "".join(
            subprocess.run([PROGRAM, "help", command], capture_output=True, text=True, check=True).stdout for command in commands
        )
        for option in options:
            self.assertRegex(known, rf"(?m)^  (-\w,)?{option} ")


if __name__ == "__main__":
    unittest.main()
