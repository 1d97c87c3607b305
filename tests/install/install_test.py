"""Installs the build into a folder, as a package would, and uses it from there alone: the program finds its scenes, the
example project its library, shells their completions."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = os.environ["WAVECREST_BUILD"]
EXAMPLE = pathlib.Path(__file__).resolve().parent / "example"
# Nothing of the source tree: the installed program has to get along without it.
ENVIRONMENT = {"PATH": os.environ["PATH"], "HOME": "/nonexistent"}


def run(*command, **options):
    result = subprocess.run(
        list(map(str, command)), capture_output=True, text=True, timeout=300, check=False, env=ENVIRONMENT, **options
    )
    if result.returncode != 0:
        raise AssertionError(f"{command}\n{result.stdout}\n{result.stderr}")
    return result.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="wavecrest_install_")
        cls.addClassCleanup(cls.folder.cleanup)
        first = pathlib.Path(cls.folder.name) / "first"
        run("cmake", "--install", BUILD, "--prefix", first)
        cls.folders = {path.name for path in first.iterdir()}
        cls.prefix = first.with_name("moved")
        first.rename(cls.prefix)  # nothing may depend on where it was installed
        cls.program = cls.prefix / "bin" / "wavecrest"

    def one(self, pattern):
        found = list(self.prefix.glob(pattern))
        self.assertEqual(len(found), 1, f"{pattern}: {found}")
        return found[0]

    def render(self, name):
        image = self.prefix / name
        run(self.program, "render", "cornell-mirror", "-m", "vcm", "--spp", 4, "--seed", 7, "--size", "32x24",
            "--threads", 2, "-o", image)  # fmt: skip
        return image

    def test_the_usual_folders_are_all_that_is_installed(self):
        self.assertEqual(self.folders, {"bin", "include", "lib", "share"})  # nothing of the wheel's

    def test_the_program_uses_the_installed_scenes(self):
        mirror = self.one("share/wavecrest/scenes/cornell-mirror.xml")
        mirror.write_text(mirror.read_text().replace("<scene", "<nonsense", 1))
        result = subprocess.run([self.program, "inspect", "cornell-mirror"], capture_output=True, text=True,
                                env=ENVIRONMENT, check=False)  # fmt: skip
        mirror.write_text(mirror.read_text().replace("<nonsense", "<scene", 1))
        self.assertEqual(result.returncode, 3)
        self.assertIn(str(mirror), result.stderr)

    def test_assets_and_references_are_installed(self):
        self.one("share/wavecrest/scenes/assets/teapot.ply")
        self.one("share/wavecrest/scenes/references/pool-interior.exr")

    def test_the_example_renders_what_the_program_renders(self):
        build = self.prefix / "example"
        run("cmake", "-S", EXAMPLE, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", "-DCMAKE_BUILD_TYPE=Debug")
        run("cmake", "--build", build)
        image = self.prefix / "example.exr"
        said = run(build / "example", image).splitlines()
        self.assertEqual(
            said,
            [
                "iterations 2",
                "size 32 x 24",
                "same as rendered 1",
                "rmse to itself 0",
                "early image differs 1",
                "error in no-such-scene.xml, input 1",
                "run refused",
            ],
        )
        compared = run(self.program, "compare", self.render("program.exr"), image, "--metrics", "rmse", "--max-rmse", 0)
        self.assertIn("rmse", compared)

    def test_the_library_exports_its_interface_and_nothing_else(self):
        library = next(self.prefix.glob("lib/**/libwavecrest.so"))
        symbols = run("nm", "--dynamic", "--defined-only", "--demangle", library).splitlines()
        names = [line.split(" ", 2)[2] for line in symbols]
        self.assertTrue(any(name.startswith("wavecrest::api::Scene::load") for name in names))
        inner = [name for name in names if "wavecrest::" in name and "wavecrest::api" not in name]
        self.assertEqual(inner, [])
        headers = "".join(header.read_text() for header in self.prefix.glob("include/wavecrest/*.h"))
        declared = re.findall(r"(?:class|struct) WAVECREST_EXPORT (\w+)|WAVECREST_EXPORT [^(;]*?(\w+)\(", headers)
        exported = {match[1] for name in names if (match := re.match(r"wavecrest::api::(\w+)", name))}
        self.assertEqual(exported - {class_ or function for class_, function in declared}, set())

    def test_bash_completes_commands_options_and_values(self):
        script = self.one("share/bash-completion/completions/wavecrest")
        for words, expected in (
            ("wavecrest ren", "render"),
            ("wavecrest render --snap", "--snapshot-every"),
            ("wavecrest render cornell-mirror -m vc", "vcm"),
            ("wavecrest render pool", "pool-interior"),
        ):
            ask = f'source {script}; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _wavecrest; '
            self.assertEqual(run("bash", "-c", ask + 'echo "${COMPREPLY[@]}"').split(), [expected], words)

    def test_other_shells_read_their_completions(self):
        for shell, pattern in (
            ("zsh", "share/zsh/site-functions/_wavecrest"),
            ("fish", "share/fish/vendor_completions.d/wavecrest.fish"),
        ):
            script = self.one(pattern)
            self.assertIn("--snapshot-every" if shell == "zsh" else "-l snapshot-every", script.read_text())
            if shutil.which(shell):
                run(shell, "-n", script)

    def test_the_man_page_lists_every_option_of_every_command(self):
        page = self.one("share/man/man1/wavecrest.1").read_text().replace("\\-", "-")
        parts = dict(re.findall(r"^\.SS (\S+)\n(.*?)(?=^\.S)", page, re.MULTILINE | re.DOTALL))
        self.assertLessEqual({"render", "compare", "converge", "report", "merge", "bench"}, set(parts))
        for command, part in parts.items():
            # A line of the help begins with two spaces and the option's names.
            names = ",".join(re.findall(r"^  (-\S+)", run(self.program, command, "--help"), re.MULTILINE)).split(",")
            listed = ", ".join(re.findall(r"^\\fB(-.*?)\\fR", part, re.MULTILINE)).split(", ")
            self.assertIn("--help", names)
            self.assertEqual(set(names) - set(listed), set(), command)
        if shutil.which("mandoc"):
            run("mandoc", "-T", "lint", "-W", "error", self.one("share/man/man1/wavecrest.1"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
