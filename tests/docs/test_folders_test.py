"""Tests run beside each other: no two leave files in the same folder."""

import json
import os
import pathlib
import re
import shlex
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def output_folders(text):
    """For each test of a CTestTestfile.cmake that is told a folder by --out, that folder."""
    folders = {}
    for name, command in re.findall(r"^add_test\((\S+) (.*)\)$", text, re.MULTILINE):
        words = shlex.split(command)
        for word, value in zip(words, words[1:]):
            if word == "--out":
                folders[name] = pathlib.PurePath(value)
    return folders


def collisions(folders):
    """Pairs of tests of which one's folder is the other's or within it."""
    names = sorted(folders)
    return [
        (a, b) for i, a in enumerate(names) for b in names[i + 1 :]
        if folders[a].is_relative_to(folders[b]) or folders[b].is_relative_to(folders[a])
    ]  # fmt: skip


def groups():
    return json.loads((ROOT / "tests/oracle/cases.json").read_text())["groups"]


class Folders(unittest.TestCase):
    def test_each_test_has_its_own(self):
        files = pathlib.Path(os.environ["WAVECREST_BUILD"]).rglob("CTestTestfile.cmake")
        folders = output_folders("\n".join(file.read_text() for file in files))
        self.assertGreaterEqual(len(folders), len(groups()))
        self.assertEqual(collisions(folders), [])

    def test_cases_of_a_group_do_not_write_over_each_other(self):
        self.assertEqual(len({group["name"] for group in groups()}), len(groups()))
        for group in groups():
            names = [case["name"] for case in group["cases"]]
            self.assertEqual(len(set(names)), len(names), group["name"])

    def test_files_of_a_test_lie_in_a_folder_of_its_process(self):
        # By a fixed name in /tmp, tests of two builds that run at once meet: tests/metrics/temporary_folder.h.
        for file in sorted((ROOT / "tests").rglob("*.[ch]*")):
            if file.suffix in (".cpp", ".h"):
                self.assertNotIn("testing::TempDir()) /", file.read_text(), file)

    def test_shared_folders_are_found(self):
        told = {"a": "/t/a", "b": "/t/b", "c": "/t/a", "d": "/t/b/d"}
        text = "\n".join(f'add_test({name} "x" "--out" "{folder}")' for name, folder in told.items())
        self.assertEqual(collisions(output_folders(text)), [("a", "c"), ("b", "d")])


if __name__ == "__main__":
    unittest.main()
