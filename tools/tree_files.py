"""The files of the source tree: those that git knows of or could, or without git all but what builds leave."""

import fnmatch
import os
import subprocess

# What .gitignore leaves out, by name and by path.
IGNORED_NAMES = {".git", ".venv", "__pycache__"}
IGNORED_PATHS = {"build", "out", "scenes/assets"}


def git_files(root):
    """None without git, or where it has no repository here: one around the tree is another project's."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    environment = {**os.environ, "GIT_CEILING_DIRECTORIES": str(root.parent)}
    try:
        listed = subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return None
    return listed.stdout.split("\0")[:-1] if listed.returncode == 0 else None


def walked_files(root):
    for folder, folders, names in os.walk(root):
        inner = os.path.relpath(folder, root)
        folders[:] = [
            name for name in folders
            if name not in IGNORED_NAMES and os.path.normpath(os.path.join(inner, name)) not in IGNORED_PATHS
        ]  # fmt: skip
        yield from (os.path.normpath(os.path.join(inner, name)) for name in names)


def tree_files(root, *patterns):
    """Paths from root on, in order, of the files whose names match a pattern, by default of all."""
    listed = git_files(root)
    names = set(walked_files(root) if listed is None else listed)
    wanted = patterns or ("*",)
    return sorted(
        name for name in names
        if any(fnmatch.fnmatchcase(os.path.basename(name), pattern) for pattern in wanted) and (root / name).is_file()
    )  # fmt: skip
