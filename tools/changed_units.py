"""Which translation units clang-tidy has to read for a change: those that changed, and one for each changed header.

In: compile commands as lint.py holds them, the sources, and git. The base of a change is where it left main; on main
itself the commit before, which for a merge is all that it brought.
"""

import functools
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)  # the tree's own headers, named from its root


def git(*arguments):
    result = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
    return result.stdout.strip() if result.returncode == 0 else None


def base_of_change():
    """The commit to compare with, or None: no history, as in a shallow clone."""
    head = git("rev-parse", "HEAD")
    for main in ("origin/main", "main"):
        base = git("merge-base", "HEAD", main)
        if base and base != head:
            return base
    return git("rev-parse", "--verify", "HEAD~1")


def changed_files(base):
    """Sources and headers that differ from base, committed or not, as absolute paths; deleted ones are nobody's."""
    names = (git("diff", "--name-only", "--diff-filter=d", base, "--", "*.cpp", "*.h") or "").split()
    names += (git("ls-files", "--others", "--exclude-standard", "*.cpp", "*.h") or "").split()
    return {ROOT / name for name in names}


@functools.cache
def includes_of(path):
    """The files of this tree that a file includes itself."""
    return [ROOT / name for name in INCLUDE.findall(path.read_text(encoding="utf-8"))]


def files_read(unit):
    """The files of this tree that a unit includes, directly or not, itself among them."""
    found = set()
    waiting = [pathlib.Path(unit)]
    while waiting:
        path = waiting.pop()
        if path not in found and path.is_file():
            found.add(path)
            waiting += includes_of(path)
    return found


def units_of_change(entries, changed):
    """The entries to read. A header is read in the unit that reads least else of ours; slow kernels come last."""
    chosen = [entry for entry in entries if pathlib.Path(entry["file"]) in changed]
    reads = {entry["file"]: files_read(entry["file"]) for entry in entries}
    covered = set().union(*(reads[entry["file"]] for entry in chosen))
    order = sorted(entries, key=lambda entry: ("HWY_" in " ".join(entry["arguments"]), len(reads[entry["file"]])))
    for header in sorted(changed):
        if header.suffix != ".h" or header in covered:
            continue
        unit = next((entry for entry in order if header in reads[entry["file"]]), None)
        if unit is None:
            continue  # nothing includes it
        chosen.append(unit)
        covered |= reads[unit["file"]]
    return chosen
