"""docs/build.py makes the whole site without a warning, refuses a broken link, and leaves the tree as it was."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def build(root, out, *arguments):
    command = [sys.executable, root / "docs/build.py", "--out", out, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


class Site(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_docs_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_the_site_is_made_without_a_warning_and_holds_readmes_headers_and_help(self):
        result = build(ROOT, self.folder / "out", "--drafts", "--wavecrest", os.environ["WAVECREST"])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("WARNING", result.stderr)
        site = self.folder / "out/site"
        for page, words in [
            ("index.html", "wavecrest"),
            ("engine/methods/METHODS.html", "Weights by recursion"),
            ("interface.html", "render.h"),
            ("commands.html", "--until-relative-error"),
            ("language/bsdf-roughplastic.html", "GGX alpha 0.15"),
            ("language/index.html", "rawconstant"),
            ("gallery.html", "veach-door"),
        ]:
            text = (site / page).read_text()
            self.assertTrue(words in text, f"{page}: lacks {words}")
            self.assertTrue("commands.html" in text, f"{page}: lacks the navigation")
        self.pictures_are_there(site)

    def pictures_are_there(self, site):
        """All pictures that pages show exist, and each plugin's page has one."""
        for page in sorted(site.rglob("*.html")):
            shown = re.findall(r'<img[^>]* src="([^":]+)"', page.read_text())
            for picture in shown:
                self.assertTrue((page.parent / picture).is_file(), f"{page}: there is no {picture}")
            if page.parent.name == "language" and page.name != "index.html":
                self.assertTrue(shown, f"{page}: no picture")

    def test_a_link_to_nothing_is_an_error(self):
        tree = self.folder / "tree"
        (tree / "include/wavecrest").mkdir(parents=True)
        (tree / "docs").mkdir()
        for file in [*(ROOT / "docs").glob("*.py"), ROOT / "docs/site.css"]:
            shutil.copy(file, tree / "docs")
        (tree / "tools").mkdir()
        shutil.copy(ROOT / "tools/tree_files.py", tree / "tools")
        readme = tree / "README.md"
        readme.write_text("# A tree\n\n[good](docs/build.py), [within](#a-tree)\n")
        self.assertEqual(build(tree, self.folder / "out").returncode, 0)
        readme.write_text("# A tree\n\n[bad](docs/absent.py)\n")
        result = build(tree, self.folder / "out")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("README.md: links to docs/absent.py", result.stderr)


if __name__ == "__main__":
    unittest.main()
