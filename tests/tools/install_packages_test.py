"""tools/install-packages for users without rights, with stand-ins for the system's programs."""

import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"


class InstallPackages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_install_packages_")
        self.addCleanup(folder.cleanup)
        self.programs = pathlib.Path(folder.name)
        for name in ("dirname", "sed"):
            (self.programs / name).symlink_to(shutil.which(name))
        self.program("id", "echo 1000")
        self.program("dpkg-query", "exit 1")  # nothing is installed

    def program(self, name, script):
        (self.programs / name).write_text(f"#!/bin/sh\n{script}\n")
        (self.programs / name).chmod(0o755)

    def run_tool(self, *groups):
        command = [TOOLS / "install-packages", *groups]
        return subprocess.run(command, env={"PATH": str(self.programs)}, capture_output=True, text=True, check=False)

    def test_without_sudo_it_says_what_root_has_to_run(self):
        for script in (None, "exit 1"):  # not there, or refusing
            if script:
                self.program("sudo", script)
            result = self.run_tool("python")
            self.assertEqual((result.returncode, result.stdout), (1, ""))
            command = "apt-get update && apt-get install -y --no-install-recommends python3-venv python3-dev"
            self.assertEqual(result.stderr.splitlines()[-1], command)

    def test_with_sudo_apt_get_asks_nothing(self):
        self.program("sudo", 'echo "$@"')
        result = self.run_tool("python")
        self.assertEqual(result.returncode, 0, result.stderr)
        for words in ("update -qq", "install -y -qq --no-install-recommends python3-venv python3-dev"):
            self.assertIn(f"env DEBIAN_FRONTEND=noninteractive apt-get {words}\n", result.stdout)

    def test_a_group_that_is_not_there_is_told_from_all_that_are(self):
        groups = set(re.findall(r"^([a-z]+) ", (TOOLS / "packages.txt").read_text(), re.MULTILINE))
        result = self.run_tool("nonsense")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(set(re.findall(r"\w+", result.stderr.split("expected ")[1])) - {"or"}, groups)


if __name__ == "__main__":
    unittest.main()
