"""The lint target: formatting of every source file, and clang-tidy over what changed or over every translation unit.

    lint.py format [--fix]             clang-format 14 on all C++ files of the tree
    lint.py tidy [--build DIR] [FILE…] clang-tidy 14 with DIR/compile_commands.json (default build/lint, which this
                                       configures); FILEs are substrings of paths, default all
    lint.py tidy --changed             the units that differ from main, and one for each header that does

Kernel files are compiled once per instruction set; tidy reads each once, as AVX2 where it can. Status 1 on any finding.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import changed_units
from tree_files import tree_files

ROOT = pathlib.Path(__file__).resolve().parent.parent
LINT_BUILD = ROOT / "build" / "lint"
VERSION = "14"  # other versions format and judge differently
PREFERRED_ISA = "HWY_BASELINE_TARGETS=HWY_AVX2"
MOST_CHANGED_UNITS = 12  # at some twenty seconds each; a larger change has them spread over it


def find_tool(name):
    """The pinned version of a clang tool, under either of Debian's names."""
    for candidate in (f"{name}-{VERSION}", name):
        path = shutil.which(candidate)
        if path and re.search(rf"version {VERSION}\.", subprocess.check_output([path, "--version"], text=True)):
            return path
    sys.exit(f"lint: {name} {VERSION} not found; install the Debian package {name}-{VERSION}")


def check_format(fix):
    files = tree_files(ROOT, "*.cpp", "*.h")
    mode = ["-i"] if fix else ["--dry-run", "--Werror"]
    status = subprocess.run([find_tool("clang-format"), *mode, *files], cwd=ROOT, check=False).returncode
    print(f"lint: {len(files)} files {'formatted' if fix else 'checked'}")
    return status


def compile_commands(build):
    """One compile command per source file of the project, without compiler launcher, and deaf to what only g++ knows."""
    path = build / "compile_commands.json"
    if not path.exists():
        sys.exit(f"lint: {path} not found; configure first with cmake --preset {build.name}")
    chosen = {}
    for entry in json.loads(path.read_text(encoding="utf-8")):
        file = pathlib.Path(entry["file"])
        if not file.is_relative_to(ROOT) or file.is_relative_to(ROOT / "build"):
            continue  # generated, or not ours
        words = shlex.split(entry["command"])
        if not re.search(r"(c\+\+|g\+\+|clang\+\+)(-[0-9]+)?$", words[0]):
            words = words[1:]  # a launcher such as ccache
        words += ["-Wno-unknown-warning-option", "-Wno-unused-command-line-argument"]
        words += ["-Wno-pragma-clang-attribute"]  # Highway's, in headers that only name types
        if file not in chosen or PREFERRED_ISA in entry["command"]:
            output = words[words.index("-o") + 1]
            chosen[file] = {"directory": entry["directory"], "file": str(file), "output": output, "arguments": words}
    return [chosen[file] for file in sorted(chosen)]


def tidy_one(tool, database, entry):
    command = [tool, "--quiet", "-p", database, entry["file"]]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    return entry["file"], result.returncode, result.stdout if result.stdout else result.stderr


def check_tidy(build, substrings, changed):
    entries = compile_commands(build)
    if changed:
        base = changed_units.base_of_change()
        if base is None:
            print("lint: no earlier commit to compare with; clang-tidy reads nothing")
            return 0
        entries = changed_units.units_of_change(entries, changed_units.changed_files(base))
        if not entries:
            print(f"lint: no translation unit differs from {base[:12]}")
            return 0
    if substrings:
        entries = [entry for entry in entries if any(part in entry["file"] for part in substrings)]
    if changed and len(entries) > MOST_CHANGED_UNITS:
        print(f"lint: {len(entries)} units differ from {base[:12]}; ./check --steps tidy reads all of them")
        entries = entries[:: -(-len(entries) // MOST_CHANGED_UNITS)]
    if not entries:
        sys.exit("lint: no translation unit to check")
    tool = find_tool("clang-tidy")
    failures = 0
    with tempfile.TemporaryDirectory() as database, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        (pathlib.Path(database) / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")
        for file, status, text in pool.map(lambda entry: tidy_one(tool, database, entry), entries):
            if status != 0:
                failures += 1
                print(f"lint: {os.path.relpath(file, ROOT)}\n{text}", flush=True)
    print(f"lint: {len(entries)} translation units read, {failures} with findings")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    formatting = commands.add_parser("format")
    formatting.add_argument("--fix", action="store_true", help="rewrite the files")
    tidy = commands.add_parser("tidy")
    tidy.add_argument("--build", type=pathlib.Path, default=LINT_BUILD)
    tidy.add_argument("--changed", action="store_true", help="only what differs from main, or from the commit before")
    tidy.add_argument("files", nargs="*")
    arguments = parser.parse_args()
    if arguments.command == "format":
        sys.exit(check_format(arguments.fix))
    if arguments.build == LINT_BUILD:
        subprocess.run(["cmake", "--preset", "lint"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    sys.exit(check_tidy(arguments.build.resolve(), arguments.files, arguments.changed))


if __name__ == "__main__":
    main()
