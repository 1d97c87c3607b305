"""Rendered pictures of scenes for the documentation site, and their captions.

A picture is named by a scene of the tree and the options of `wavecrest render` that make it; each is rendered once, however
many pages show it.
"""

import html
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
SIZE = "320x240"
OPTIONS = "-m bpt --spp 32"


def first_sentence(scene):
    """The first sentence of the comment at the head of a scene's file, which describes the scene."""
    comment = re.search(r"<!--(.*?)-->", (ROOT / scene).read_text(), re.DOTALL)
    if not comment:
        raise SystemExit(f"docs: {scene}: no comment; expected one that says what the scene is")
    return re.match(r".*?\.(?=\s+[A-Z$]|$)", " ".join(comment[1].split()))[0]


def words(options):
    """The options, completed by the defaults for method, samples and size."""
    given = options.split()
    chosen = given if {"-m", "--spp"} & set(given) else [*OPTIONS.split(), *given]
    return chosen if "--size" in chosen else [*chosen, "--size", SIZE]


class Pictures:
    """Renders into the folder `pictures` of the pages. Without a program there are none. Drafts have one sample per pixel."""

    def __init__(self, program, pages, drafts=False):
        self.program = program
        self.drafts = drafts
        self.folder = pages / "pictures"
        self.missing = set()  # scenes whose model nobody has fetched

    def render(self, scene, options=""):
        """The picture's name in its folder; None without a program, or where scenes/fetch-dragon was not run."""
        if not self.program or scene in self.missing:
            return None
        name = "-".join([pathlib.Path(scene).stem, *re.findall(r"[\w.=]+", options)]) + ".png"
        picture = self.folder / name
        if picture.exists():
            return name
        self.folder.mkdir(parents=True, exist_ok=True)
        chosen = words(options)
        if self.drafts and "--spp" in chosen:
            chosen[chosen.index("--spp") + 1] = "1"
        command = [self.program, "render", ROOT / scene, *chosen, "--quiet", "-o", picture]
        made = subprocess.run(command, capture_output=True, text=True, check=False)
        if made.returncode == 0:
            return name
        if "fetch-dragon" not in made.stderr:
            raise SystemExit(f"docs: no picture of {scene}: {made.stderr.strip()}")
        self.missing.add(scene)
        return None

    def figure(self, scene, options, caption, to_folder):
        """A figure as HTML; empty without a picture. caption: text, or HTML below it where the text says so."""
        name = self.render(scene, options)
        if not name:
            return ""
        # Few pixels are shown large.
        kind = ' class="pixels"' if "--size" in options else ""
        return (
            f'<figure{kind}><img src="{to_folder}/{name}" alt="{html.escape(pathlib.Path(scene).stem)}">\n'
            f"<figcaption>{caption}</figcaption></figure>\n"
        )
