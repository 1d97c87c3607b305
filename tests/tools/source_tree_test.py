"""The source tree with and without git: which files are its own, and which commit a build of it names."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from tree_files import tree_files  # noqa: E402  (the path has to be set first)


def git(folder, *arguments):
    identity = ["-c", "user.name=a", "-c", "user.email=a@localhost"]
    done = subprocess.run(["git", "-C", folder, *identity, *arguments], capture_output=True, check=True)
    return done.stdout


class SourceTree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_source_tree_")
        self.addCleanup(folder.cleanup)
        self.outer = pathlib.Path(folder.name)
        self.tree = self.outer / "wavecrest"
        (self.tree / "cmake").mkdir(parents=True)
        for name in ("cmake/commit.cmake", "cmake/commit.txt", ".gitattributes", ".gitignore"):
            shutil.copy(ROOT / name, self.tree / name)
        for name in ("a.cpp", "docs/b.md", "docs/build/c.md", "build/d.cpp", "scenes/assets/e.md"):
            (self.tree / name).parent.mkdir(parents=True, exist_ok=True)
            (self.tree / name).touch()

    def commit_in(self, folder):
        git(folder, "init", "--quiet")
        git(folder, "add", "--all")
        git(folder, "commit", "--quiet", "--message", "all")
        return git(folder, "rev-parse", "HEAD").decode()[:12]

    def commit_of_build(self, tree):
        script = self.outer / "print_commit.cmake"
        script.write_text('include(${PROJECT_SOURCE_DIR}/cmake/commit.cmake)\nmessage("${WAVECREST_COMMIT}")\n')
        command = ["cmake", f"-DPROJECT_SOURCE_DIR={tree}", "-P", script]
        return subprocess.run(command, capture_output=True, text=True, check=True).stderr.strip()

    def test_files_are_the_same_without_git_as_with_it(self):
        for git_in in (None, self.outer, self.tree):  # the second is another project's
            if git_in:
                git(git_in, "init", "--quiet")
            self.assertEqual(tree_files(self.tree, "*.cpp", "*.md"), ["a.cpp", "docs/b.md", "docs/build/c.md"])
            self.assertIn(".gitignore", tree_files(self.tree))

    def test_a_build_names_the_trees_own_commit_or_none(self):
        self.assertEqual(self.commit_of_build(self.tree), "unknown")
        self.commit_in(self.outer)  # another project's
        self.assertEqual(self.commit_of_build(self.tree), "unknown")
        own = self.commit_in(self.tree)
        self.assertEqual(self.commit_of_build(self.tree), own)

    def test_an_archive_knows_its_commit(self):
        own = self.commit_in(self.tree)
        (self.outer / "archive.tar").write_bytes(git(self.tree, "archive", "--prefix=unpacked/", "HEAD"))
        shutil.unpack_archive(self.outer / "archive.tar", self.outer)
        self.assertEqual(self.commit_of_build(self.outer / "unpacked"), own)


if __name__ == "__main__":
    unittest.main()
