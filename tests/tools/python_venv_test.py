"""tools/python-venv: pip is called where the environment differs from the pins, with stand-ins for python3 and pip."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"


class PythonVenv(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_python_venv_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.tools = self.folder / "tools"
        self.tools.mkdir()
        shutil.copy(TOOLS / "python-venv", self.tools)
        (self.tools / "requirements-peers.txt").write_text("-r requirements.txt\npeer==1\n")
        self.calls = self.folder / "calls"
        self.calls.touch()
        self.program("pip", f"echo >> {self.calls}")
        pip = self.folder / "pip"
        self.program("python3", f'mkdir -p "$3/bin"; cp {pip} "$3/bin/pip"; cp {pip} "$3/bin/python"')

    def program(self, name, script):
        (self.folder / name).write_text(f"#!/bin/sh\n{script}\n")
        (self.folder / name).chmod(0o755)

    def calls_after(self, pins, *options):
        """How often pip has been called by now."""
        (self.tools / "requirements.txt").write_text(pins)
        environment = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"}
        subprocess.run([self.tools / "python-venv", *options], env=environment, check=True, capture_output=True)
        return len(self.calls.read_text().splitlines())

    def test_pins_that_come_back_are_installed_again(self):
        a, b = "one==1\nother==1\n", "one==2\nother==1\n"
        self.assertEqual([self.calls_after(pins) for pins in (a, a, b, a, a)], [1, 1, 2, 3, 3])

    def test_packages_of_another_group_stay(self):
        self.assertEqual(self.calls_after("one==1\n", "--peers"), 1)
        self.assertEqual(self.calls_after("one==1\n"), 1)
        self.assertEqual(self.calls_after("one==2\n"), 2)
        self.assertEqual(self.calls_after("one==2\n", "--peers"), 2)

    def test_an_environment_without_its_interpreter_has_no_packages(self):
        self.calls_after("one==1\n", "--peers")
        (self.folder / "build" / "venv" / "bin" / "python").unlink()
        self.assertEqual(self.calls_after("one==1\n"), 2)
        self.assertEqual(self.calls_after("one==1\n", "--peers"), 3)


if __name__ == "__main__":
    unittest.main()
