#!/usr/bin/env python3
"""Makes the documentation site: the READMEs where they are, the public headers, the help of every command, the scene language
and a gallery.

    docs/build.py --out build/docs [--wavecrest build/release/wavecrest]

In: the Markdown files of the tree, include/wavecrest/*.h, scenes/plugins.json, and the program, whose help and pictures are
left out without --wavecrest.
Out: pages below --out/pages, a configuration of MkDocs and the site in --out/site. Nothing is written into the tree.
MkDocs runs in its strict mode, in which every warning is an error; so is a link here to a file that does not exist.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True  # nothing is written into the tree
sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "tools"))

from gallery_page import gallery_page  # noqa: E402
from language_pages import language_pages  # noqa: E402
from pictures import ROOT, Pictures  # noqa: E402
from tree_files import tree_files  # noqa: E402

# Title of each section, and the folders whose Markdown files it holds, in this order.
SECTIONS = {
    "Using it": [".", "scenes", "bench/campaign", "bench/checkpoint", "bench/ranks", "library", "python"],
    "Measuring": ["bench", "metrics"],
    "How it works": ["engine", "kernels", "tests"],
}
FRONT = "README.md"


def page_of(file):
    """The name of a file's page: the front page is the site's index."""
    return "index.md" if file == FRONT else file


def copy_pictures(text, file, pages):
    """Pictures that a page shows, at the same place beside it."""
    for target in re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)", text):
        picture = os.path.normpath(os.path.join(os.path.dirname(file), target))
        (pages / picture).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / picture, pages / picture)


def title_of(text, file):
    heading = re.search(r"^# +(.+)$", text, re.MULTILINE)
    return heading[1].strip() if heading else file


def relinked(text, file, files):
    """The text with links between pages kept, and links to other files of the tree as their names."""

    def replace(match):
        label, target = match[1], match[2]
        if re.match(r"[a-z]+:|#", target):
            return match[0]
        path, _, anchor = target.partition("#")
        meant = os.path.normpath(os.path.join(os.path.dirname(file), path))
        if meant + "/README.md" in files:
            meant += "/README.md"
        if meant in files:
            relative = os.path.relpath(page_of(meant), os.path.dirname(page_of(file)) or ".")
            return f"[{label}]({relative}{'#' + anchor if anchor else ''})"
        if not (ROOT / meant).exists():
            raise SystemExit(f"docs: {file}: links to {target}; expected a file that exists")
        return label if meant in label else f"{label} (`{meant}`)"

    parts = re.split(r"(^```.*?^```|^    [^\n]*$)", text, flags=re.MULTILINE | re.DOTALL)
    for i in range(0, len(parts), 2):  # not inside code
        parts[i] = re.sub(r"(?<!!)\[([^\]]+)\]\(([^)\s]+)\)", replace, parts[i])
    return "".join(parts)


def header_page():
    """The public headers as they are: their comments are their documentation."""
    text = "# C++ interface\n\nWhat `#include <wavecrest/wavecrest.h>` declares. An example is in `tests/install/example`.\n"
    for header in sorted((ROOT / "include/wavecrest").glob("*.h")):
        text += f"\n## {header.name}\n\n```cpp\n{header.read_text().rstrip()}\n```\n"
    return text


def command_page(program):
    """The help of every command, as the program prints it."""

    def ask(*arguments):
        return subprocess.run([program, *arguments], capture_output=True, text=True, check=True).stdout

    overview = ask("help")
    commands = re.findall(r"^  ([a-z]+)  +", overview.split("Subcommands:")[-1], re.MULTILINE)
    if not commands:
        raise SystemExit(f"docs: {program} help: lists no commands; expected some")
    text = f"# Command line\n\n```text\n{overview.strip()}\n```\n"
    for command in commands:
        text += f"\n## {command}\n\n```text\n{ask('help', command).strip()}\n```\n"
    return text


def link_from_front(pages, made):
    """Adds links to the generated pages above the first section of the front page."""
    front = pages / page_of(FRONT)
    links = ", ".join(f"[{title}]({page})" for title, page in made)
    before, mark, after = front.read_text().partition("\n## ")
    front.write_text(f"{before}\nMore on this site: {links}.\n{mark}{after}")


def navigation(files, titles, extra, language):
    """Each file in the section whose folder is the longest that holds it, as nested lists for MkDocs."""
    sections = {name: [] for name in SECTIONS}
    for file in files:
        if file == FRONT:
            continue
        parent = os.path.dirname(file) or "."
        fitting = [
            (len(folder), name)
            for name, folders in SECTIONS.items()
            for folder in folders
            if parent == folder or parent.startswith(folder + "/") or folder == "."
        ]
        sections[max(fitting)[1]].append((titles[file], page_of(file)))
    sections["Using it"] = extra + sections["Using it"]
    sections["Scene language"] = language
    lines = ["  - 'wavecrest': index.md"]
    for name, pages in sections.items():
        if not pages:
            continue
        lines.append(f"  - '{name}':")
        for title, page in pages:
            quoted = title.replace("`", "").replace("'", "''")
            lines.append(f"    - '{quoted}': {page}")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(prog="docs/build.py", description="Makes the documentation site.")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/docs", help="folder; replaced as a whole")
    parser.add_argument("--wavecrest", help="the program whose help is a page")
    parser.add_argument("--drafts", action="store_true", help="pictures of one sample per pixel")
    arguments = parser.parse_args()
    pages = arguments.out.resolve() / "pages"
    shutil.rmtree(arguments.out, ignore_errors=True)
    files = tree_files(ROOT, "*.md")
    titles = {}
    for file in files:
        text = (ROOT / file).read_text()
        titles[file] = title_of(text, file)
        target = pages / page_of(file)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(relinked(text, file, set(files)))
        copy_pictures(text, file, pages)
    extra = [("C++ interface", "interface.md")]
    (pages / "interface.md").write_text(header_page())
    if arguments.wavecrest:
        extra.insert(0, ("Command line", "commands.md"))
        (pages / "commands.md").write_text(command_page(arguments.wavecrest))
    pictures = Pictures(arguments.wavecrest, pages, arguments.drafts)
    language = language_pages(pages, pictures)
    gallery = gallery_page(pages, pictures)
    link_from_front(pages, gallery + language + extra)
    shutil.copy(pathlib.Path(__file__).resolve().parent / "site.css", pages / "site.css")
    settings = arguments.out.resolve() / "mkdocs.yml"
    settings.write_text(
        f"site_name: wavecrest\ndocs_dir: {pages}\nsite_dir: {arguments.out.resolve() / 'site'}\nuse_directory_urls: false\n"
        "theme:\n  name: mkdocs\n  highlightjs: false\nextra_css:\n  - site.css\n"
        f"nav:\n{navigation(files, titles, gallery + extra, language)}\n"
    )
    built = subprocess.run(["mkdocs", "build", "--strict", "--config-file", settings], check=False)
    sys.exit(built.returncode)


if __name__ == "__main__":
    main()
