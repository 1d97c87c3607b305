"""A newcomer's path as it is written: README's commands from the top, then the tutorial's, in a copy of the checkout.

Commands are taken from the pages. README's run for parts of a second where they say hours, and one that is not known here is
a failure. The tutorial's run for a twentieth of their seconds, and its scene has a twenty-fifth of its pixels: metrics of
campaigns take most of the time. In place of ./quickstart, which builds for minutes, stands the program of this build. With
NEWCOMER_ROOT, the folder of a Debian 12, the path is walked within it (chroot), ./quickstart is run, and the tutorial's
commands take all of their seconds and pixels: newcomer-test.
"""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from tree_files import tree_files  # noqa: E402  (the path has to be set first)

BARE = os.environ.get("NEWCOMER_ROOT", "")


class Step(NamedTuple):
    """How a command of README is shortened here, and the files that it leaves."""

    shorter: dict = {}
    leaves: list = []


QUICKSTART, EXPORT = "./quickstart", 'export PATH="$PWD/build/quickstart:$PATH"'
PART = "wavecrest render my/scene.xml --spp 4096 --part 3/8 --checkpoint part3"
KNOWN = {
    QUICKSTART: Step(leaves=["build/quickstart/wavecrest"] + ["out/quickstart/report.html"] * bool(BARE)),
    EXPORT: Step(),
    "wavecrest render cornell-diffuse --time 30s": Step({"30s": "0.5s"}, ["cornell-diffuse.exr"]),
    "wavecrest render my/scene.xml --time 8h --checkpoint my.checkpoint --resume -o my.exr": Step({"8h": "0.3s"}, ["my.checkpoint", "my.exr"]),
    PART: Step({"4096": "64"}, ["part1", "part8"]),
    "wavecrest merge part? -o my.exr": Step(leaves=["my.exr"]),
    "wavecrest render my/scene.xml --time 8h --view -o my.exr": Step({"8h": "0.3s"}, ["my.exr"]),
    "wavecrest inspect my/scene.xml": Step(),
    "wavecrest recommend my/scene.xml --target-ssim 0.95": Step({"0.95": "0.95 --budget 1s"}),
    "wavecrest reference my/scene.xml --time 1h": Step({"1h": "0.5s"}, ["scene.reference.exr"]),
    "wavecrest converge my/scene.xml --profile standard": Step({"standard": "standard --time-factor 0.01 --seeds 1 --size 64x48"}, ["out/converge/report.html"]),
    "wavecrest report out/converge": Step(leaves=["out/converge/report.html"]),
    "wavecrest compare scene.reference.exr my.exr --html cmp.html": Step(leaves=["cmp.html"]),
}
ELSEWHERE = {"mpirun -n 4 wavecrest render my/scene.xml --time 8h -o my.exr": "mpi.render runs it"}


def shortened(text):
    """A line of the tutorial, or its scene, with fewer seconds and pixels: outside of the bare Debian."""
    if BARE:
        return text
    for full, small in (('"width" value="320"', '"width" value="64"'), ('"height" value="240"', '"height" value="48"'), ("320x240", "64x48")):
        text = text.replace(full, small)
    return re.sub(r"\b(\d+)s\b", lambda seconds: f"{int(seconds[1]) / 20:g}s", text)


def commands_of(page):
    """The command lines of a Markdown page, without their comments: indented blocks, and fenced ones of sh."""
    fenced = re.findall(r"^```(?:sh|bash)\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    indented = re.findall(r"(?<=\n\n)((?:    \S[^\n]*\n)+)", re.sub(r"^```.*?^```$", "", page, flags=re.MULTILINE | re.DOTALL))
    return [re.sub(r"\s+# .*", "", line).strip() for block in [*indented, *fenced] for line in block.splitlines()]


class Pages(unittest.TestCase):
    """What can be seen without a run."""

    def setUp(self):
        self.readme, self.tutorial = ((ROOT / page).read_text() for page in ("README.md", "docs/tutorial.md"))

    def test_each_command_of_readme_is_known(self):
        self.assertEqual(commands_of(self.readme), [*dict.fromkeys(commands_of(self.readme))], "twice")
        self.assertEqual(set(commands_of(self.readme)), {*KNOWN, *ELSEWHERE})

    def test_commands_are_found_in_blocks_of_both_kinds(self):
        page = "Text.\n\n    a --b  # why\n    c\n\nText\n    wrapped.\n\n```sh\nd\n```\n\n```xml\n<e/>\n\n    <f/>\n```\n"
        self.assertEqual(commands_of(page), ["a --b", "c", "d"])

    def test_quickstart_leaves_what_readme_says(self):
        script = (ROOT / "quickstart").read_text()
        self.assertIn("-B build/quickstart", script)
        self.assertIn("`out/quickstart/report.html`", self.readme)
        self.assertIn("\nout=out/quickstart\n", script)

    def test_quickstart_helps_from_any_folder_and_ignores_nothing(self):
        for words, status, stream in ((["--help"], 0, "stdout"), (["--help", "x"], 2, "stderr"), (["--fast"], 2, "stderr")):
            command = [f"{ROOT.name}/quickstart", *words]
            told = subprocess.run(command, cwd=ROOT.parent, capture_output=True, text=True, check=False)
            self.assertEqual(told.returncode, status, told.stderr)
            self.assertIn("./quickstart --build-only ", getattr(told, stream))


class Newcomer(unittest.TestCase):
    def setUp(self):
        """A copy of the checkout's own files, in a folder of its own or in the bare Debian."""
        if BARE:
            self.checkout = "/wavecrest"
            shutil.rmtree(self.file(""), ignore_errors=True)
        else:
            folder = tempfile.TemporaryDirectory(prefix="wavecrest_newcomer_")
            self.addCleanup(folder.cleanup)
            self.checkout = folder.name
        self.path = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
        for name in tree_files(ROOT):
            self.file(name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.file(name))

    def file(self, name):
        """A file of the copy, seen from here."""
        return pathlib.Path(f"{BARE}{self.checkout}") / name

    def run_command(self, command, folder=""):
        """Runs a line as the newcomer's shell does; returns what it prints."""
        line = f"cd {shlex.quote(f'{self.checkout}/{folder}')} && export PATH={shlex.quote(self.path)} && {command}"
        done = subprocess.run([*(["chroot", BARE] if BARE else []), "bash", "-c", line], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def stand_in_for_quickstart(self):
        program = pathlib.Path(os.environ["WAVECREST"])
        self.file("build/quickstart").mkdir(parents=True)
        self.file("build/quickstart/wavecrest").symlink_to(program)

    def run_step(self, line):
        """A command of README, shortened."""
        command = line
        for word, short in KNOWN[line].shorter.items():
            command = command.replace(word, short)
        if line == QUICKSTART and not BARE:
            self.stand_in_for_quickstart()
        elif line == EXPORT:
            self.path = self.run_command(f'{line} && printf %s "$PATH"')
        elif line == PART:  # the other machines
            for part in range(1, 9):
                self.run_command(command.replace("3/8", f"{part}/8").replace("part3", f"part{part}"))
        else:
            self.run_command(command)
        for name in KNOWN[line].leaves:
            self.assertTrue(self.file(name).is_file(), f"{line} leaves no {name}")

    def test_the_path_from_readme_to_the_tutorials_report(self):
        readme, tutorial = ((ROOT / page).read_text() for page in ("README.md", "docs/tutorial.md"))
        scenes = re.findall(r"^```xml\n(.*?)^```$", tutorial, re.MULTILINE | re.DOTALL)
        self.assertEqual(len(scenes), 1)
        # README's commands, on a copy of the tutorial's scene named my/scene.xml.
        self.file("my").mkdir()
        scene = shortened(scenes[0])
        self.file("my/scene.xml").write_text(scene)
        for line in commands_of(readme):
            if line not in ELSEWHERE:
                self.run_step(line)
        self.assertIn("wavecrest", self.run_command("complete_file=$(mktemp) && wavecrest describe bash > $complete_file && source $complete_file && complete -p wavecrest"))
        # The tutorial, as it is written.
        self.file("tour").mkdir()
        self.file("tour/" + re.search(r"Save this as `([^`]+)`", tutorial)[1]).write_text(scene)
        commands = commands_of(tutorial)
        self.assertGreater(len(commands), 10)
        for command in commands:
            self.run_command(shortened(command), "tour")
        for made in ["room.exr", "room.png", "references/room.exr", "out/room/report.html", "others/report.html"]:
            self.assertTrue(self.file(f"tour/{made}").is_file(), made)
        # Options that the tutorial's text names.
        used = sorted({command.split()[1] for command in commands if command.startswith("wavecrest ")})
        known = "".join(self.run_command(f"wavecrest help {command}") for command in used)
        for option in re.findall(r"`(--[a-z-]+)", tutorial):
            self.assertRegex(known, rf"(?m)^  (-\w,)?{option} ")


if __name__ == "__main__":
    unittest.main()
