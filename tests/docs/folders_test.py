"""Folders do not include each other in circles: each can be read, tested and moved with those below it alone."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
ROOMS = ["bench", "cli", "engine", "kernels", "library", "metrics", "python", "tests"]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def folders_included(root):
    """For each folder with C++ files those that its files include, each with one such file as an example."""
    edges = {}
    for room in ROOMS:
        for file in sorted((root / room).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            folder = file.parent.relative_to(root)
            targets = edges.setdefault(folder, {})
            for name in INCLUDE.findall(file.read_text(encoding="utf-8")):
                target = pathlib.Path(name).parent
                if target != folder and (root / name).is_file():
                    targets.setdefault(target, f"{file.relative_to(root)} includes {name}")
    return edges


def find_circle(edges):
    """The examples of one circle, or nothing."""
    done = set()

    def visit(folder, path):
        if folder in path:
            circle = [*path[path.index(folder) :], folder]
            return [edges[a][b] for a, b in zip(circle, circle[1:], strict=False)]
        if folder in done:
            return []
        for target in edges.get(folder, {}):
            circle = visit(target, [*path, folder])
            if circle:
                return circle
        done.add(folder)
        return []

    for start in list(edges):
        circle = visit(start, [])
        if circle:
            return circle
    return []


class Folders(unittest.TestCase):
    def test_no_circle(self):
        edges = folders_included(ROOT)
        self.assertGreater(sum(map(len, edges.values())), 100)
        self.assertEqual(find_circle(edges), [])

    def test_a_circle_is_found(self):
        self.assertEqual(find_circle({"a": {"b": "ab"}, "b": {"c": "bc"}, "c": {"b": "cb"}}), ["bc", "cb"])


if __name__ == "__main__":
    unittest.main()
