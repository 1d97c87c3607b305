"""The container recipes, where no engine runs: known instructions alone, both with the same packages, and these are the
ones that the program is linked to."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DOCKERFILE = (ROOT / "containers" / "Dockerfile").read_text()
APPTAINER = (ROOT / "containers" / "wavecrest.def").read_text()
INSTRUCTIONS = {"FROM", "COPY", "RUN", "WORKDIR", "ENTRYPOINT"}
SECTIONS = {"files", "post", "test", "runscript"}


def packages(recipe):
    """What the last `apt-get install` of a recipe names."""
    installed = re.findall(r"apt-get install[^&\n]*", recipe.replace("\\\n", " "))[-1]
    return {word for word in installed.split()[2:] if not word.startswith("-")}


class Containers(unittest.TestCase):
    def test_dockerfile_has_known_instructions_and_copies_what_exists(self):
        lines = re.sub(r"\\\n", " ", DOCKERFILE).splitlines()
        words = [line.split() for line in lines if line and not line.startswith("#")]
        self.assertEqual({word[0] for word in words} - INSTRUCTIONS, set())
        self.assertEqual(words[0][0], "FROM")
        for word in words:
            if word[0] == "COPY" and not word[1].startswith("--from"):
                self.assertTrue(all((ROOT / file).exists() for file in word[1:-1]), word)

    def test_apptainer_has_known_sections_in_two_stages(self):
        sections = re.findall(r"^%(\w+)", APPTAINER, re.MULTILINE)
        self.assertEqual(set(sections) - SECTIONS, set())
        self.assertEqual(re.findall(r"^Stage: (\w+)", APPTAINER, re.MULTILINE), ["build", "final"])
        self.assertEqual(APPTAINER.count("Bootstrap: docker"), 2)

    def test_shell_parts_parse(self):
        steps = re.findall(r"^RUN ((?:.*\\\n)*.*)", DOCKERFILE, re.MULTILINE)
        steps += re.findall(r"^%(?:post|test|runscript)\n((?:(?!^[%B]).*\n)*)", APPTAINER, re.MULTILINE)
        self.assertEqual(len(steps), 8)
        for step in steps:
            result = subprocess.run(["sh", "-n"], input=step, text=True, capture_output=True, check=False)
            self.assertEqual(result.returncode, 0, step + result.stderr)

    @unittest.skipUnless(shutil.which("dpkg-query"), "packages are Debian's")
    def test_both_install_the_packages_that_the_program_is_linked_to(self):
        self.assertEqual(packages(DOCKERFILE), packages(APPTAINER))
        # Direct needs; what these need follows from the packages' own dependencies. The C and C++ libraries are there.
        text = subprocess.run(["objdump", "-p", os.environ["WAVECREST"]], capture_output=True, text=True, check=True)
        needed = set(re.findall(r"NEEDED\s+(\S+)", text.stdout))
        patterns = [f"*/{library}" for library in needed]
        found = subprocess.run(["dpkg-query", "-S", *patterns], capture_output=True, text=True, check=True)
        owners = {line.split(":")[0] for line in found.stdout.splitlines()}
        base = {"libc6", "libstdc++6", "libgcc-s1"}
        self.assertEqual({p for p in owners if not p.endswith("-dev")} - base - packages(DOCKERFILE), set())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
