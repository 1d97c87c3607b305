"""Which translation units clang-tidy has to read for a change: those that changed, and one for each changed header.

In: compile commands as lint.py holds them, the dependencies that ninja recorded when it built them, and git. The base
of a change is where it left main; on main itself the commit before, which for a merge is all that it brought.
"""

import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent


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


def headers_by_object(build):
    """Object file -> the files of this tree that its compilation read, from the log of a finished ninja build."""
    text = subprocess.check_output(["ninja", "-C", str(build), "-t", "deps"], text=True)
    found = {}
    files = set()
    for line in text.splitlines():
        if line.startswith(" "):
            path = pathlib.Path(build, line.strip())
            if path.is_relative_to(ROOT) and not path.is_relative_to(ROOT / "build"):
                files.add(path)
        elif ":" in line:
            files = found.setdefault(line.split(":")[0], set())
    return found


def units_of_change(entries, build, changed):
    """The entries to read. A header is read in the unit that reads least else of ours; slow kernels come last."""
    chosen = [entry for entry in entries if pathlib.Path(entry["file"]) in changed]
    by_object = headers_by_object(build)
    reads = {entry["file"]: by_object.get(entry["output"], set()) for entry in entries}
    covered = set().union(*(reads[entry["file"]] for entry in chosen))
    order = sorted(entries, key=lambda entry: ("HWY_" in " ".join(entry["arguments"]), len(reads[entry["file"]])))
    for header in sorted(changed):
        if header.suffix != ".h" or header in covered:
            continue
        unit = next((entry for entry in order if header in reads[entry["file"]]), None)
        if unit is None:
            continue  # nothing that was built includes it
        chosen.append(unit)
        covered |= reads[unit["file"]]
    return chosen
